//! The integral: its sum, its bound, and when it stands still.

use leadscrew::controller::Controller;
use leadscrew::controller::config::Gains;
use leadscrew::output::ActiveLimits;

use crate::signals::{
    AT_HIGH, AT_LOW, LSB, NOT_LIMITED, config, controller, demand, demanded, standing,
};

const GAIN: f64 = 1e-5;

/// Integral action alone, past its first tick.
fn integrator() -> Controller {
    let mut integrator = controller(
        Gains {
            integral: GAIN,
            ..Gains::default()
        },
        1.0,
    );
    demanded(&mut integrator, &standing(0.0));
    integrator
}

/// The demand after `ticks` of `error` d with `active` limits.
fn after(controller: &mut Controller, ticks: u32, error: f64, active: ActiveLimits) -> f64 {
    (0..ticks)
        .map(|_| demand(controller, &standing(error), active).to_num())
        .last()
        .unwrap()
}

#[test]
fn it_is_the_sum_of_the_errors() {
    let mut integrator = integrator();
    let mut sum = 0.0;
    for tick in 0..1000_i32 {
        let error = f64::from(tick % 37 - 12);
        sum += error;
        let seen = after(&mut integrator, 1, error, NOT_LIMITED);
        // The gain is rounded to 2⁻⁴⁰ per d and tick, errors of 25 d at most.
        let bound = LSB + f64::from(tick + 1) * 25.0 * 0.5_f64.powi(41);
        assert!((seen - GAIN * sum).abs() <= bound, "tick {tick}: {seen}");
    }
}

#[test]
fn it_stands_still_while_the_error_drives_a_limited_output_further() {
    for (active, outward) in [(AT_HIGH, 50.0), (AT_LOW, -50.0)] {
        let mut integrator = integrator();
        let filled = after(&mut integrator, 100, outward, NOT_LIMITED);
        let held = after(&mut integrator, 1000, outward, active);
        assert_eq!(held, filled);
    }
}

#[test]
fn it_unwinds_at_once_when_the_error_changes_sign_even_at_the_limit() {
    for (active, outward) in [(AT_HIGH, 50.0), (AT_LOW, -50.0)] {
        let mut integrator = integrator();
        let filled = after(&mut integrator, 100, outward, NOT_LIMITED);
        let unwound = after(&mut integrator, 10, -outward, active);
        let expected = filled - 10.0 * GAIN * outward;
        assert!(
            (unwound - expected).abs() <= 2.0 * LSB + 500.0 * 0.5_f64.powi(41),
            "{unwound} instead of {expected}"
        );
    }
}

#[test]
fn it_goes_on_while_the_other_limit_is_active() {
    let mut integrator = integrator();
    let against = after(&mut integrator, 100, 50.0, AT_LOW);
    assert!(
        (against - 100.0 * 50.0 * GAIN).abs() <= LSB + 5000.0 * 0.5_f64.powi(41),
        "{against}"
    );
}

#[test]
fn it_stays_within_full_command_and_leaves_the_bound_at_once() {
    for sign in [1.0, -1.0] {
        let mut integrator = integrator();
        // 30 000 d · 1e-5 is 0.3 a tick.
        assert_eq!(
            after(&mut integrator, 100, sign * 30_000.0, NOT_LIMITED),
            sign
        );
        let back = after(&mut integrator, 1, -sign * 10_000.0, NOT_LIMITED);
        assert!((back - sign * 0.9).abs() < 1e-6, "{back}");
    }
}

#[test]
fn a_deadband_keeps_it_from_creeping() {
    let gains = Gains {
        integral: GAIN,
        ..Gains::default()
    };
    let mut controller = Controller::new(config(&gains, 1.0, 0.0, 1.0));
    assert_eq!(after(&mut controller, 1000, 0.99, NOT_LIMITED), 0.0);
}
