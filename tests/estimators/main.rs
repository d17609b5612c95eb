//! The estimators: against a floating-point oracle, by response, and on the scenes of the papers.

mod impulse;
mod oracle;
mod papers;
mod response;

use leadscrew::edges::EdgeConfig;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::uncertainty::EdgeErrors;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::Motion;
use leadscrew_host::accuracy::{Observed, Trial};

/// The timer of the reference machine at 1 kHz.
fn edges() -> EdgeConfig {
    EdgeConfig::new(1000.0, 84e6, &EdgeErrors::default()).unwrap()
}

/// The estimators that use counts alone, with their default parameters.
fn counting_estimators() -> Vec<EstimatorConfig> {
    ["difference", "exponential", "simple", "gaussian"]
        .map(|name| EstimatorConfig::by_name(name).unwrap().unwrap())
        .to_vec()
}

/// What an estimator says of a motion, seed 1, 1 kHz.
fn observe(motion: Motion, encoder: EncoderModel, ticks: u32, config: EstimatorConfig) -> Observed {
    Trial {
        motion,
        encoder,
        tick_hz: 1000.0,
        ticks,
        errors: EdgeErrors::default(),
        seed: 1,
    }
    .observe(config)
    .unwrap()
}
