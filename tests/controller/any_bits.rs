//! The controller takes whatever bits there are: nothing overflows.

use leadscrew::controller::config::{Extras, Gains};
use leadscrew::controller::friction::Friction;
use leadscrew::controller::{Config, Controller};
use leadscrew::estimator::{Delay, Estimate, Lags};
use leadscrew::output::ActiveLimits;
use leadscrew::setpoint::{Setpoint, Turn};
use leadscrew::units::{Acceleration, Command, Jerk, Lag, Position, Velocity};
use proptest::prelude::*;

use crate::seeded::seeded;

/// Gains of any size that validation passes.
pub fn any_config() -> impl Strategy<Value = Config> {
    let gain = || {
        prop_oneof![
            Just(0.0),
            Just(1e6),
            (1e-9_f64.ln()..1e6_f64.ln()).prop_map(f64::exp)
        ]
    };
    let link =
        || (gain(), any::<bool>()).prop_map(|(gain, negative)| if negative { -gain } else { gain });
    let feedforward = (gain(), gain(), gain());
    let rest = (
        prop_oneof![Just(0.0), Just(1.9e-3)],
        0.0..=1000.0_f64,
        -1.0..=1.0_f64,
        1.0..1e6_f64,
    );
    let feedback = (gain(), gain(), link(), link());
    (feedback, feedforward, rest, any_lags()).prop_filter_map(
        "beyond the common scale",
        |(feedback, forward, rest, lags)| {
            let (position, derivative, velocity, acceleration) = feedback;
            let (velocity_feedforward, acceleration_feedforward, jerk_feedforward) = forward;
            let (integral, deadband, bias, transfer_ticks) = rest;
            let gains = Gains {
                position,
                integral,
                derivative,
                velocity,
                acceleration,
                velocity_feedforward,
                acceleration_feedforward,
                jerk_feedforward,
                feedforward_lead: 2.5,
            };
            Config::new(&gains, &lags, deadband, bias, transfer_ticks).ok()
        },
    )
}

/// A law with all that it can have beside gains.
fn whole_config() -> impl Strategy<Value = Config> {
    let share = || 1e-6..0.2_f64;
    let gains = (share(), 0.0..2.0_f64, 0.0..100.0_f64, 0.0..60.0_f64);
    let friction = (0.0..0.1_f64, 0.0..0.2_f64, 1e-3..100.0_f64, 0.0..100.0_f64);
    let rest = (
        0.0..20.0_f64,
        0.0..200.0_f64,
        share().prop_map(|noise| noise / 2.0),
    );
    (gains, friction, rest).prop_filter_map("beyond a scale", |(gains, friction, rest)| {
        let (velocity_feedforward, acceleration_feedforward, jerk_feedforward, lead) = gains;
        let (kinetic, excess, stribeck, dead_ticks) = friction;
        let (rest_band_d, lift_ticks, learning_noise) = rest;
        let gains = Gains {
            position: 1e-3,
            integral: 1e-5,
            velocity: 0.01,
            acceleration: 0.1,
            velocity_feedforward,
            acceleration_feedforward,
            jerk_feedforward,
            feedforward_lead: lead,
            ..Gains::default()
        };
        let extras = Extras {
            friction: Friction {
                kinetic: [kinetic; 2],
                breakaway: [kinetic + excess; 2],
                stribeck,
                least_speed: 0.001,
                rise_ticks: 1.0,
                lead_ticks: lead,
                dead_ticks,
            },
            rest_band_d,
            lift_ticks,
            dead_ticks,
            learning_noise,
            ..Extras::default()
        };
        let delay = Delay::from(&Lags::default());
        Config::with_extras(&gains, delay, 0.0, 0.01, 10.0, &extras).ok()
    })
}

/// Bits from anywhere, the extremes often.
fn extreme_i32() -> impl Strategy<Value = i32> {
    prop_oneof![Just(i32::MIN), Just(i32::MAX), any::<i32>(), -100..100_i32]
}

pub fn extreme_i64() -> impl Strategy<Value = i64> {
    prop_oneof![
        Just(i64::MIN),
        Just(i64::MAX),
        any::<i64>(),
        any::<i32>().prop_map(i64::from)
    ]
}

fn any_setpoint() -> impl Strategy<Value = Setpoint> {
    (extreme_i64(), extreme_i32(), extreme_i32(), extreme_i32()).prop_map(
        |(position, velocity, acceleration, jerk)| Setpoint {
            position: Position::from_bits(position),
            velocity: Velocity::from_bits(velocity),
            acceleration: Acceleration::from_bits(acceleration),
            jerk: Jerk::from_bits(jerk),
            turn: Turn {
                ticks: jerk.unsigned_abs() % 100,
                jerk: Jerk::from_bits(velocity),
            },
        },
    )
}

/// At rest near `position`, or anywhere.
fn resting(setpoint: Setpoint, position: i64, rests: bool) -> Setpoint {
    if !rests {
        return setpoint;
    }
    let beside = i64::from(setpoint.velocity.to_bits()) >> 12;
    Setpoint {
        position: Position::from_bits(position.wrapping_add(beside)),
        ..Setpoint::default()
    }
}

/// Lags of real estimators, and any that the format carries.
fn any_lags() -> impl Strategy<Value = Lags> {
    let lag = || prop_oneof![0..20_i32 << 16, extreme_i32()].prop_map(Lag::from_bits);
    (lag(), lag(), lag()).prop_map(|(position, velocity, acceleration)| Lags {
        position,
        velocity,
        acceleration,
    })
}

fn any_estimate() -> impl Strategy<Value = Estimate> {
    (extreme_i64(), extreme_i32(), extreme_i32(), any_lags()).prop_map(
        |(position, velocity, acceleration, lags)| Estimate {
            position: Position::from_bits(position),
            velocity: Velocity::from_bits(velocity),
            acceleration: Acceleration::from_bits(acceleration),
            lags,
        },
    )
}

fn any_limits() -> impl Strategy<Value = ActiveLimits> {
    any::<(bool, bool, bool)>().prop_map(|(high, low, slew)| ActiveLimits { high, low, slew })
}

proptest! {
    #![proptest_config(seeded(1000))]

    // Overflow checks are on in this profile: an overflow is a panic.
    #[test]
    fn the_controller_takes_any_bits_whatever(
        config in any_config(),
        other in any_config(),
        ticks in prop::collection::vec((any_setpoint(), extreme_i64(), any_estimate(), any_limits()), 1..30),
    ) {
        let mut controller = Controller::new(config);
        let half = ticks.len() / 2;
        for (tick, (setpoint, position, estimate, active)) in ticks.into_iter().enumerate() {
            if tick == half {
                controller.reconfigure(other, Command::ONE);
            }
            controller.step(&setpoint, Position::from_bits(position), &estimate, active);
        }
    }

    #[test]
    fn so_it_does_with_friction_pushes_and_learning(
        config in whole_config(),
        ticks in prop::collection::vec(
            ((any_setpoint(), extreme_i64(), any::<bool>()), any_estimate(), any_limits(), (extreme_i32(), extreme_i32())),
            1..60,
        ),
    ) {
        let mut controller = Controller::new(config);
        for ((setpoint, position, rests), estimate, active, (delta, command)) in ticks {
            let setpoint = resting(setpoint, position, rests);
            controller.note(delta, Some(Command::from_bits(command)), &estimate);
            controller.step(&setpoint, Position::from_bits(position), &estimate, active);
            let _ = controller.withheld();
        }
        for share in controller.learned() {
            prop_assert!((-0.61..=1.51).contains(&share), "{share}");
        }
    }
}
