//! Commissioning a simulated machine from cold, as its user would: learn the encoder, identify the drive, autotune.

use leadscrew::encoder_map::EncoderMap;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer::{Config, ObserverParams};
use leadscrew::params::{AxisParams, MAX_FEED_SHARE, MotionParams};
use leadscrew::tuning::DriveModel;
use leadscrew::tuning::autotune::{AutotuneError, EstimatorChoice, Report, autotune};
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::observer_params;

use crate::calibration::{Procedure, learn_simulated};
use crate::identify::Bench;

/// Feeds that are chosen for a user are whole multiples of this, mm/min.
const ROUND_FEED: f64 = 100.0;

/// True of an encoder with a disc whose errors can be learned; a scale has none.
#[must_use]
pub fn has_disc(machine: &MachineParams) -> bool {
    machine.mount.linear_scale < 0.5 && machine.encoder.disc.line_sigma_d > 0.0
}

/// The image of a map of the machine's encoder, where it has a disc with errors.
#[must_use]
pub fn learned(machine: &MachineParams, seed: u64) -> Option<Vec<u8>> {
    let learn = || learn_simulated(&machine.encoder, seed, &Procedure::default()).ok();
    has_disc(machine).then(learn).flatten()
}

/// The map of an image that was learned here.
#[must_use]
pub fn map_of(image: Option<&[u8]>) -> Option<EncoderMap<'_>> {
    image.and_then(|image| EncoderMap::from_bytes(image).ok())
}

/// What the observer counts on: edges without errors where there is a map or nothing to learn, else those of the encoder.
#[must_use]
pub fn counts_on(machine: &MachineParams, has_map: bool) -> ObserverParams {
    if has_map || machine.encoder.disc.line_sigma_d == 0.0 {
        ObserverParams::default()
    } else {
        observer_params(machine, false)
    }
}

/// The largest round feed up to `wanted` mm/min that leaves the loop room on the drive.
#[must_use]
pub fn feed_within(model: &DriveModel, wanted: f64) -> f64 {
    let most = MAX_FEED_SHARE * model.full_command_feed_mm_per_min;
    if wanted <= most {
        wanted
    } else if most < ROUND_FEED {
        most
    } else {
        (most / ROUND_FEED).floor() * ROUND_FEED
    }
}

/// The axis that autotune offers on `model`, identified on `bench`, with `max_feed` mm/min.
///
/// # Errors
/// A parameter out of range, or nothing that could be offered.
pub fn offer(
    bench: &Bench,
    model: &DriveModel,
    max_feed: f64,
    counts_on: &ObserverParams,
) -> Result<(AxisParams, Report), AutotuneError> {
    let base = bench.axis_params()?;
    let base = AxisParams {
        motion: MotionParams {
            max_feed_mm_per_min: max_feed,
            ..base.motion
        },
        estimator: EstimatorConfig::Observer(Config::of_16k20f3()?),
        ..base
    };
    autotune(model, &base, &EstimatorChoice::Observer(*counts_on))
}
