//! Why a thread was not cut.

use leadscrew::params::ParamError;
use leadscrew::setpoint::thread::{SpindleTrouble, ThreadRefusal};
use leadscrew::units::RangeError;
use thiserror::Error;

use super::lathe::PATIENCE;

/// Why a thread was not cut.
#[derive(Clone, Copy, Debug, Error)]
pub enum ThreadError {
    /// A parameter is out of range.
    #[error("{0}")]
    Param(ParamError),
    /// The axis refused the pass.
    #[error("{0}")]
    Refused(ThreadRefusal),
    /// The spindle could not be followed.
    #[error("the pass was ended: {0:?}")]
    Ended(SpindleTrouble),
    /// The pass did not come to its end.
    #[error("the pass did not end within {PATIENCE} ticks")]
    Endless,
}

impl From<ParamError> for ThreadError {
    fn from(error: ParamError) -> Self {
        Self::Param(error)
    }
}

impl From<RangeError> for ThreadError {
    fn from(error: RangeError) -> Self {
        Self::Param(error.into())
    }
}

impl From<ThreadRefusal> for ThreadError {
    fn from(error: ThreadRefusal) -> Self {
        Self::Refused(error)
    }
}
