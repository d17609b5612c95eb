//! A new board is set up over the link, as a person does it with the tool.

use leadscrew_client::{Axis, Options};
use leadscrew_hal_mock::scenario::Base;
use leadscrew_host::axis::setup::{Answers, Outcome, Step, Steps, setup};
use leadscrew_host::axis::{Guide, ProcedureError, read_settings};
use leadscrew_host::simulated_axis::{FlashImage, SimulatedAxis};

use crate::session::Board;

/// Somebody who agrees to all and takes every default.
struct Agreeing;

impl Guide for Agreeing {
    fn tell(&mut self, text: &str) {
        println!("{text}");
    }

    fn progress(&mut self, _: &str) {}

    fn agree(&mut self, _: &str, _: bool) -> Result<bool, ProcedureError> {
        Ok(true)
    }

    fn number(&mut self, _: &str, default: f64) -> Result<f64, ProcedureError> {
        Ok(default)
    }
}

/// From factory settings to a saved loop; the map of the encoder is left out.
fn set_up(tool: &mut Axis) -> Outcome {
    let mut answers = Answers::default();
    answers.give("home_switch", -1.0).unwrap();
    let steps = Steps {
        skip: vec![Step::Encoder],
        from: None,
    };
    setup(tool, &mut Agreeing, answers, &steps).unwrap()
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn a_blank_board_is_commissioned_as_the_host_s_simulation_and_stays_so() {
    if std::env::var_os("LEADSCREW_LONG").is_none() {
        return;
    }
    let line = SimulatedAxis::new(Base::Full, 1000.0, 1, FlashImage::blank()).unwrap();
    let expected = set_up(&mut Axis::open(line, Options::default()).unwrap());
    let board = Board::blank();
    let mut tool = board.tool();
    let found = set_up(&mut tool);
    println!(
        "{found:?}\nhost {expected:?}\n{:.0} s",
        board.with(|axis| axis.seconds())
    );
    // The machine's: 9 600 mm/min and −0.5 %.
    let feed = found.full_command_feed_mm_per_min.unwrap();
    assert!((feed - 9600.0).abs() < 10.0, "{feed}");
    assert!((found.offset.unwrap() + 0.005).abs() < 5e-5);
    assert!(found.homed_at_mm.unwrap().abs() < 0.1);
    let peaks = [&found, &expected].map(|outcome| outcome.follows.as_ref().unwrap().peak_d);
    assert!((peaks[0] - peaks[1]).abs() < 2.0, "{peaks:?}");
    let settings = read_settings(&mut tool).unwrap();
    drop(tool);
    let again = read_settings(&mut board.power_cycled().tool()).unwrap();
    assert_eq!(again, settings);
}
