//! Why a fault is not cleared.

use core::fmt;

use super::fault::Fault;

/// Why a fault is not cleared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClearError {
    /// Enable is still asked for.
    EnableRequested,
    /// The reaction is not over: the drive is still enabled.
    Stopping,
    /// The axis still moves.
    Moving,
    /// What brought this fault about is still there.
    CausePersists(Fault),
}

impl fmt::Display for ClearError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::EnableRequested => f.write_str("enable is still asked for: take it back first"),
            Self::Stopping => f.write_str("the stop is not over: wait until the drive is off"),
            Self::Moving => f.write_str("the axis still moves: wait until it stands"),
            Self::CausePersists(fault) => write!(
                f,
                "the cause of {} is still there: {}",
                fault.name(),
                fault.description().remedy
            ),
        }
    }
}

impl core::error::Error for ClearError {}
