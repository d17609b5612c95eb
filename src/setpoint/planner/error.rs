//! Why an order to a planner was refused.

use core::fmt;

use super::LARGEST_OVERRIDE;
use crate::setpoint::plan::PlanError;
use crate::setpoint::travel::TravelLimits;
use crate::units::Position;

/// Why an order was refused. The plans that were made stay in force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlannerError {
    /// The motion cannot be planned.
    Plan(PlanError),
    /// The target lies beyond the soft limits.
    BeyondTravel {
        /// The target, d.
        target: Position,
        /// The limits.
        travel: TravelLimits,
    },
    /// An override above [`LARGEST_OVERRIDE`].
    Override {
        /// Percent that were asked for.
        percent: u16,
    },
    /// The start is not after that of the plan made last.
    TooEarly {
        /// The start that was asked for.
        start: u32,
        /// The start of the plan made last.
        last: u32,
    },
}

impl fmt::Display for PlannerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plan(error) => error.fmt(f),
            Self::BeyondTravel { target, travel } => write!(
                f,
                "the target {target} d is beyond the soft limits {} to {} d: choose one within",
                travel.low(),
                travel.high()
            ),
            Self::Override { percent } => write!(
                f,
                "an override of {percent} % is out of range: allowed 0 to {LARGEST_OVERRIDE} %"
            ),
            Self::TooEarly { start, last } => write!(
                f,
                "tick {start} is not after tick {last}, where the last plan starts: plan for a later one"
            ),
        }
    }
}

impl core::error::Error for PlannerError {}

impl From<PlanError> for PlannerError {
    fn from(error: PlanError) -> Self {
        Self::Plan(error)
    }
}
