//! Parameters for a simulated machine: from its drive as it is known, and from cold, by what identification finds.

use leadscrew::encoder_map::EncoderMap;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer::{Config, ObserverParams};
use leadscrew::identification::{Identified, IdentifyParams};
use leadscrew::params::AxisParams;
use leadscrew::tuning::autotune::{AutotuneError, EstimatorChoice, Report, autotune};
use leadscrew_hal_mock::machine::MachineParams;
pub use leadscrew_hal_mock::scenario::model_of;

use super::error::TrackingError;
use super::scene::TICK_HZ;
use crate::commissioning::{counts_on, feed_within, offer};
use crate::identify::Bench;

/// Our axis tuned on `machine` by [`autotune`], with an observer that counts on a learned map.
///
/// # Errors
/// Nothing that autotune could offer.
pub fn tuned_on(machine: &MachineParams) -> Result<(AxisParams, Report), AutotuneError> {
    let observer = EstimatorConfig::Observer(Config::of_16k20f3()?);
    let base = AxisParams {
        timer_hz: machine.encoder.encoder.timer_hz,
        ..AxisParams::new(observer)
    };
    let choice = EstimatorChoice::Observer(ObserverParams::default());
    autotune(&model_of(machine), &base, &choice)
}

/// Largest feed that is asked for, mm/min; a slower drive gives less.
const MAX_FEED_MM_PER_MIN: f64 = 9000.0;
/// Feed at full command as the drive's plate has it, mm/min: all that is known before a machine is identified.
const PLATE_FEED_MM_PER_MIN: f64 = 9600.0;

/// An axis that was commissioned from cold.
#[derive(Clone, Copy, Debug)]
pub struct Cold {
    /// What was found of the drive.
    pub identified: Identified,
    /// What autotune made of it.
    pub params: AxisParams,
}

/// Our axis from cold on `machine`, whose encoder `seed` draws and `map` corrects: identified by the product's own experiments through the
/// core, then tuned on what was found.
///
/// # Errors
/// A machine that is not identified, or nothing that autotune could offer.
pub fn tuned_from_cold(
    machine: &MachineParams,
    map: Option<EncoderMap<'_>>,
    seed: u64,
) -> Result<Cold, TrackingError> {
    let bench = Bench {
        machine: *machine,
        params: IdentifyParams::default(),
        tick_hz: TICK_HZ,
        nominal_feed_mm_per_min: PLATE_FEED_MM_PER_MIN,
        reversed: false,
        seed,
    };
    let identified = bench.run(map)?.identified;
    let model = identified.model();
    let max_feed = feed_within(&model, MAX_FEED_MM_PER_MIN);
    let (params, _) = offer(&bench, &model, max_feed, &counts_on(machine, map.is_some()))?;
    Ok(Cold { identified, params })
}
