//! Where the firmware runs it: not more than was shown is claimed.

use leadscrew_process::plan::board::boards;
use leadscrew_process::plan::{BoardVerdict, Runs};

use super::{axis_of, plan_of};

fn on_the_axis_board(feed: f64, counts_per_mm: f64, tick_hz: f64) -> BoardVerdict {
    boards()[0].verdict(&[axis_of(feed, 0.1, Some(5.0), counts_per_mm)], tick_hz)
}

#[test]
fn every_machine_of_the_papers_runs_on_the_axis_board() {
    for name in [
        "16K20F3",
        "16K20F3 retrofit",
        "6R13GN1",
        "FP7M",
        "FP7SMN",
        "MA655SM30A",
        "MIKRON UCP 710",
    ] {
        let plan = plan_of(name);
        assert_eq!(
            plan.boards[0].runs,
            Runs::Shown,
            "{name}: {:?}",
            plan.boards
        );
        assert!(plan.boards[0].why.contains("never on hardware"));
        assert!(plan.boards[0].tick_hz >= plan.cycle.frequency_hz);
    }
}

#[test]
fn what_was_not_shown_is_not_claimed() {
    assert_eq!(on_the_axis_board(9000.0, 1000.0, 2500.0).runs, Runs::Shown);
    let verdict = on_the_axis_board(9000.0, 1000.0, 5000.0);
    assert_eq!(verdict.runs, Runs::NotShown);
    assert!(
        verdict
            .why
            .contains("clocks for each, and the clocks are not measured"),
        "{verdict:?}"
    );
    // The perspective machine's 35 kHz: more than the tick's instructions allow.
    let verdict = on_the_axis_board(9000.0, 1000.0, 35_018.0);
    assert_eq!(verdict.runs, Runs::No);
    assert!(verdict.why.contains("at one clock each"), "{verdict:?}");
}

#[test]
fn the_inputs_refuse_what_the_firmware_refuses() {
    // docs/board.md: 52 500 mm/min at 1 000 d/mm and 1 kHz, 72 000 from 1.3 kHz on.
    assert_eq!(
        on_the_axis_board(52_500.0, 1000.0, 1000.0).runs,
        Runs::Shown
    );
    assert!(
        on_the_axis_board(60_000.0, 1000.0, 1000.0)
            .why
            .contains("the ring of 4096 edge times")
    );
    assert_eq!(
        on_the_axis_board(72_000.0, 1000.0, 1300.0).runs,
        Runs::Shown
    );
    assert!(
        on_the_axis_board(72_001.0, 1000.0, 1300.0)
            .why
            .contains("300000 Hz")
    );
    // Beyond the core's formats, on any board.
    let fast = boards()[1].verdict(&[axis_of(30_000.0, 0.1, Some(5.0), 1e5)], 2000.0);
    assert!(fast.why.contains("max_velocity_d_per_tick"), "{fast:?}");
    assert!(
        boards()[1]
            .verdict(&[axis_of(100.0, 0.1, None, 1000.0)], 50_000.0)
            .why
            .contains("tick_hz")
    );
}

#[test]
fn a_frequency_below_the_slowest_tick_is_asked_as_that() {
    let slow = axis_of(1000.0, 0.1, Some(5.0), 1000.0);
    assert_eq!(boards()[0].verdict(&[slow], 20.0).tick_hz, 100.0);
    // The ring does not hold what the longest filter may pass in so long a tick: it runs at a faster one.
    assert_eq!(boards()[0].verdict(&[slow], 20.0).runs, Runs::No);
    let verdict = boards()[0].verdict_from(&[slow], 20.0);
    assert_eq!((verdict.tick_hz, verdict.runs), (1000.0, Runs::Shown));
}
