//! The S-curve.

use leadscrew_hal_mock::arc::State;
use leadscrew_hal_mock::scene::{Motion, SCurve};

use super::{START_D, assert_state, ideal, largest, largest_step, run};

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
