//! Leaving an axis safe, whatever a procedure ended with.

use leadscrew_client::{Axis, Error};

use super::ProcedureError;

/// Switches the drive off after `outcome`, ends an experiment, and passes the outcome on; a failure to do so counts only
/// where all else went well.
pub fn switched_off<T>(
    axis: &mut Axis,
    outcome: Result<T, ProcedureError>,
) -> Result<T, ProcedureError> {
    let off = axis.disable().and_then(|_| axis.end_experiment());
    let result = outcome?;
    off?;
    Ok(result)
}

/// Makes an axis that stands ready: what was left of an experiment is ended, a fault that can be cleared is.
pub fn made_ready(axis: &mut Axis) -> Result<(), Error> {
    let status = axis.status()?;
    if status.is_enabled {
        axis.disable()?;
    }
    axis.end_experiment()?;
    if status.fault_number != 0 {
        axis.clear_fault()?;
    }
    axis.enable().map(drop)
}
