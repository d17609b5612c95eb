//! Motions with a course: S-curve, swings, the feed of a calibration, ripple; against their closed forms.

use std::f64::consts::TAU;

use leadscrew_hal_mock::arc::State;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::{Motion, Ripple, SCurve, Scene, Swing};

use crate::statistics::amplitude;

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

/// Position, velocity and acceleration of a swing.
fn swing(swing: Swing, ticks: f64) -> State {
    let omega = TAU / swing.period_ticks;
    let angle = TAU * swing.phase_turns + omega * ticks;
    State {
        position: swing.amplitude * angle.sin(),
        velocity: swing.amplitude * omega * angle.cos(),
        acceleration: -swing.amplitude * omega * omega * angle.sin(),
    }
}

/// Amplitude of a swing's fourth derivative, d/tick⁴.
fn fourth_derivative(swing: Swing) -> f64 {
    swing.amplitude * (TAU / swing.period_ticks).powi(4)
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
fn the_s_curve_meets_its_velocity_within_its_limits() {
    let cruise = 200;
    let Motion::SCurve(curve) = Motion::s_curve(cruise) else {
        panic!("it is an S-curve");
    };
    // 90 ticks for the jerk, 76.7 more for the velocity at full acceleration.
    assert_eq!(curve.motion_ticks(), Ok(2 * (90 + 77 + 90) + cruise));
    let states = run(ideal(Motion::SCurve(curve)), 1000);
    assert!(largest(&states, |state| state.acceleration) <= 0.9);
    assert!(largest(&states, |state| state.acceleration) > 0.89);
    assert!(largest_step(&states, |state| state.acceleration) <= 0.01);
    // Each phase begins as planned, whatever rounding made of the last one's end.
    assert!((states[257].velocity - 150.0).abs() < 1e-12 && states[714].velocity.abs() < 1e-12);
    assert!(
        states[258..=457]
            .iter()
            .all(|state| state.velocity == 150.0)
    );
    assert!(
        states[715..]
            .iter()
            .all(|state| (state.velocity, state.acceleration) == (0.0, 0.0))
    );
    // Symmetric: each half of the change of velocity goes at its mean.
    let way = 150.0 * f64::from(cruise + 257);
    assert!((states[1000].position - START_D - way).abs() < 1e-8);
}

#[test]
fn the_s_curve_is_the_integral_of_its_jerk() {
    let states = run(ideal(Motion::s_curve(10)), 600);
    let acceleration = 150.0 / 167.0;
    let jerk = acceleration / 90.0;
    let ramp = |time: f64, from: f64, to: f64| (time.min(to) - from).max(0.0);
    for (tick, state) in states.iter().enumerate() {
        let time = tick as f64;
        // Jerk switches at these ticks; each switch adds a cubic from then on.
        let switches = [0.0, 90.0, 167.0, 257.0, 267.0, 357.0, 434.0, 524.0];
        let signs = [1.0, -1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0];
        let sum = |power: i32, factorial: f64| -> f64 {
            switches
                .iter()
                .zip(signs)
                .map(|(&at, sign)| sign * jerk * ramp(time, at, 1e9).powi(power) / factorial)
                .sum()
        };
        let exact = State {
            position: START_D + sum(3, 6.0),
            velocity: sum(2, 2.0),
            acceleration: sum(1, 1.0),
        };
        assert_state(*state, exact, 1e-9, tick);
    }
}

#[test]
fn an_s_curve_too_short_for_its_acceleration_stays_below_it() {
    let short = SCurve {
        velocity: 20.0,
        acceleration: 0.9,
        jerk: 0.01,
        cruise_ticks: 0,
        rest_ticks: 0,
        there_and_back: false,
    };
    // √(20/0.01) = 44.7 ticks.
    assert_eq!(short.motion_ticks(), Ok(4 * 45));
    let states = run(ideal(Motion::SCurve(short)), 200);
    assert!((states[90].velocity - 20.0).abs() < 1e-12);
    assert!(largest(&states, |state| state.acceleration) < 0.45);
    assert!(largest_step(&states, |state| state.acceleration) <= 0.01);
    assert!((states[180].position - START_D - 20.0 * 90.0).abs() < 1e-9);
}

#[test]
fn there_and_back_ends_where_it_began_and_rests_between() {
    let curve = SCurve {
        velocity: -150.0,
        acceleration: 0.9,
        jerk: 0.01,
        cruise_ticks: 30,
        rest_ticks: 50,
        there_and_back: true,
    };
    let once = curve.motion_ticks().unwrap() as usize + 50;
    let states = run(ideal(Motion::SCurve(curve)), 4 * once as u32 + 10);
    assert!(states[..=50].iter().all(|state| state.position == START_D));
    let far = START_D - 150.0 * (257.0 + 30.0);
    for (turn, place) in [(1, far), (2, START_D), (3, far), (4, START_D)] {
        for state in &states[turn * once + 1..=turn * once + 10] {
            assert!((state.position - place).abs() < 1e-7, "{turn}: {state:?}");
            assert_eq!((state.velocity, state.acceleration), (0.0, 0.0));
        }
    }
}

#[test]
fn the_sine_is_the_sine_and_its_acceleration_goes_on_from_tick_to_tick() {
    let Motion::Sine(reference) = Motion::SINE else {
        panic!("it is a sine");
    };
    // What a cubic between exact positions and velocities leaves.
    let bend = 1.1 * fourth_derivative(reference) / 12.0;
    assert!(bend < 1.2e-5);
    let mut scene = ideal(Motion::SINE);
    let mut states = vec![scene.truth()];
    for _ in 0..20_000 {
        scene.step();
        states.push(scene.truth());
    }
    for (tick, state) in states.iter().enumerate() {
        let exact = swing(reference, tick as f64);
        let from_start = State {
            position: exact.position + START_D,
            ..exact
        };
        assert_state(*state, from_start, bend, tick);
    }
    // Within each tick the acceleration is that of the arc: what the velocity gains, and no jump between.
    let jump = states.windows(2).fold(0.0, |jump, pair| {
        let gain = pair[1].velocity - pair[0].velocity;
        let mean = 0.5 * (pair[1].acceleration + pair[0].acceleration);
        f64::max(jump, (gain - mean).abs())
    });
    assert!(jump < 1e-6, "{jump:e}");
}

#[test]
fn a_swing_starts_anywhere_in_its_period_and_the_shaft_where_it_is_told() {
    let late = Swing {
        amplitude: 30.0,
        period_ticks: 77.7,
        phase_turns: 0.3,
    };
    let first = swing(late, 0.0).position;
    let bend = 1.1 * fourth_derivative(late) / 12.0;
    for (tick, state) in run(ideal(Motion::Sine(late)), 500).iter().enumerate() {
        let exact = swing(late, tick as f64);
        let position = exact.position - first + START_D;
        assert_state(*state, State { position, ..exact }, bend, tick);
    }
}

#[test]
fn the_calibration_feed_wobbles_and_drifts() {
    let velocity = 100.0;
    let motion = Motion::calibration(velocity, 10_000.0);
    let Motion::Feed { wobble, drift, .. } = motion else {
        panic!("it is a feed");
    };
    assert_eq!((wobble.amplitude, wobble.period_ticks), (1.7, 90.0));
    assert_eq!((drift.amplitude, drift.period_ticks), (3.0, 730.0));
    for (tick, state) in run(ideal(motion), 5000).iter().enumerate() {
        let time = tick as f64;
        let (short, long) = (swing(wobble, time), swing(drift, time));
        let exact = State {
            position: START_D + velocity * time + short.position + long.position,
            velocity: velocity + short.velocity + long.velocity,
            acceleration: short.acceleration + long.acceleration,
        };
        assert_state(*state, exact, 1e-5, tick);
    }
}

#[test]
fn a_ripple_keeps_to_the_angle_of_the_shaft() {
    // 125 ticks a revolution, so that a revolution is sampled at whole ticks.
    for velocity in [80.0_f64, -80.0] {
        let motion = Motion::Steady { velocity };
        let states = run(rippled(motion, Ripple::TWICE_A_REVOLUTION), 125 * 8);
        let off: Vec<f64> = (0..125 * 8)
            .map(|tick| states[tick].position - START_D - velocity * tick as f64)
            .collect();
        assert!((amplitude(&off, 16) - 0.02).abs() < 1e-7);
        assert!(amplitude(&off, 8) < 1e-7 && amplitude(&off, 24) < 1e-7);
        // Tied to the shaft, not to the start: zero at the shaft's zero.
        let expected = 0.02 * (TAU * 2.0 * (START_D + velocity * 30.0) / 10_000.0).sin();
        assert!((off[30] - expected).abs() < 1e-7, "{} {expected}", off[30]);
        // The truth has the ripple in all it says.
        let wave = 2.0 * TAU * velocity.abs() / 10_000.0;
        assert!(
            (largest(&states, |state| state.velocity - velocity) / (0.02 * wave) - 1.0).abs()
                < 1e-3
        );
        assert!(
            (largest(&states, |state| state.acceleration) / (0.02 * wave * wave) - 1.0).abs()
                < 3e-3
        );
    }
}

#[test]
fn a_ripple_goes_with_any_motion() {
    let smooth = run(ideal(Motion::s_curve(100)), 800);
    let rippled = run(
        rippled(Motion::s_curve(100), Ripple::TWICE_A_REVOLUTION),
        800,
    );
    for (tick, (with, without)) in rippled.iter().zip(&smooth).enumerate() {
        let ripple = 0.02 * (TAU * 2.0 * without.position / 10_000.0).sin();
        assert!(
            (with.position - without.position - ripple).abs() < 1e-7,
            "tick {tick}"
        );
    }
    assert_eq!(rippled[800].velocity, 0.0);
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
