//! From a model of the drive to the parameters of the loop.
//!
//! **Feedforward** is the inverse of the model, ahead by its delay and half a tick of hold, with its offset, friction and
//! dead time. **Feedback** puts two equal pairs of poles at a radius r with a damping; the radius is the largest, by bisection for each
//! of a few dampings, at which every drive within ± 20 % of gain and of period keeps the margins, at every density of
//! edges from 2 in a tick on; of the dampings that is taken whose corners follow best on trial. The drive's delay is
//! predicted over. **Calm gains**, for rest and creep, are as slow as leaves the drive its own stiffness.
//! What was found is [tried](crate::tuning::check) on the model, and on the corners without friction, before it is offered.

mod corners;
mod prepare;
mod report;
mod search;

use crate::estimator::EstimatorConfig;
use crate::estimator::observer::ObserverParams;
use crate::parameter_table::ParameterTable;
use crate::params::AxisParams;
use crate::tuning::model::DriveModel;

pub use corners::margins;
pub use prepare::{observer_on, prepared};
pub use report::{AutotuneError, Report};
pub use search::placed;
use search::{Chosen, OCTAVES, best};

/// Least gain margin at every corner, dB.
pub const LEAST_GAIN_DB: f64 = 6.0;
/// Least phase margin at every corner, degrees.
pub const LEAST_PHASE_DEG: f64 = 30.0;
/// Share by which gain and period may be off, in any combination.
pub const SPREAD: f64 = 0.2;

/// The estimator that is to be in the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EstimatorChoice {
    /// An observer; what the drive is like comes from the model.
    Observer(ObserverParams),
    /// Any other as it is.
    AsIs(EstimatorConfig),
}

/// `base` with everything of the loop replaced by what suits `model`.
///
/// # Errors
/// [`AutotuneError`]; nothing is changed then.
pub fn autotune(
    model: &DriveModel,
    base: &AxisParams,
    estimator: &EstimatorChoice,
) -> Result<(AxisParams, Report), AutotuneError> {
    model.check()?;
    let params = prepared(model, base, estimator)?;
    // Refuses a feed that leaves no room before anything is searched for.
    params.validate()?;
    let Chosen {
        params,
        bandwidth,
        damping,
        calm,
        trial,
        corner_trial,
    } = best(model, &params)?;
    let (nominal, worst) = margins(model, &params, &OCTAVES)?;
    Ok((
        params,
        Report {
            bandwidth_rad_per_s: bandwidth,
            damping,
            calm_rad_per_s: calm,
            nominal,
            worst,
            trial,
            corner_trial,
        },
    ))
}
