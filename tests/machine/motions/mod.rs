//! Motions with a course against their closed forms; what all motions have in common.

mod s_curve;
mod swings;

use leadscrew_hal_mock::arc::State;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::{Motion, Ripple, SCurve, Scene, Swing};

const START_D: f64 = 0.5;

fn rippled(motion: Motion, ripple: Ripple) -> Scene {
    Scene::with_ripple(motion, ripple, &EncoderModel::ideal(), 1000.0, START_D, 1).unwrap()
}

fn ideal(motion: Motion) -> Scene {
    rippled(motion, Ripple::NONE)
}

/// The truth at the start and after each of so many ticks; the counts are its floors.
fn run(mut scene: Scene, ticks: u32) -> Vec<State> {
    let mut states = vec![scene.truth()];
    for tick in 0..ticks {
        scene.step();
        let truth = scene.truth();
        if (truth.position - truth.position.round()).abs() > 1e-7 {
            let count = f64::from(scene.capture().count.cast_signed());
            assert_eq!(count, truth.position.floor(), "tick {tick}");
        }
        states.push(truth);
    }
    states
}

/// Largest difference of `figure` between neighbours.
fn largest_step(states: &[State], figure: impl Fn(&State) -> f64) -> f64 {
    states.windows(2).fold(0.0, |largest, pair| {
        f64::max(largest, (figure(&pair[1]) - figure(&pair[0])).abs())
    })
}

/// Largest absolute value of `figure`.
fn largest(states: &[State], figure: impl Fn(&State) -> f64) -> f64 {
    states
        .iter()
        .fold(0.0, |largest, state| f64::max(largest, figure(state).abs()))
}

/// Asserts a state but for rounding, and for an acceleration off by `bend`.
#[track_caller]
fn assert_state(seen: State, exact: State, bend: f64, tick: usize) {
    assert!(
        (seen.position - exact.position).abs() < 1e-8
            && (seen.velocity - exact.velocity).abs() < 1e-9
            && (seen.acceleration - exact.acceleration).abs() < bend,
        "tick {tick}: {seen:?} instead of {exact:?}"
    );
}

#[test]
fn every_motion_has_its_mirror_image() {
    for motion in [
        Motion::Steady { velocity: 130.0 },
        Motion::Ramp {
            velocity: 5.0,
            acceleration: -0.05,
        },
        Motion::Jerk { jerk: 1e-4 },
        Motion::FLYWHEEL,
        Motion::s_curve(100),
        Motion::SINE,
        Motion::calibration(60.0, 10_000.0),
    ] {
        assert_ne!(motion, motion.reversed());
        assert_eq!(motion, motion.reversed().reversed());
        let there = run(ideal(motion), 3400);
        let back = run(ideal(motion.reversed()), 3400);
        for (there, back) in there.iter().zip(&back) {
            assert!((there.position + back.position - 2.0 * START_D).abs() < 1e-8);
            assert!((there.velocity + back.velocity).abs() < 1e-9);
            assert!((there.acceleration + back.acceleration).abs() < 1e-9);
        }
    }
}

#[test]
fn motions_that_cannot_be_are_refused() {
    let message = |motion| {
        Scene::new(motion, &EncoderModel::ideal(), 1000.0, 0.0, 1)
            .unwrap_err()
            .to_string()
    };
    let Motion::SCurve(curve) = Motion::s_curve(0) else {
        panic!("it is an S-curve");
    };
    let still = Motion::SCurve(SCurve { jerk: 0.0, ..curve });
    assert!(message(still).starts_with("jerk = 0 is out of range"));
    let none = Motion::calibration(0.0, 10_000.0);
    assert!(message(none).starts_with("period_ticks = inf is out of range"));
    let fast = Motion::Sine(Swing {
        amplitude: 1.0,
        period_ticks: 2.0,
        phase_turns: 0.0,
    });
    assert!(message(fast).starts_with("period_ticks = 2 is out of range"));
}
