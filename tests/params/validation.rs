//! What is valid, what is refused, and how it is said.

use leadscrew::axis::{Axis, Inputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::paths::Choice;
use leadscrew::hal::Capture;
use leadscrew::parameter_table::ParameterTable;
use leadscrew::params::{
    AxisConfig, AxisParams, CalmParams, ControllerParams, FilterParams, FrictionParams,
    MotionParams, OutputParams, ParamError,
};
use leadscrew::supervisor::SupervisorParams;
use leadscrew::units::RangeError;
use proptest::prelude::*;

use crate::seeded::seeded;

fn defaults() -> AxisParams {
    AxisParams::new(EstimatorConfig::by_name("exponential").unwrap().unwrap())
}

#[track_caller]
fn range_error(params: &AxisParams) -> RangeError {
    match params.validate() {
        Err(ParamError::Range(error) | ParamError::Law(error)) => error,
        other => panic!("{other:?} is not an error of range"),
    }
}

#[test]
fn the_defaults_are_valid_with_every_estimator_at_every_usual_tick_rate() {
    for name in EstimatorConfig::NAMES {
        for tick_hz in [1000.0, 2500.0, 10_000.0, 35_000.0] {
            let estimator = EstimatorConfig::by_name(name).unwrap().unwrap();
            let config = AxisParams {
                tick_hz,
                estimator,
                ..defaults()
            }
            .validate()
            .unwrap();
            assert_eq!(config.estimators.of(Choice::First).name(), *name);
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
        assert!(
            limit <= expected && limit > expected - 1.01 * lsb,
            "{limit}"
        );
    }
}

/// Sets every field of a table beyond both of its bounds, and to what is no number; `place` puts the table
/// into the parameters.
fn assert_fields_are_guarded<T: ParameterTable>(place: impl Fn(&mut AxisParams, T)) {
    for field in T::FIELDS {
        assert!(
            !field.unit.is_empty() && !field.description.is_empty(),
            "{}",
            field.name
        );
        assert!(
            (field.min..=field.max).contains(&(field.get)(&T::default())),
            "{}",
            field.name
        );
        for value in [
            field.min.next_down(),
            field.max.next_up(),
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NAN,
        ] {
            let mut table = T::default();
            (field.set)(&mut table, value);
            let stored = (field.get)(&table);
            assert!(
                stored == value || stored.is_nan() && value.is_nan(),
                "{}",
                field.name
            );

            let mut params = defaults();
            place(&mut params, table);
            let error = range_error(&params);
            assert_eq!(error.name, field.name);
            assert_eq!(
                (error.min, error.max),
                (field.min, field.max),
                "{}",
                field.name
            );
            let message = ParamError::from(error).to_string();
            let (name, min, max) = (field.name, field.min, field.max);
            assert_eq!(
                message,
                format!("{name} = {value} is out of range: allowed {min} to {max}")
            );
        }
    }
}

#[test]
fn every_field_beyond_its_range_is_refused_by_name_value_and_range() {
    assert_fields_are_guarded::<ControllerParams>(|params, table| params.controller = table);
    assert_fields_are_guarded::<FilterParams>(|params, table| params.filter = table);
    assert_fields_are_guarded::<FrictionParams>(|params, table| params.friction = table);
    assert_fields_are_guarded::<CalmParams>(|params, table| params.calm = table);
    assert_fields_are_guarded::<OutputParams>(|params, table| params.output = table);
    assert_fields_are_guarded::<MotionParams>(|params, table| params.motion = table);
    assert_fields_are_guarded::<SupervisorParams>(|params, table| params.supervisor = table);
}

#[test]
fn tick_and_timer_rates_out_of_range_are_refused() {
    for tick_hz in [0.0, 99.9, 40_001.0, 1e9, -1000.0, f64::NAN, f64::INFINITY] {
        let error = range_error(&AxisParams {
            tick_hz,
            ..defaults()
        });
        assert_eq!(
            (error.name, error.min, error.max),
            ("tick_hz", 100.0, 40_000.0),
            "{tick_hz}"
        );
    }
    for timer_hz in [0.0, 999_999.0, 2.6e8, -84e6, f64::NAN, f64::INFINITY] {
        let error = range_error(&AxisParams {
            timer_hz,
            ..defaults()
        });
        assert_eq!(
            (error.name, error.min, error.max),
            ("timer_hz", 1e6, 250e6),
            "{timer_hz}"
        );
    }
}

#[test]
fn a_feed_above_95_percent_of_full_command_is_refused_and_the_message_says_why() {
    let with_feed = |max_feed_mm_per_min| AxisParams {
        motion: MotionParams {
            max_feed_mm_per_min,
            ..MotionParams::default()
        },
        ..defaults()
    };
    // 95 % of 9 600 mm/min.
    assert!(with_feed(9120.0).validate().is_ok());
    let error = with_feed(9121.0).validate().unwrap_err();
    assert_eq!(
        error,
        ParamError::FeedTooHigh {
            max_feed_mm_per_min: 9121.0,
            full_command_feed_mm_per_min: 9600.0
        }
    );
    let message = error.to_string();
    for part in [
        "max_feed_mm_per_min = 9121",
        "allowed 0 to 9120",
        "95 %",
        "9600 mm/min",
    ] {
        assert!(message.contains(part), "{part} in: {message}");
    }
}

#[test]
fn limits_that_the_formats_cannot_carry_are_refused_in_the_units_of_the_tick() {
    // 10⁶ d/mm at 150 mm/s and 1 kHz are 150 000 d/tick.
    let motion = MotionParams {
        counts_per_mm: 1e6,
        ..MotionParams::default()
    };
    let error = range_error(&AxisParams {
        motion,
        ..defaults()
    });
    assert_eq!((error.name, error.max), ("max_velocity_d_per_tick", 2047.0));
    assert!((error.value - 150_000.0).abs() < 1e-6);
}

#[test]
fn gains_too_large_for_the_common_scale_are_refused() {
    let controller = ControllerParams {
        acceleration_gain_s: 10.0,
        derivative_gain: 1e4,
        ..ControllerParams::default()
    };
    // At 1 000 d/mm full command is 160 d/tick: kd = 1e4/160 per d, times 2¹⁴ LSB per LSB, fits easily.
    assert!(
        AxisParams {
            controller,
            ..defaults()
        }
        .validate()
        .is_ok()
    );
    // At 0.001 d/mm it is 1.6e-4 d/tick, and the same gain a million times larger.
    let motion = MotionParams {
        counts_per_mm: 0.001,
        max_acceleration_m_s2: 1e4,
        max_jerk_m_s3: 1e7,
        ..MotionParams::default()
    };
    let error = range_error(&AxisParams {
        controller,
        motion,
        ..defaults()
    });
    assert!(
        error.name.contains("gain") && error.value > error.max,
        "{error}"
    );
    // Two gains that are each possible, but not together.
    let together = ControllerParams {
        derivative_gain: 12.0,
        position_gain_per_s: 1e4,
        ..ControllerParams::default()
    };
    let error = range_error(&AxisParams {
        controller: together,
        motion,
        ..defaults()
    });
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
                    axis.step(&Inputs::of(Capture { count, ..Capture::default() }, true));
                }
            }
            Err(ParamError::TravelReversed { travel_low_mm, travel_high_mm }) => prop_assert!(travel_low_mm > travel_high_mm),
            Err(error) => prop_assert!(error.to_string().contains(" is out of range: allowed "), "{}", error),
        }
    }
}

/// Fields between their bounds: towards the default by the cube, so that valid sets are not rare.
fn fill<T: ParameterTable>(table: &mut T, shares: &mut impl Iterator<Item = f64>) {
    for field in T::FIELDS {
        let (share, default) = (shares.next().unwrap() * 2.0 - 1.0, (field.get)(table));
        let room = if share < 0.0 {
            default - field.min
        } else {
            field.max - default
        };
        (field.set)(table, default + room * share.powi(3));
    }
}

#[test]
fn soft_limits_the_wrong_way_round_are_told() {
    let mut params = defaults();
    params.motion.travel_low_mm = 10.0;
    params.motion.travel_high_mm = -10.0;
    let message = params.validate().unwrap_err().to_string();
    assert!(
        message.contains("travel_low_mm = 10 is above travel_high_mm = -10"),
        "{message}"
    );
    params.motion.travel_high_mm = 20.0;
    let travel = params.validate().unwrap().travel.unwrap();
    assert_eq!(
        (travel.low().to_num::<f64>(), travel.high().to_num::<f64>()),
        (10_000.0, 20_000.0)
    );
    params.motion.travel_high_mm = 10.0;
    assert_eq!(params.validate().unwrap().travel, None);
}
