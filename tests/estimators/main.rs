//! The estimators: against a floating-point oracle, by response, and on the scenes of the papers.

mod oracle;
mod papers;
mod response;

use leadscrew::estimator::EstimatorConfig;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::Motion;
use leadscrew_host::accuracy::{Observed, Trial};

/// What an estimator says of a motion, seed 1, 1 kHz.
fn observe(motion: Motion, encoder: EncoderModel, ticks: u32, config: EstimatorConfig) -> Observed {
    Trial {
        motion,
        encoder,
        tick_hz: 1000.0,
        ticks,
        seed: 1,
    }
    .observe(config)
    .unwrap()
}
