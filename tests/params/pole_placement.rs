//! Pole placement puts the poles where it says, and its feedforward undoes the drive.

use leadscrew::params::ControllerParams;
use leadscrew::tuning::DriveModel;
use proptest::prelude::*;

use crate::seeded::seeded;

/// Drives and bandwidths of retrofits: a natural period of 20 to 200 ms, damping from 0.3 to 1.2.
fn drives() -> impl Strategy<Value = (DriveModel, f64)> {
    let model = (0.02..0.2_f64, 0.3..1.2_f64).prop_map(|(natural_period_s, damping)| {
        DriveModel::second_order(natural_period_s, damping)
    });
    (model, 5.0..200.0_f64)
}

/// The loop of a drive and its gains in continuous time, in mm and s, with the setpoint at zero: the documented
/// law on the documented drive. State: ∫x, x, v, v′.
fn derivative(drive: &DriveModel, gains: &ControllerParams, state: [f64; 4]) -> [f64; 4] {
    let omega = std::f64::consts::TAU / drive.natural_period_s;
    let [sum, position, velocity, acceleration] = state;
    let demand = -gains.integral_gain_per_s2 * sum
        - gains.position_gain_per_s * position
        - gains.velocity_gain * velocity
        - gains.acceleration_gain_s * acceleration;
    let bend = omega * omega * (demand - velocity) - 2.0 * drive.damping * omega * acceleration;
    [position, velocity, acceleration, bend]
}

/// Classical Runge-Kutta over `span` in `steps` steps.
fn integrate(
    drive: &DriveModel,
    gains: &ControllerParams,
    start: [f64; 4],
    span: f64,
    steps: u32,
) -> [f64; 4] {
    let step = span / f64::from(steps);
    let moved =
        |from: [f64; 4], by: [f64; 4], share: f64| std::array::from_fn(|i| from[i] + share * by[i]);
    (0..steps).fold(start, |state, _| {
        let k1 = derivative(drive, gains, state);
        let k2 = derivative(drive, gains, moved(state, k1, step / 2.0));
        let k3 = derivative(drive, gains, moved(state, k2, step / 2.0));
        let k4 = derivative(drive, gains, moved(state, k3, step));
        std::array::from_fn(|i| state[i] + step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    })
}

proptest! {
    #![proptest_config(seeded(64))]

    #[test]
    fn pole_placement_puts_all_four_poles_of_the_simulated_loop_at_the_bandwidth(
        (drive, pole) in drives(),
        start in prop::array::uniform4(-1.0..1.0_f64),
    ) {
        let gains = drive.place_poles(pole).unwrap();
        // States of one size: ∫x, x, v, v′ in units of the pole.
        let start = std::array::from_fn(|i| start[i] * pole.powi(i as i32 - 1));
        // Four equal poles at −p make x(t)·exp(p·t) a cubic, whatever the start: its fourth difference is zero.
        // 200 steps over 1/p leave a relative error of some 1e-10 in each sample.
        let interval = 1.0 / pole;
        let mut state = start;
        let samples: [f64; 5] = std::array::from_fn(|sample| {
            let value = state[1] * (sample as f64).exp();
            state = integrate(&drive, &gains, state, interval, 200);
            value
        });
        let [s0, s1, s2, s3, s4] = samples;
        let fourth = s0 - 4.0 * s1 + 6.0 * s2 - 4.0 * s3 + s4;
        let size = samples.iter().fold(1.0_f64, |size, sample| size.max(sample.abs()));
        prop_assert!(fourth.abs() < 1e-6 * size, "{:e} of {}", fourth, size);
    }

    #[test]
    fn the_characteristic_polynomial_of_the_placed_loop_is_a_fourth_power((drive, pole) in drives()) {
        let gains = drive.place_poles(pole).unwrap();
        let omega = std::f64::consts::TAU / drive.natural_period_s;
        let stiffness = omega * omega;
        let coefficients = [
            stiffness * gains.integral_gain_per_s2,
            stiffness * gains.position_gain_per_s,
            stiffness * (1.0 + gains.velocity_gain),
            2.0 * drive.damping * omega + stiffness * gains.acceleration_gain_s,
        ];
        let expected = [pole.powi(4), 4.0 * pole.powi(3), 6.0 * pole * pole, 4.0 * pole];
        for (seen, expected) in coefficients.into_iter().zip(expected) {
            // Cancellation against the drive's own terms costs some digits.
            prop_assert!((seen - expected).abs() <= 1e-12 * (expected + stiffness + omega), "{} instead of {}", seen, expected);
        }
    }
}

#[test]
fn the_feedforward_of_a_placed_loop_is_the_inverse_of_the_drive() {
    // v = t³/6 needs u = v + (2ζ/ω)v′ + v″/ω²; put through the drive's own equation nothing is left.
    let drive = DriveModel::second_order(0.09, 0.5);
    let gains = drive.place_poles(35.0).unwrap();
    let omega = std::f64::consts::TAU / 0.09;
    for time in [0.0, 0.1, 0.5] {
        let (velocity, acceleration, jerk) = (time * time * time / 6.0, time * time / 2.0, time);
        let demand = gains.velocity_feedforward * velocity
            + gains.acceleration_feedforward_s * acceleration
            + gains.jerk_feedforward_s2 * jerk;
        let left = jerk + omega * acceleration + omega * omega * (velocity - demand);
        assert!(left.abs() < 1e-9, "{left}");
    }
}

#[test]
fn drives_and_bandwidths_that_make_no_sense_are_refused() {
    let place = |natural_period_s, damping, bandwidth| {
        DriveModel::second_order(natural_period_s, damping)
            .place_poles(bandwidth)
            .unwrap_err()
    };
    for (error, name, min, max) in [
        (place(0.0, 0.5, 35.0), "natural_period_s", 1e-4, 10.0),
        (place(f64::NAN, 0.5, 35.0), "natural_period_s", 1e-4, 10.0),
        (place(0.09, -0.5, 35.0), "damping", 0.01, 10.0),
        (place(0.09, 0.5, 0.0), "bandwidth_rad_per_s", 0.1, 1e4),
        (
            place(0.09, 0.5, f64::INFINITY),
            "bandwidth_rad_per_s",
            0.1,
            1e4,
        ),
    ] {
        assert_eq!((error.name, error.min, error.max), (name, min, max));
    }
}
