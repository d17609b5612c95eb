//! Parameters: what is valid, what is refused and how it is said, and what the gains come to.

use leadscrew::axis::{Axis, Inputs};
use leadscrew::controller::tuning::DriveModel;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::Capture;
use leadscrew::parameter_table::ParameterTable;
use leadscrew::params::{AxisConfig, AxisParams, ControllerParams, MotionParams, OutputParams, ParamError};
use leadscrew::units::RangeError;
use proptest::prelude::*;

#[path = "support/seeded.rs"]
mod seeded;
use seeded::seeded;

fn defaults() -> AxisParams {
    AxisParams {
        tick_hz: 1000.0,
        timer_hz: 84e6,
        motion: MotionParams::default(),
        estimator: EstimatorConfig::by_name("exponential").unwrap().unwrap(),
        controller: ControllerParams::default(),
        output: OutputParams::default(),
    }
}

#[track_caller]
fn range_error(params: &AxisParams) -> RangeError {
    match params.validate() {
        Err(ParamError::Range(error)) => error,
        other => panic!("{other:?} is not an error of range"),
    }
}

#[test]
fn the_defaults_are_valid_with_every_estimator_at_every_usual_tick_rate() {
    for name in EstimatorConfig::NAMES {
        for tick_hz in [1000.0, 2500.0, 10_000.0, 35_000.0] {
            let estimator = EstimatorConfig::by_name(name).unwrap().unwrap();
            let config = AxisParams { tick_hz, estimator, ..defaults() }.validate().unwrap();
            assert_eq!(config.estimator.name(), *name);
        }
    }
}

#[test]
fn the_limits_of_moves_are_the_parameters_in_d_and_ticks() {
    let AxisConfig { limits, .. } = defaults().validate().unwrap();
    // 9 000 mm/min, 0.9 m/s² and 10 m/s³ at 1 000 d/mm and 1 kHz; each rounded down to its grid.
    for (limit, expected, lsb) in [
        (limits.velocity().to_num::<f64>(), 150.0, 0.5_f64.powi(20)),
        (limits.acceleration().to_num::<f64>(), 0.9, 0.5_f64.powi(24)),
        (limits.jerk().to_num::<f64>(), 0.01, 0.5_f64.powi(29)),
    ] {
        assert!(limit <= expected && limit > expected - 1.01 * lsb, "{limit}");
    }
}

/// Sets every field of a table beyond both of its bounds, and to what is no number; `place` puts the table
/// into the parameters.
fn assert_fields_are_guarded<T: ParameterTable>(place: impl Fn(&mut AxisParams, T)) {
    for field in T::FIELDS {
        assert!(!field.unit.is_empty() && !field.description.is_empty(), "{}", field.name);
        assert!((field.min..=field.max).contains(&(field.get)(&T::default())), "{}", field.name);
        for value in [field.min.next_down(), field.max.next_up(), f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            let mut table = T::default();
            (field.set)(&mut table, value);
            let stored = (field.get)(&table);
            assert!(stored == value || stored.is_nan() && value.is_nan(), "{}", field.name);

            let mut params = defaults();
            place(&mut params, table);
            let error = range_error(&params);
            assert_eq!(error.name, field.name);
            // The encoder's resolution is checked as a scale, whose range is that of the field.
            assert_eq!((error.min, error.max), (field.min, field.max), "{}", field.name);
            let message = ParamError::from(error).to_string();
            let (name, min, max) = (field.name, field.min, field.max);
            assert_eq!(message, format!("{name} = {value} is out of range: allowed {min} to {max}"));
        }
    }
}

#[test]
fn every_field_beyond_its_range_is_refused_by_name_value_and_range() {
    // The full-command feed is needed for the scale of all gains before the table is looked at.
    assert_fields_are_guarded::<ControllerParams>(|params, table| params.controller = table);
    assert_fields_are_guarded::<OutputParams>(|params, table| params.output = table);
    assert_fields_are_guarded::<MotionParams>(|params, table| params.motion = table);
}

#[test]
fn tick_and_timer_rates_out_of_range_are_refused() {
    for tick_hz in [0.0, 99.9, 40_001.0, 1e9, -1000.0, f64::NAN, f64::INFINITY] {
        let error = range_error(&AxisParams { tick_hz, ..defaults() });
        assert_eq!((error.name, error.min, error.max), ("tick_hz", 100.0, 40_000.0), "{tick_hz}");
    }
    for timer_hz in [0.0, 999_999.0, 2.6e8, -84e6, f64::NAN, f64::INFINITY] {
        let error = range_error(&AxisParams { timer_hz, ..defaults() });
        assert_eq!((error.name, error.min, error.max), ("timer_hz", 1e6, 250e6), "{timer_hz}");
    }
}

#[test]
fn a_feed_above_95_percent_of_full_command_is_refused_and_the_message_says_why() {
    let with_feed = |max_feed_mm_per_min| AxisParams {
        motion: MotionParams { max_feed_mm_per_min, ..MotionParams::default() },
        ..defaults()
    };
    // 95 % of 9 600 mm/min.
    assert!(with_feed(9120.0).validate().is_ok());
    let error = with_feed(9121.0).validate().unwrap_err();
    assert_eq!(error, ParamError::FeedTooHigh { max_feed_mm_per_min: 9121.0, full_command_feed_mm_per_min: 9600.0 });
    let message = error.to_string();
    for part in ["max_feed_mm_per_min = 9121", "allowed 0 to 9120", "95 %", "9600 mm/min"] {
        assert!(message.contains(part), "{part} in: {message}");
    }
}

#[test]
fn limits_that_the_formats_cannot_carry_are_refused_in_the_units_of_the_tick() {
    // 10⁶ d/mm at 150 mm/s and 1 kHz are 150 000 d/tick.
    let motion = MotionParams { counts_per_mm: 1e6, ..MotionParams::default() };
    let error = range_error(&AxisParams { motion, ..defaults() });
    assert_eq!((error.name, error.max), ("max_velocity_d_per_tick", 2047.0));
    assert!((error.value - 150_000.0).abs() < 1e-6);
}

#[test]
fn gains_too_large_for_the_common_scale_are_refused() {
    let controller = ControllerParams { acceleration_gain_s: 10.0, derivative_gain: 1e4, ..ControllerParams::default() };
    // At 1 000 d/mm full command is 160 d/tick: kd = 1e4/160 per d, times 2¹⁴ LSB per LSB, fits easily.
    assert!(AxisParams { controller, ..defaults() }.validate().is_ok());
    // At 0.001 d/mm it is 1.6e-4 d/tick, and the same gain a million times larger.
    let motion = MotionParams {
        counts_per_mm: 0.001,
        max_acceleration_m_s2: 1e4,
        max_jerk_m_s3: 1e7,
        ..MotionParams::default()
    };
    let error = range_error(&AxisParams { controller, motion, ..defaults() });
    assert!(error.name.contains("gain") && error.value > error.max, "{error}");
    // Two gains that are each possible, but not together.
    let together = ControllerParams { derivative_gain: 12.0, position_gain_per_s: 1e4, ..ControllerParams::default() };
    let error = range_error(&AxisParams { controller: together, motion, ..defaults() });
    assert_eq!(error.name, "sum of the controller's gains");
}

proptest! {
    #![proptest_config(seeded(512))]

    #[test]
    fn validation_of_any_parameters_ends_with_a_config_that_runs_or_an_error_that_names_a_parameter(
        tick_hz in 50.0..50_000.0_f64,
        shares in prop::collection::vec(0.0..=1.0_f64, 32),
    ) {
        let mut shares = shares.into_iter();
        let mut params = AxisParams { tick_hz, ..defaults() };
        fill(&mut params.motion, &mut shares);
        fill(&mut params.controller, &mut shares);
        fill(&mut params.output, &mut shares);
        match params.validate() {
            Ok(config) => {
                let mut axis = Axis::new(config);
                for count in [0, 0, 1, 7, 7] {
                    axis.step(&Inputs { capture: Capture { count, ..Capture::default() }, enable: true });
                }
            }
            Err(error) => prop_assert!(error.to_string().contains(" is out of range: allowed "), "{}", error),
        }
    }
}

/// Fields between their bounds: towards the default by the cube, so that valid sets are not rare.
fn fill<T: ParameterTable>(table: &mut T, shares: &mut impl Iterator<Item = f64>) {
    for field in T::FIELDS {
        let (share, default) = (shares.next().unwrap() * 2.0 - 1.0, (field.get)(table));
        let room = if share < 0.0 { default - field.min } else { field.max - default };
        (field.set)(table, default + room * share.powi(3).clamp(-1.0, 1.0));
    }
}

/// Drives and bandwidths of retrofits: a natural period of 20 to 200 ms, damping from 0.3 to 1.2.
fn drives() -> impl Strategy<Value = (DriveModel, f64)> {
    let model = (0.02..0.2_f64, 0.3..1.2_f64)
        .prop_map(|(natural_period_s, damping)| DriveModel { natural_period_s, damping });
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
fn integrate(drive: &DriveModel, gains: &ControllerParams, start: [f64; 4], span: f64, steps: u32) -> [f64; 4] {
    let step = span / f64::from(steps);
    let moved = |from: [f64; 4], by: [f64; 4], share: f64| std::array::from_fn(|i| from[i] + share * by[i]);
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
    let drive = DriveModel { natural_period_s: 0.09, damping: 0.5 };
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
        DriveModel { natural_period_s, damping }.place_poles(bandwidth).unwrap_err()
    };
    for (error, name, min, max) in [
        (place(0.0, 0.5, 35.0), "natural_period_s", 1e-4, 10.0),
        (place(f64::NAN, 0.5, 35.0), "natural_period_s", 1e-4, 10.0),
        (place(0.09, -0.5, 35.0), "damping", 0.01, 10.0),
        (place(0.09, 0.5, 0.0), "bandwidth_rad_per_s", 0.1, 1e4),
        (place(0.09, 0.5, f64::INFINITY), "bandwidth_rad_per_s", 0.1, 1e4),
    ] {
        assert_eq!((error.name, error.min, error.max), (name, min, max));
    }
}
