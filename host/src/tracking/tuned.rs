//! How our axis is tuned for a machine.

use leadscrew::estimator::{EstimatorConfig, observer};
use leadscrew::params::{AxisParams, ParamError};
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::{BANDWIDTH_RAD_PER_S, tuned_axis, tuned_estimator};

use super::scene::TICK_HZ;

/// Largest feed of the axis, mm/min.
const MAX_FEED_MM_PER_MIN: f64 = 9000.0;

/// The axis tuned on what `nominal` is.
///
/// # Errors
/// The drive has no figures that a loop could be tuned on.
pub fn tuned(nominal: &MachineParams) -> Result<AxisParams, ParamError> {
    let observer = EstimatorConfig::Observer(observer::Config::of_16k20f3()?);
    let estimator = tuned_estimator(nominal, TICK_HZ, observer, true)?;
    tuned_axis(
        nominal,
        TICK_HZ,
        MAX_FEED_MM_PER_MIN,
        BANDWIDTH_RAD_PER_S,
        estimator,
    )
}
