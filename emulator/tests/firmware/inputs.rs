//! Lines of the machine that the image watches: each ends a motion by its own fault, and in the safe state.

use std::time::Duration;

use leadscrew::supervisor::{Fault, Reaction};
use leadscrew_client::Axis;
use leadscrew_emulator::MILLISECOND;
use leadscrew_hal_mock::scenario::Trouble;

use crate::motion::set_up;
use crate::session::Board;

/// Steps of the machine that a trouble lasts: a second.
const LASTS: u32 = 20_000;
/// From a line's change to what the tick makes of it: the rest of the machine's step, a tick, and the converter.
const AT_ONCE_MS: u64 = 3;
/// Longest time to stop, with the brake's and the drive's own.
const STOP_MS: u64 = 900;
/// Output that is none, of full scale: the converter's last bit.
const NO_OUTPUT: f64 = 4e-5;

/// An axis that jogs.
fn jogging(tool: &mut Axis, feed_mm_per_min: f64) {
    tool.enable().unwrap();
    tool.jog(feed_mm_per_min).unwrap();
    tool.wait(Duration::from_millis(300)).unwrap();
    let status = tool.status().unwrap();
    assert!(status.is_moving && status.fault_number == 0, "{status:?}");
}

/// What the fault says is done is done at the pins, and is told by its number.
fn ends_by(board: &Board, tool: &mut Axis, fault: Fault) {
    board.run_ms(AT_ONCE_MS);
    let (is_enabled, command) = board.machine(|machine| (machine.relays().0, machine.command()));
    match fault.reaction() {
        Reaction::Off => assert!(!is_enabled, "{fault:?}"),
        Reaction::ZeroVolts => assert!(command.abs() < NO_OUTPUT, "{fault:?}: {command}"),
        Reaction::ControlledStop | Reaction::Warning => {}
    }
    tool.wait(Duration::from_millis(STOP_MS)).unwrap();
    assert!(board.machine(|machine| machine.is_safe()), "{fault:?}");
    let status = tool.status().unwrap();
    assert_eq!(status.fault(), Some(fault), "{status:?}");
    assert!(!status.is_enabled, "{status:?}");
}

/// The fault is cleared once its cause is gone, and nothing is enabled by that.
fn is_cleared(board: &Board, tool: &mut Axis) {
    tool.wait(Duration::from_millis(400)).unwrap();
    tool.disable().unwrap();
    tool.clear_fault().unwrap();
    board.machine(|machine| machine.take_put_out());
    board.run_ms(50);
    let put_out = board.machine(|machine| machine.take_put_out());
    assert!(!put_out.enabled && !put_out.brake_released, "{put_out:?}");
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn every_line_ends_a_motion_by_its_own_fault() {
    let board = Board::blank();
    let mut tool = board.tool();
    set_up(&mut tool);
    for (trouble, fault) in [
        (Trouble::SignalLoss, Fault::SignalLoss),
        (Trouble::EmergencyStop, Fault::EmergencyStop),
        (Trouble::DriveFault, Fault::DriveFault),
        (Trouble::DriveNotReady, Fault::DriveNotReady),
    ] {
        jogging(&mut tool, 3000.0);
        board.machine(|machine| machine.world_mut().begin(&trouble, LASTS).unwrap());
        ends_by(&board, &mut tool, fault);
        let page = tool.fault_page().unwrap().expect("a fault was latched");
        println!("{fault:?}: {page:?}");
        is_cleared(&board, &mut tool);
    }
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn a_limit_switch_ends_a_motion_towards_it_and_lets_the_axis_away() {
    let board = Board::blank();
    let mut tool = board.tool();
    set_up(&mut tool);
    jogging(&mut tool, -6000.0);
    let is_limited =
        |board: &Board| board.machine(|machine| machine.world().board.lines().limit_low);
    let mut waited = 0;
    while !is_limited(&board) {
        assert!(waited < 2_000, "the switch is at -60 mm");
        board.with(|axis| axis.run(MILLISECOND).unwrap());
        waited += 1;
        if waited % 50 == 0 {
            // The lease is kept.
            tool.status().unwrap();
        }
    }
    ends_by(&board, &mut tool, Fault::HardLimit);
    println!("{:?}", tool.fault_page().unwrap());
    assert!(is_limited(&board), "it stands on the switch");
    tool.disable().unwrap();
    tool.clear_fault().unwrap();
    jogging(&mut tool, 3000.0);
    tool.wait(Duration::from_millis(500)).unwrap();
    assert_eq!(tool.status().unwrap().fault_number, 0);
    assert!(!is_limited(&board), "it has left the switch");
}
