//! What is wrong is seen, in time and distance, and named.

use leadscrew::tachogenerator::Disagreement;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::MoveAndBack;

use crate::runs::{Watched, watch};

/// In the cruise of the standard move, when the gain has been learned.
const FROM: usize = 1800;
const TOLERANCE: f64 = 0.03;
const FLOOR: f64 = 25.0 / 60.0;
const DISTANCE: f64 = 100.0;

/// Estimators, and the ticks that each needs to follow a step of the velocity, its lag included.
const SETTLING: [(&str, f64); 5] = [
    ("difference", 2.0),
    ("exponential", 18.0),
    ("simple", 16.0),
    ("gaussian", 14.0),
    ("polynomial", 26.0),
];

fn coupled(slip: f64) -> MachineParams {
    let mut machine = MachineParams::z_16k20f3();
    machine.mount.coupling_slip = slip;
    machine.mount.slip_from_s = FROM as f64 / 1000.0;
    machine
}

/// Asserts that a loss of the share `slip` is seen within the documented time and distance.
#[track_caller]
fn assert_in_time(watched: &Watched, slip: f64, settling: f64) {
    let first = watched.first().expect("it is seen");
    assert!(first >= FROM, "seen at {first}, before it happened");
    let speed = watched.speed[FROM].abs();
    let ticks = DISTANCE / ((slip - TOLERANCE) * speed - FLOOR) + settling + 2.0;
    let taken = (first - FROM) as f64;
    assert!(taken <= ticks, "{taken} ticks, allowed {ticks}");
    let way: f64 = watched.speed[FROM..first].iter().map(|v| v.abs()).sum();
    assert!(way <= ticks * 160.0, "{way} d");
}

#[test]
fn a_broken_coupling_is_seen_in_time() {
    for (estimator, settling) in SETTLING {
        let scenario = MoveAndBack::standard(1000.0);
        let watched = watch(&coupled(1.0), &scenario, estimator, 1, |_, reading| reading);
        assert_in_time(&watched, 1.0, settling);
        let late = watched.seen[FROM + 100];
        assert_eq!(late, Some(Disagreement::Broken), "{estimator}");
    }
}

#[test]
fn a_slipping_encoder_is_seen_in_time() {
    for (estimator, settling) in SETTLING {
        for slip in [0.06, 0.2] {
            let scenario = MoveAndBack::standard(1000.0);
            let watched = watch(&coupled(slip), &scenario, estimator, 1, |_, reading| {
                reading
            });
            assert_in_time(&watched, slip, settling);
            let late = watched.seen[FROM + 100];
            assert_eq!(late, Some(Disagreement::Slipping), "{estimator}, {slip}");
        }
    }
}

#[test]
fn a_slip_within_the_tolerance_shows_in_the_gain_alone() {
    let scenario = MoveAndBack::standard(1000.0);
    let watched = watch(&coupled(0.02), &scenario, "exponential", 1, |_, reading| {
        reading
    });
    assert_eq!(watched.first(), None);
    let gain: f64 = watched.check.gain().to_num();
    assert!((gain * 0.98 - 1.0).abs() < 0.003, "{gain}");
}

#[test]
fn a_break_at_creep_is_seen_by_its_distance() {
    let mut machine = coupled(1.0);
    machine.mount.slip_from_s = 0.6;
    let scenario = MoveAndBack {
        feed_mm_per_min: 300.0,
        move_mm: 20.0,
        ..MoveAndBack::standard(1000.0)
    };
    let watched = watch(&machine, &scenario, "exponential", 1, |_, reading| reading);
    let first = watched.first().expect("it is seen");
    assert!(first >= 600);
    // Not learned yet at that speed: the start's tolerance of 0.2 and floor of 1 d/tick.
    let way: f64 = watched.speed[600..first].iter().sum();
    assert!(way > 100.0 && way < 350.0, "{way} d");
    assert_eq!(watched.seen[first + 100], Some(Disagreement::Broken));
}

#[test]
fn wiring_is_told_from_the_encoder() {
    type Wiring = fn(f64) -> f64;
    let scenario = MoveAndBack::standard(1000.0);
    // With the share of the speed beyond the start's tolerance, 0.2 of the larger of the two.
    let faults: [(Wiring, Disagreement, f64); 4] = [
        (|reading| -reading, Disagreement::Reversed, 1.8),
        (|_| 0.0, Disagreement::Dead, 0.8),
        (|reading| 0.7 * reading, Disagreement::Weak, 0.1),
        (|reading| 1.5 * reading, Disagreement::Slipping, 0.2),
    ];
    for (wiring, expected, beyond) in faults {
        let machine = MachineParams::z_16k20f3();
        // From the start: before anything was learned.
        let watched = watch(&machine, &scenario, "polynomial", 1, |_, v| wiring(v));
        let first = watched.first().expect("it is seen");
        let way: f64 = watched.speed[..first].iter().sum();
        // A floor of 1 d/tick from the first motion on, and a few ticks to follow the acceleration.
        let moving = watched.speed[..first].iter().filter(|v| **v > 0.3).count() as f64;
        let allowed = (DISTANCE + moving) / beyond + 100.0;
        assert!(way < allowed, "{expected:?}: {way} d, allowed {allowed}");
        assert_eq!(watched.seen[first + 100], Some(expected));
        // In the cruise: from then on.
        let from = |tick: usize, v: f64| if tick < FROM { v } else { wiring(v) };
        let watched = watch(&machine, &scenario, "polynomial", 1, from);
        let first = watched.first().expect("it is seen");
        assert!((FROM..FROM + 8).contains(&first), "{expected:?}: {first}");
        assert_eq!(watched.seen[first + 100], Some(expected));
    }
}

#[test]
fn agreement_is_believed_after_a_time_of_motion() {
    let machine = MachineParams::z_16k20f3();
    let scenario = MoveAndBack::standard(1000.0);
    // Dead for 0.2 s in the cruise.
    let gap = |tick: usize, v: f64| {
        if (FROM..FROM + 200).contains(&tick) {
            0.0
        } else {
            v
        }
    };
    let watched = watch(&machine, &scenario, "exponential", 1, gap);
    let first = watched.first().expect("it is seen");
    let length = watched.seen[first..]
        .iter()
        .take_while(|seen| seen.is_some())
        .count();
    let end = first + length;
    assert!((FROM + 400..FROM + 430).contains(&end), "ends at {end}");
    assert_eq!(watched.check.health().disagreements, 1);
    // Dead until the axis stands: nothing speaks for it until it moves back.
    let rest = FROM
        + (0..)
            .position(|tick| watched.speed[FROM + tick].abs() < 0.2)
            .unwrap();
    let until_rest = |tick: usize, v: f64| if (FROM..rest).contains(&tick) { 0.0 } else { v };
    let watched = watch(&machine, &scenario, "exponential", 1, until_rest);
    let back = rest
        + (0..)
            .position(|tick| watched.speed[rest + tick] < -2.0)
            .unwrap();
    assert!(watched.seen[back].is_some());
    assert!(watched.seen[back + 300].is_none());
}
