//! The axis in motion.

use std::time::{Duration, Instant};

use leadscrew::scope::{Setup, Signal, Signals, Trigger};
use leadscrew_client::{Axis, Options, ScopePhase};
use leadscrew_hal_mock::scenario::Base;
use leadscrew_host::simulated_axis::{FlashImage, SimulatedAxis};

use crate::session::Board;
use crate::tuned::tuned;

/// Ticks of a standard move, dwell included.
const TICKS: u32 = 2600;
/// One d of a following error, as the scope has it.
const D: f64 = 65_536.0;

/// Sets a loop for the reference machine.
pub fn set_up(tool: &mut Axis) {
    tool.edit_parameters(|edit| {
        for (name, value) in tuned() {
            edit.set_parameter(&name, value)?;
        }
        Ok(())
    })
    .unwrap();
}

/// Following error of every tick of 300 mm at 9 000 mm/min and back, d.
fn following_errors(tool: &mut Axis) -> Vec<f64> {
    set_up(tool);
    tool.enable().unwrap();
    let mut errors = Vec::new();
    for target_mm in [300.0, 0.0] {
        let setup = Setup {
            signals: Signals::new(&[Signal::FollowingError]).unwrap(),
            every: 1,
            trigger: Trigger::Command,
            pre: 10,
            samples: TICKS,
        };
        tool.arm_scope(&setup).unwrap();
        tool.move_and_wait(target_mm, 9000.0).unwrap();
        tool.wait(Duration::from_millis(700)).unwrap();
        let scope = tool.scope().unwrap();
        assert_eq!(scope.phase, ScopePhase::Complete, "{scope:?}");
        let samples = tool.read_scope(&scope).unwrap();
        errors.extend(samples.iter().map(|sample| f64::from(sample[0]) / D));
    }
    let counters = tool.tick_counters().unwrap();
    assert_eq!(
        (counters.late, counters.lost_records),
        (0, 0),
        "{counters:?}"
    );
    errors
}

fn worst(errors: &[f64]) -> f64 {
    errors
        .iter()
        .fold(0.0, |worst, error| error.abs().max(worst))
}

fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
}

#[test]
#[ignore = "worst 147.3 d where the host's simulation has 129.5: its command is there at the tick, the board's some 30 us and \
            a step of the machine later; not yet explained in full"]
fn the_standard_move_follows_as_in_the_host_s_simulation() {
    let line = SimulatedAxis::new(Base::Full, 1000.0, 1, FlashImage::blank()).unwrap();
    let mut host = Axis::open(line, Options::default()).unwrap();
    let expected = following_errors(&mut host);
    let board = Board::blank();
    let begun = Instant::now();
    let mut tool = board.tool();
    let found = following_errors(&mut tool);
    let virtual_s = board.with(|axis| axis.seconds());
    let (host_worst, host_rms) = (worst(&expected), rms(&expected));
    let (board_worst, board_rms) = (worst(&found), rms(&found));
    println!(
        "worst {board_worst:.2} d (host {host_worst:.2}), rms {board_rms:.2} d (host {host_rms:.2}); \
         {:.2} s wall a virtual second",
        begun.elapsed().as_secs_f64() / virtual_s
    );
    assert!((board_worst - host_worst).abs() < 2.0);
    assert!((board_rms - host_rms).abs() < 2.0);
    assert!(board.machine(|machine| machine.take_put_out().volts > 1.0));
    assert!(tool.disable().is_ok());
    board.run_ms(100);
    assert!(board.machine(|machine| machine.is_safe()));
}
