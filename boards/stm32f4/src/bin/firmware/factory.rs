//! The axis as it comes from the factory: a 16K20F3 of the nominal figures, to be commissioned.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::params::AxisParams;
use leadscrew::settings::Settings;
use leadscrew::tuning::DriveModel;
use leadscrew::units::RangeError;

/// Nominal drive: natural period, s, and damping.
const DRIVE: (f64, f64) = (0.09, 0.5);
/// Bandwidth of the loop at 1 kHz, rad/s.
const BANDWIDTH: f64 = 35.0;
/// The estimator.
const ESTIMATOR: &str = "exponential";

/// What the axis is without anything stored.
///
/// # Errors
/// The figures above are out of range.
pub fn settings() -> Result<Settings, RangeError> {
    let estimator = EstimatorConfig::by_name(ESTIMATOR)?;
    let estimator = estimator.ok_or(RangeError {
        name: "estimator",
        value: f64::NAN,
        min: 0.0,
        max: 0.0,
    })?;
    let controller = DriveModel::second_order(DRIVE.0, DRIVE.1).place_poles(BANDWIDTH)?;
    Ok(Settings {
        axis: AxisParams {
            controller,
            ..AxisParams::new(estimator)
        },
        ..Settings::new(estimator)
    })
}
