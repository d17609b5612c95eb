//! Recordings: whole, in physical units, the same out of a file, and told where something is missing.

use std::time::Duration;

use leadscrew::scope::{Signal, Signals, Trigger};
use leadscrew_host::axis::scope::{Before, Move, TriggerText, Wanted, WhatTrigger, record};
use leadscrew_host::axis::telemetry;
use leadscrew_host::recorded::{Recorded, Source, is_recording, read, write};

use crate::support::Shared;

const PATIENCE: Duration = Duration::from_secs(20);

fn wanted(signals: &[Signal], seconds: f64, trigger: &str) -> Wanted {
    Wanted {
        signals: signals.to_vec(),
        seconds: Some(seconds),
        every: None,
        trigger: trigger.parse().unwrap(),
        before: Before::Share(0.25),
    }
}

#[test]
fn a_move_is_recorded_in_millimetres_and_is_the_same_out_of_its_file() {
    let shared = Shared::new(1000.0);
    let mut tool = shared.ready();
    let signals = [
        Signal::ReportedPosition,
        Signal::CommandedPosition,
        Signal::FollowingError,
        Signal::SetpointVelocity,
        Signal::Command,
    ];
    let motion = Move {
        target_mm: 20.0,
        feed_mm_per_min: 3000.0,
    };
    let wanted = wanted(&signals, 1.6, "motion");
    let recording = record(&mut tool, &wanted, Some(motion), PATIENCE).unwrap();
    assert_eq!((recording.len(), recording.trigger), (1600, Some(400)));
    assert_eq!(recording.missing(), 0);
    let last = |signal| *recording.values(signal).unwrap().last().unwrap();
    assert!((last(Signal::CommandedPosition) - 20.0).abs() < 1e-3);
    assert!((last(Signal::ReportedPosition) - 20.0).abs() < 0.02);
    let velocities = recording.values(Signal::SetpointVelocity).unwrap();
    let fastest = velocities.into_iter().fold(0.0, f64::max);
    assert!((fastest - 3000.0).abs() < 1.0, "{fastest} mm/min");

    let recorded = Recorded::of(&mut tool, Source::Scope, recording).unwrap();
    let file = tempfile::NamedTempFile::new().unwrap();
    let mut out = Vec::new();
    write(&recorded, &mut out).unwrap();
    std::fs::write(file.path(), &out).unwrap();
    assert!(is_recording(file.path()));
    assert!(read(file.path()).unwrap() == recorded);
}

#[test]
fn what_does_not_fit_is_told_with_what_does() {
    let shared = Shared::new(1000.0);
    let mut tool = shared.ready();
    let long = Wanted {
        every: Some(1),
        ..wanted(&Signal::ALL[..8], 2.0, "now")
    };
    let error = record(&mut tool, &long, None, PATIENCE).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    let text = error.to_string();
    assert!(
        text.contains("1.250 s do") && text.contains("--every 2"),
        "{text}"
    );
    let sparse = Wanted {
        every: None,
        ..long
    };
    let recording = record(&mut tool, &sparse, None, PATIENCE).unwrap();
    assert_eq!((recording.every, recording.len()), (2, 1000));
}

#[test]
fn a_trigger_that_does_not_come_leaves_what_there_was() {
    let shared = Shared::new(1000.0);
    let mut tool = shared.ready();
    let wanted = wanted(&[Signal::Count], 0.2, "fault");
    let recording = record(&mut tool, &wanted, None, Duration::from_millis(100)).unwrap();
    assert_eq!(recording.trigger, None);
    assert_eq!(recording.len(), 200);
}

/// Signals at tick rate for a second: samples that came, and that are missing.
fn streamed(tick_hz: f64, signals: usize) -> (usize, u64) {
    let shared = Shared::new(tick_hz);
    let mut tool = shared.ready();
    tool.move_to(40.0, 3000.0).unwrap();
    let mut live = tool.live(&Signal::ALL[..signals], 1).unwrap();
    tool.listen(&mut live, Duration::from_secs(1)).unwrap();
    tool.end_live(&mut live).unwrap();
    let recording = live.into_recording();
    // Every sample that came is where it belongs.
    let ticks = recording.bits(Signal::Tick).unwrap();
    assert_eq!(ticks, recording.ticks);
    // Whole values: the position is at its count, however many bits of it travelled.
    let counts = recording.bits(Signal::Count).unwrap();
    let positions = recording.bits(Signal::Position).unwrap();
    for (count, position) in counts.iter().zip(positions) {
        // The estimate lags; a wrap would be 65 536 d.
        assert!(
            (position >> 16).abs_diff(*count) < 1000,
            "{count} {position}"
        );
    }
    for w in recording.ticks.windows(2) {
        if w[1] - w[0] != 1 {
            println!("GAP {w:?}");
        }
    }
    (recording.len(), recording.missing())
}

#[test]
fn eight_signals_at_tick_rate_come_without_loss_at_1_khz_and_what_does_not_fit_is_counted() {
    let (came, missing) = streamed(1000.0, 8);
    assert!(came > 950 && missing == 0, "{came} {missing}");
    let (came, missing) = streamed(2500.0, 6);
    assert!(came > 2350 && missing == 0, "{came} {missing}");
    let (came, missing) = streamed(2500.0, 8);
    println!("8 signals at 2.5 kHz: {came} came, {missing} missing");
    let (came, missing) = streamed(5000.0, 8);
    assert!(
        missing > 0 && came as u64 + missing > 4500,
        "{came} {missing}"
    );
}

#[test]
fn telemetry_is_recorded_with_whole_counts() {
    let shared = Shared::new(1000.0);
    let mut tool = shared.ready();
    tool.move_to(20.0, 3000.0).unwrap();
    let streamed = telemetry::stream(&mut tool, 0.5, 1).unwrap();
    let recording = streamed.recording;
    assert_eq!((recording.len(), streamed.lost), (500, 0));
    assert!(recording.bits(Signal::Count).unwrap().last() > Some(&10_000));
}

#[test]
fn a_trigger_in_words_is_the_axis_s_own() {
    let scale = Shared::new(1000.0).ready().scale().unwrap();
    let now = TriggerText::of(WhatTrigger::Now).at(scale);
    assert_eq!(now, Trigger::Now);
    assert!(Signals::new(&Signal::ALL[..8]).is_ok());
}
