//! What went wrong on the axis goes wrong again at the desk: the same fault in the same tick, with the same figures.

use std::time::Duration;

use leadscrew::supervisor::Fault;
use leadscrew_client::{Axis, Error};
use leadscrew_hal_mock::scenario::Trouble;
use leadscrew_host::axis::scope::{Before, Wanted};
use leadscrew_host::axis::telemetry;
use leadscrew_host::desk::{Desk, estimators, faults, law};
use leadscrew_host::recorded::{REPLAY_SIGNALS, Recorded, Source, read, write};

use crate::support::Shared;

/// Out of a file, as at a desk.
fn filed(recorded: &Recorded) -> Recorded {
    let file = tempfile::NamedTempFile::new().unwrap();
    let mut out = Vec::new();
    write(recorded, &mut out).unwrap();
    std::fs::write(file.path(), &out).unwrap();
    read(file.path()).unwrap()
}

/// Arms the scope for a fault, lets `trouble` begin in the middle of a move, and reads what there was.
fn provoked(trouble: &Trouble, feed_mm_per_min: f64) -> Recorded {
    let shared = Shared::new(1000.0);
    let mut tool = shared.ready();
    let wanted = Wanted {
        signals: REPLAY_SIGNALS.to_vec(),
        seconds: Some(1.2),
        every: Some(1),
        trigger: "fault".parse().unwrap(),
        before: Before::Share(0.75),
    };
    let setup = wanted
        .setup(tool.scale().unwrap(), tool.scope_room(8))
        .unwrap();
    tool.arm_scope(&setup).unwrap();
    tool.wait(Duration::from_millis(800)).unwrap();
    tool.move_to(60.0, feed_mm_per_min).unwrap();
    tool.wait(Duration::from_millis(600)).unwrap();
    shared.break_it(trouble);
    assert!(matches!(fault_of(&mut tool), Error::Faulted(_)));
    let scope = tool
        .wait_for_scope(Duration::from_secs(5))
        .unwrap()
        .unwrap();
    let recording = tool.read_recording(&scope).unwrap();
    filed(&Recorded::of(&mut tool, Source::Scope, recording).unwrap())
}

fn fault_of(tool: &mut Axis) -> Error {
    tool.wait_for_rest().unwrap_err()
}

fn assert_found_again(trouble: &Trouble, feed_mm_per_min: f64, expected: Fault) {
    let recorded = provoked(trouble, feed_mm_per_min);
    let desk = Desk::new(&recorded).unwrap();
    let found = faults(&desk).unwrap();
    let latched = found.recorded.unwrap();
    assert_eq!(latched.fault, expected);
    assert!(latched.figures.is_some());
    assert!(found.agree(), "{found:?}");
}

#[test]
fn an_encoder_that_falls_silent_is_found_again() {
    assert_found_again(
        &Trouble::Encoder(leadscrew_hal_mock::scenario::EncoderTrouble::LineLoss),
        600.0,
        Fault::EncoderLoss,
    );
}

#[test]
fn a_coupling_that_slips_is_found_again() {
    assert_found_again(
        &Trouble::CouplingSlip { share: 1.0 },
        3000.0,
        Fault::FollowingError,
    );
}

#[test]
fn another_limit_makes_another_fault() {
    let mut recorded = provoked(&Trouble::CouplingSlip { share: 1.0 }, 3000.0);
    let limit = recorded
        .header
        .parameters
        .iter_mut()
        .find(|(name, _)| name == "supervisor.following_error_mm")
        .unwrap();
    limit.1 = leadscrew_host::recorded::Parameter::Number(0.05);
    let found = faults(&Desk::new(&recorded).unwrap()).unwrap();
    assert!(!found.agree());
    assert!(found.derived.unwrap().tick < found.recorded.unwrap().tick);
}

#[test]
fn estimates_and_commands_of_a_whole_move_come_out_again() {
    let shared = Shared::new(1000.0);
    let mut tool = shared.ready();
    tool.disable().unwrap();
    tool.subscribe(1).unwrap();
    tool.enable().unwrap();
    tool.move_and_wait(20.0, 3000.0).unwrap();
    let streamed = telemetry::stream(&mut tool, 2.0, 1).unwrap();
    assert_eq!(streamed.lost, 0);
    let recorded = filed(&Recorded::of(&mut tool, Source::Telemetry, streamed.recording).unwrap());
    let desk = Desk::new(&recorded).unwrap();
    let compared = estimators(&desk).unwrap();
    assert!(compared[0].is_the_axis_s && !compared[0].lacks_edges);
    let difference = compared[0].difference.unwrap();
    assert_eq!((difference.peak(), difference.count()), (0.0, 1800));
    let law = law(&desk).unwrap();
    assert!(!law.begins_in_loop && law.difference.count() > 1000);
    let share = law.difference.peak() / f64::from(1 << 30);
    println!("law: peak difference {share:e} of full command");
    assert!(share < 1e-4, "{share}");
    let found = faults(&desk).unwrap();
    assert!(found.agree(), "{found:?}");
}
