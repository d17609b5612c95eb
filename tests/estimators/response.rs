//! Lags and noise gains as the responses have them.

use leadscrew::estimator::EstimatorConfig;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::Motion;

use crate::impulse::NoiseGain;
use crate::{counting_estimators, observe};

#[test]
fn the_velocity_under_constant_jerk_is_that_of_the_stated_delay() {
    const JERK: f64 = 0.05;
    for config in counting_estimators() {
        let delay = config.delay();
        let seen = observe(
            Motion::Jerk { jerk: JERK },
            EncoderModel::ideal(),
            200,
            config,
        );
        let error = seen.mean_now(|estimate, truth| {
            let then = truth.velocity - delay.velocity * truth.acceleration
                + 0.5 * delay.velocity_squared * JERK;
            estimate.velocity.to_num::<f64>() - then
        });
        // The counts' rounding, averaged over 200 ticks; without the spread of the age it would be
        // 0.5·JERK·variance: 0.002 for the difference, 0.6 for the exponential.
        assert!(error.abs() < 0.005, "{}: {error}", config.name());
    }
}

#[test]
fn stated_lags_are_those_of_the_response() {
    const JERK: f64 = 0.02;
    for config in counting_estimators() {
        let ideal = EncoderModel::ideal();
        let lags = config.lags();
        let steady = observe(Motion::Steady { velocity: 50.3 }, ideal, 1000, config);
        let ramp = observe(
            Motion::Ramp {
                velocity: 10.0,
                acceleration: 0.9,
            },
            ideal,
            1000,
            config,
        );
        let jerk = observe(Motion::Jerk { jerk: JERK }, ideal, 300, config);
        let measured = [
            steady.response_lag_x(),
            ramp.response_lag_v(),
            jerk.response_lag_a(JERK),
        ];
        let stated: [f64; 3] = [
            lags.position.to_num(),
            lags.velocity.to_num(),
            lags.acceleration.to_num(),
        ];
        // What is left is the rounding of the counts, averaged over the run.
        let bounds = [0.01, 0.01, 0.2];
        for ((measured, stated), bound) in measured.iter().zip(stated).zip(bounds) {
            assert!(
                (measured - stated).abs() < bound,
                "{}: stated {stated}, measured {measured}",
                config.name()
            );
        }
    }
}

#[test]
fn white_noise_gains_are_those_of_theory() {
    let raw = 6.0_f64.sqrt();
    let theory = [
        ("difference", 1.0),
        ("exponential", 8.79),
        ("simple", 18.4),
        ("gaussian", 13.8),
    ];
    for (name, cut) in theory {
        let config = EstimatorConfig::by_name(name).unwrap().unwrap();
        let found = raw / NoiseGain::of(config).acceleration;
        assert!((found / cut - 1.0).abs() < 0.005, "{name}: {found}");
    }
}
