//! What is kept of the first fault.

use super::State;
use super::fault::Fault;
use super::fault_set::FaultSet;
use crate::controller::FollowingError;
use crate::units::{Command, Position, Velocity};

/// A value that a monitor watches, in the unit that the table of faults states for it.
pub type Figure = fixed::types::I48F16;

/// What a monitor found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trip {
    /// The fault.
    pub fault: Fault,
    /// What was seen.
    pub value: Figure,
    /// What is allowed.
    pub limit: Figure,
}

impl Trip {
    /// A line that is active and should not be.
    pub(super) const fn line(fault: Fault) -> Self {
        Self::counted(fault, 1, 0)
    }

    /// Whole numbers.
    pub(super) const fn counted(fault: Fault, value: i64, limit: i64) -> Self {
        Self {
            fault,
            value: Figure::from_bits(value.wrapping_shl(Figure::FRAC_NBITS)),
            limit: Figure::from_bits(limit.wrapping_shl(Figure::FRAC_NBITS)),
        }
    }

    /// Bits with `frac` fractional bits, at least 16 of them.
    pub(super) const fn of_bits(fault: Fault, value: i32, limit: i32, frac: u32) -> Self {
        let shift = frac.wrapping_sub(Figure::FRAC_NBITS);
        Self {
            fault,
            value: Figure::from_bits((value as i64).wrapping_shr(shift)),
            limit: Figure::from_bits((limit as i64).wrapping_shr(shift)),
        }
    }
}

/// The axis when its first fault was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FirstFault {
    /// What was found.
    pub trip: Trip,
    /// Tick in which it was found.
    pub tick: u32,
    /// State before it.
    pub state: State,
    /// Where the axis was.
    pub context: Context,
    /// Other faults found since then, which did not take its place.
    pub later: FaultSet,
}

/// Where the axis was when its first fault was found. A fault that shows before the setpoint of its tick is
/// evaluated (lines, read-back, illegal transitions, missed ticks) has setpoint, following error and command
/// of the tick before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Context {
    /// Measured position, d.
    pub position: Position,
    /// Estimated velocity, d/tick.
    pub velocity: Velocity,
    /// Setpoint, d.
    pub setpoint_position: Position,
    /// Its velocity, d/tick.
    pub setpoint_velocity: Velocity,
    /// Following error, d.
    pub following_error: FollowingError,
    /// What was put out last.
    pub command: Command,
}
