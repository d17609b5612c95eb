//! The fixed-point law against the documented formula in f64.

use leadscrew::controller::config::Gains;
use leadscrew::controller::{Config, Controller};
use leadscrew::estimator::{Estimate, EstimatorConfig};
use leadscrew::params::AxisParams;
use leadscrew::setpoint::{Setpoint, Turn};
use leadscrew::tuning::DriveModel;
use leadscrew::units::{Acceleration, Jerk, Position, Velocity};
use proptest::prelude::*;

use crate::law_oracle::Oracle;
use crate::seeded::seeded;
use crate::signals::{LSB, NOT_LIMITED, Signals, config, controller, demanded, lags, standing};

fn gain(sign: bool) -> impl Strategy<Value = f64> {
    let size = (1e-7_f64.ln()..1.0_f64.ln()).prop_map(f64::exp);
    let size = prop_oneof![1 => Just(0.0), 4 => size];
    (size, any::<bool>())
        .prop_map(move |(size, negative)| if sign && negative { -size } else { size })
}

fn gains() -> impl Strategy<Value = Gains> {
    let integral = prop_oneof![
        Just(0.0),
        (1e-12_f64.ln()..1e-3_f64.ln()).prop_map(f64::exp)
    ];
    (
        gain(false),
        integral,
        gain(false),
        gain(true),
        gain(true),
        gain(false),
        gain(false),
        gain(false),
        prop_oneof![Just(0.0), 0.0..20.0_f64],
    )
        .prop_map(
            |(
                position,
                integral,
                derivative,
                velocity,
                acceleration,
                velocity_feedforward,
                acceleration_feedforward,
                jerk_feedforward,
                feedforward_lead,
            )| {
                Gains {
                    position,
                    integral,
                    derivative,
                    velocity,
                    acceleration,
                    velocity_feedforward,
                    acceleration_feedforward,
                    jerk_feedforward,
                    feedforward_lead,
                }
            },
        )
}

fn signals() -> impl Strategy<Value = Signals> {
    let setpoint = (any::<i32>(), -200.0..200.0, -5.0..5.0, -0.5..0.5).prop_map(
        |(position, velocity, acceleration, jerk)| Setpoint {
            position: Position::from_bits(i64::from(position)),
            velocity: Velocity::from_num::<f64>(velocity),
            acceleration: Acceleration::from_num::<f64>(acceleration),
            jerk: Jerk::from_num::<f64>(jerk),
            turn: Turn::NONE,
        },
    );
    let estimate = (-200.0..200.0, -5.0..5.0).prop_map(|(velocity, acceleration)| Estimate {
        velocity: Velocity::from_num::<f64>(velocity),
        acceleration: Acceleration::from_num::<f64>(acceleration),
        ..Estimate::default()
    });
    // Following errors from an LSB to a thousand d.
    let behind = prop_oneof![-100..100_i64, -(1000 << 16)..1000_i64 << 16];
    (setpoint, estimate, behind).prop_map(|(setpoint, estimate, behind)| {
        let position = setpoint.position - Position::from_bits(behind);
        Signals {
            setpoint,
            position,
            estimate,
        }
    })
}

proptest! {
    #![proptest_config(seeded(512))]

    #[test]
    fn the_law_is_the_documented_formula_within_its_rounding(
        gains in gains(),
        (lag_v, lag_a) in (0.0..20.0_f64, 0.0..20.0_f64),
        // On the grid of positions, which the law rounds it to.
        deadband in prop_oneof![Just(0_u32), 0..20_u32 << 16],
        bias in -0.1..0.1_f64,
        transfer_ticks in 1.0..200.0_f64,
        ticks in prop::collection::vec(signals(), 1..50),
    ) {
        let deadband = f64::from(deadband) / 65_536.0;
        let lags = lags(lag_v, lag_a);
        let config = Config::new(&gains, &lags, deadband, bias, transfer_ticks).unwrap();
        let mut controller = Controller::new(config);
        let mut oracle = Oracle::new(gains, lags, deadband, bias, transfer_ticks);
        for signals in &ticks {
            let (expected, bound) = oracle.step(signals);
            let seen = demanded(&mut controller, signals);
            prop_assert!((seen - expected).abs() <= bound, "{} instead of {} ± {:e}", seen, expected, bound);
        }
    }
}

/// The tuning of the reference machine at the bandwidth of an estimator that lags by five ticks.
fn lathe_gains(tick_hz: f64) -> (AxisParams, Config) {
    let drive = DriveModel::second_order(0.09, 0.5);
    let estimator = EstimatorConfig::by_name("exponential").unwrap().unwrap();
    let params = AxisParams {
        tick_hz,
        controller: drive.place_poles(35.0).unwrap(),
        ..AxisParams::new(estimator)
    };
    (params, params.validate().unwrap().controller)
}

#[test]
fn the_lathes_gains_are_resolved_far_below_the_drive() {
    // The gains act as they should to 1e-5 of their value, from 1 to 35 kHz; the drive answers to 1e-4 of full command.
    for tick_hz in [1000.0, 2500.0, 35_000.0] {
        let (params, config) = lathe_gains(tick_hz);
        let full = params.motion.full_command_feed_mm_per_min / 60.0 * params.motion.counts_per_mm
            / tick_hz;
        let expected = params.controller.position_gain_per_s / tick_hz / full * 30.0;
        let mut controller = Controller::new(config);
        demanded(&mut controller, &standing(0.0));
        // The integral of a single tick is in it.
        let integral = params.controller.integral_gain_per_s2 / (tick_hz * tick_hz) / full * 30.0;
        let seen = demanded(&mut controller, &standing(30.0));
        assert!(
            (seen / (expected + integral) - 1.0).abs() < 1e-5,
            "{tick_hz} Hz: {seen} instead of {expected}"
        );
    }
}

/// Demand of a second tick with `error`, after a first one without: the law itself.
fn law_at(config: Config, error: f64) -> f64 {
    let mut controller = Controller::new(config);
    demanded(&mut controller, &standing(0.0));
    demanded(&mut controller, &standing(error))
}

#[test]
fn the_deadband_is_subtracted_so_the_law_does_not_step_at_its_border() {
    let gains = Gains {
        position: 0.001,
        ..Gains::default()
    };
    let config = config(&gains, 3.0, 0.0, 1.0);
    for (error, left) in [
        (0.0, 0.0),
        (2.999, 0.0),
        (3.0, 0.0),
        (3.5, 0.5),
        (100.0, 97.0),
    ] {
        for sign in [1.0, -1.0] {
            let seen = law_at(config, sign * error);
            assert!(
                (seen - sign * left * 0.001).abs() < 2.0 * LSB,
                "{error}: {seen}"
            );
        }
    }
    // Across the border the law moves by no more than the gain times the step of the error.
    let step: f64 = Position::DELTA.to_num();
    let mut before = law_at(config, 2.99);
    for tick in 1..2000 {
        let after = law_at(config, 2.99 + f64::from(tick) * step);
        assert!((after - before).abs() <= 0.001 * step + LSB);
        before = after;
    }
}

#[test]
fn the_bias_alone_is_the_output_once_it_has_been_let_in() {
    for bias in [0.05, -0.005] {
        let mut controller = Controller::new(config(&Gains::default(), 0.0, bias, 5.0));
        assert_eq!(demanded(&mut controller, &standing(0.0)), 0.0);
        let last = (0..300)
            .map(|_| demanded(&mut controller, &standing(0.0)))
            .last()
            .unwrap();
        assert!((last - bias).abs() <= LSB, "{last}");
    }
}

#[test]
fn the_following_error_is_reported_before_the_deadband_and_saturates() {
    let mut controller = Controller::new(config(&Gains::default(), 50.0, 0.0, 1.0));
    let mut report = |error: f64| {
        let signals = standing(error);
        let demand = controller.step(
            &signals.setpoint,
            signals.position,
            &signals.estimate,
            NOT_LIMITED,
        );
        demand.following_error.to_num::<f64>()
    };
    assert_eq!(report(12.25), 12.25);
    assert_eq!(report(-1e6), -32_768.0);
    assert!((report(1e6) - 32_768.0).abs() < 1e-4);
}

#[test]
fn gains_of_any_size_share_one_scale_without_losing_the_small_ones_that_matter() {
    // The larger weight takes 31 bits; the smaller one is off by at most half a unit of it.
    let gains = Gains {
        position: 1e-3,
        velocity_feedforward: 100.0,
        ..Gains::default()
    };
    let mut controller = controller(gains, 1.0);
    demanded(&mut controller, &standing(0.0));
    let seen = demanded(&mut controller, &standing(100.0));
    // One unit is total/2³⁰ = 100·2¹⁰/2³⁰ = 1e-4 LSB per LSB of position, of which 100 d have 6.6e6.
    assert!((seen - 0.1).abs() < 0.5 * 1e-4 * 6.6e6 * LSB, "{seen}");
}
