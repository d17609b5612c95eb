//! From factory settings to a tuned, calibrated, saved axis.

use std::sync::atomic::Ordering;

use leadscrew::identification::Refusal;
use leadscrew_client::{Error, Kind};
use leadscrew_hal_mock::scenario::Trouble;
use leadscrew_host::axis::setup::{Answers, Step, Steps, setup};
use leadscrew_host::axis::{ProcedureError, TestMove, follow, read_settings};
use leadscrew_host::simulated_axis::FlashImage;

use crate::support::{Agreeing, Bench, bench};

fn set_up(
    bench: &mut Bench,
    guide: &mut Agreeing,
    answers: &[(&str, f64)],
    steps: &Steps,
) -> Result<leadscrew_host::axis::setup::Outcome, ProcedureError> {
    let mut all = Answers::default();
    for (name, value) in answers {
        all.give(name, *value).unwrap();
    }
    setup(&mut bench.tool, guide, all, steps)
}

#[test]
fn an_axis_with_a_blank_flash_is_commissioned_and_keeps_it() {
    let flash = FlashImage::blank();
    let mut first = bench(&flash);
    let mut guide = Agreeing::default();
    let outcome = set_up(
        &mut first,
        &mut guide,
        &[("home_switch", -1.0)],
        &Steps::default(),
    )
    .unwrap();
    assert!(outcome.homed_at_mm.unwrap().abs() < 0.1, "{outcome:?}");
    assert_eq!(outcome.counts_per_revolution, Some(10_000.0));
    // The machine's: 9 600 mm/min and −0.5 %.
    let feed = outcome.full_command_feed_mm_per_min.unwrap();
    assert!((feed - 9600.0).abs() < 10.0, "{feed}");
    assert!((outcome.offset.unwrap() + 0.005).abs() < 5e-5);
    assert!(outcome.map_edge_d.unwrap() < 0.003);
    let [without, with] = outcome.ripple_d_per_tick.unwrap();
    assert!(with < 0.1 * without, "{with} {without}");
    assert!(outcome.follows.unwrap().peak_d < 3.0);
    assert!(outcome.offset_left.unwrap()[1].abs() < 2e-4);
    assert!(!first.tool.status().unwrap().is_enabled);
    let settings = read_settings(&mut first.tool).unwrap();
    drop(first);

    // Switched off and on.
    let mut again = bench(&flash);
    assert!(again.machine.borrow().loaded().has_map);
    assert_eq!(read_settings(&mut again.tool).unwrap(), settings);
    assert!(again.tool.stored(Kind::EncoderMap).unwrap().length > 10_000);
    again.tool.enable().unwrap();
    let test = TestMove {
        from_mm: 0.0,
        to_mm: 300.0,
        feed_mm_per_min: 9000.0,
        passes: 2,
    };
    let follows = follow(&mut again.tool, &settings, &test).unwrap();
    println!("{follows:?}");
    // `leadscrew tracking`: 1.34 d at the shaft, the worst of five encoders; the axis sees a count of it either way.
    assert!(follows.peak_d < 3.0, "{follows:?}");
}

#[test]
fn nothing_moves_before_the_person_agreed() {
    let mut bench = bench(&FlashImage::blank());
    let mut guide = Agreeing {
        refuses: Some("polarity"),
        ..Agreeing::default()
    };
    let error = set_up(&mut bench, &mut guide, &[], &Steps::default()).unwrap_err();
    assert!(matches!(error, ProcedureError::Declined), "{error}");
    let status = bench.tool.status().unwrap();
    assert!(!status.is_enabled && status.position_mm.abs() < 0.002);
}

#[test]
fn a_reversed_drive_is_told_before_any_loop_closes() {
    let mut bench = bench(&FlashImage::blank());
    bench.trouble(&Trouble::DriveReversed);
    let mut guide = Agreeing::default();
    let error = set_up(&mut bench, &mut guide, &[], &Steps::default()).unwrap_err();
    let is_told = matches!(
        error,
        ProcedureError::NotIdentified(Refusal::WrongPolarity { .. })
    );
    assert!(is_told, "{error}");
    assert!(error.to_string().contains("exchange A and B"), "{error}");
    let status = bench.tool.status().unwrap();
    assert!(!status.is_enabled && status.position_mm.abs() < 3.0);
    let settings = read_settings(&mut bench.tool).unwrap();
    assert_eq!(settings.axis.controller.position_gain_per_s, 0.0);
}

#[test]
fn a_wrong_number_of_lines_is_told_and_so_is_a_direction_that_is_the_other() {
    let lines = [("counts_per_revolution", 8000.0)];
    let mut one = bench(&FlashImage::blank());
    let mut guide = Agreeing::default();
    let error = set_up(&mut one, &mut guide, &lines, &Steps::default()).unwrap_err();
    // 8 000 counts are too short a way for two indexes of 10 000, or the distance is not what was said.
    let is_told = matches!(
        error,
        ProcedureError::NoIndex { .. } | ProcedureError::OtherRevolution { .. }
    );
    assert!(is_told, "{error}");

    let mut other = bench(&FlashImage::blank());
    let minus = [("plus_is_right", 0.0)];
    let error = set_up(&mut other, &mut guide, &minus, &Steps::default()).unwrap_err();
    assert!(matches!(error, ProcedureError::OtherWay), "{error}");
}

#[test]
fn too_little_travel_is_told_with_what_it_takes_and_setup_goes_on_from_there() {
    let flash = FlashImage::blank();
    let mut bench = bench(&flash);
    let mut guide = Agreeing::default();
    let room = [("room_plus_mm", 120.0)];
    let error = set_up(&mut bench, &mut guide, &room, &Steps::default()).unwrap_err();
    let is_told = matches!(error, ProcedureError::NoRoom { .. });
    assert!(
        is_told && error.to_string().contains("12 revolutions"),
        "{error}"
    );
    // What was found until then is there: the session goes on with the encoder, by somebody who knows of more room.
    let on = Steps {
        from: Some(Step::Encoder),
        skip: vec![Step::Offset, Step::Home],
    };
    let more = [("room_plus_mm", 300.0), ("room_minus_mm", 0.0)];
    let outcome = set_up(&mut bench, &mut guide, &more, &on).unwrap();
    assert_eq!(outcome.steps, ["encoder"]);
    assert!(outcome.map_edge_d.is_some());
}

#[test]
fn an_interruption_stops_the_learning_and_leaves_the_axis_as_it_was() {
    let flash = FlashImage::blank();
    let mut bench = bench(&flash);
    let mut guide = Agreeing::default();
    let to_the_loop = Steps {
        skip: vec![Step::Encoder, Step::Offset],
        from: None,
    };
    set_up(&mut bench, &mut guide, &[], &to_the_loop).unwrap();
    let settings = read_settings(&mut bench.tool).unwrap();
    // Ctrl-C in the first run.
    guide.interrupts = Some(("run 1", bench.interrupted.clone()));
    let on = Steps {
        from: Some(Step::Encoder),
        skip: Vec::new(),
    };
    let error = set_up(&mut bench, &mut guide, &[], &on).unwrap_err();
    let is_told = matches!(
        error,
        ProcedureError::Axis(Error::Interrupted { stands: true })
    );
    assert!(is_told, "{error}");
    let machine = bench.machine.borrow();
    assert!(machine.world().board.machine.truth().shaft.velocity.abs() < 0.05);
    drop(machine);
    bench.interrupted.store(false, Ordering::Relaxed);
    bench.tool.restart().unwrap();
    assert_eq!(read_settings(&mut bench.tool).unwrap(), settings);
}
