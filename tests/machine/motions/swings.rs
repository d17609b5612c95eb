//! Sine, the feed of a calibration, ripple.

use std::f64::consts::TAU;

use leadscrew_hal_mock::arc::State;
use leadscrew_hal_mock::scene::{Motion, Ripple, Swing};

use super::{START_D, assert_state, ideal, largest, rippled, run};
use crate::statistics::amplitude;

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
