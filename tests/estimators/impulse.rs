//! How much of the noise of a count an estimator lets through.

use leadscrew::estimator::{EstimatorConfig, Variances, simple};
use leadscrew::hal::Capture;

use leadscrew_host::listening::Listening;
use leadscrew_host::statistics::Spread;

use crate::{counting_estimators, edges};

/// Standard deviation of the rounding to a whole count, d: 1/√12.
pub const QUANTISATION_SIGMA_D: f64 = 0.288_675_134_594_812_9;

/// Gains from white noise of position (σ in d) to noise of the estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseGain {
    /// σ of velocity in d/tick per d.
    pub velocity: f64,
    /// σ of acceleration in d/tick² per d.
    pub acceleration: f64,
}

/// Counts of the test impulse: the acceleration of a plain difference stays within its format.
const IMPULSE: u32 = 60;

impl NoiseGain {
    /// The gains of a linear estimator, from its response to one sample out of place: the root of the
    /// sum of squares of the impulse response.
    #[must_use]
    pub fn of(config: EstimatorConfig) -> Self {
        let mut listening = Listening::new(&[config], edges());
        let (mut velocity, mut acceleration) = (Spread::default(), Spread::default());
        let rest = 2 * config.warm_up_ticks() + 8;
        for tick in 0..rest {
            let count = if tick == 1 { IMPULSE } else { 0 };
            let capture = Capture {
                count,
                sampled_at: tick,
                ..Capture::default()
            };
            listening.hear(&capture, None, |_, estimate| {
                velocity.push(estimate.velocity.to_num());
                acceleration.push(estimate.acceleration.to_num());
            });
        }
        let gain = |response: Spread| {
            response.rms() * (response.count() as f64).sqrt() / f64::from(IMPULSE)
        };
        Self {
            velocity: gain(velocity),
            acceleration: gain(acceleration),
        }
    }
}

#[test]
fn differences_add_the_noise_of_their_samples() {
    let difference = EstimatorConfig::by_name("difference").unwrap().unwrap();
    let gain = NoiseGain::of(difference);
    // x − x₁ and x − 2 x₁ + x₂.
    assert!((gain.velocity - 2.0_f64.sqrt()).abs() < 1e-6, "{gain:?}");
    assert!(
        (gain.acceleration - 6.0_f64.sqrt()).abs() < 1e-6,
        "{gain:?}"
    );
}

#[test]
fn the_stated_uncertainty_is_that_of_rounding_by_these_gains() {
    let averages =
        [1, 2, 15].map(|window| EstimatorConfig::Simple(simple::Config::new(window).unwrap()));
    for config in counting_estimators().into_iter().chain(averages) {
        let gain = NoiseGain::of(config);
        let mut listening = Listening::new(&[config], edges());
        listening.hear(&Capture::default(), None, |_, _| {});
        let Variances {
            velocity,
            acceleration,
        } = listening.variances(0).unwrap();
        for (variance, gain) in [(velocity, gain.velocity), (acceleration, gain.acceleration)] {
            let sigma = variance.to_num::<f64>().sqrt();
            let expected = gain * QUANTISATION_SIGMA_D;
            assert!(
                (sigma / expected - 1.0).abs() < 1e-3,
                "{}: {sigma} {expected}",
                config.name()
            );
        }
    }
}
