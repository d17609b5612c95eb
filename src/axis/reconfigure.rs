//! What of a configuration cannot change while the axis moves.

use core::fmt;

use crate::params::AxisConfig;

/// A change that was refused because the axis moves: stop it first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReconfigureError {
    /// Counts in a mm or ticks in a second: the move that runs was planned in others.
    Scale,
    /// The edge timer: times in one clock would be taken for times in another.
    EdgeTimer,
    /// Which estimators there are and which paths they serve: the fed back position would jump.
    Estimators,
    /// Ratios, the second encoder or the limits of what follows them: the setpoint would jump.
    Sources,
}

impl ReconfigureError {
    /// Compares what is in force with what is to come.
    ///
    /// # Errors
    /// The first difference that cannot be made in motion.
    pub(super) fn check(now: &AxisConfig, next: &AxisConfig) -> Result<(), Self> {
        if now.scale != next.scale {
            Err(Self::Scale)
        } else if now.edges.scale != next.edges.scale {
            Err(Self::EdgeTimer)
        } else if now.estimators.differs_in_kind(&next.estimators) {
            Err(Self::Estimators)
        } else {
            Ok(())
        }
    }
}

impl fmt::Display for ReconfigureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self {
            Self::Scale => "counts_per_mm and tick_hz",
            Self::EdgeTimer => "timer_hz",
            Self::Estimators => "the estimators and their paths",
            Self::Sources => "sources of setpoints and the limits of motion",
        };
        write!(
            f,
            "{what} cannot change while the axis moves: stop it first"
        )
    }
}

impl core::error::Error for ReconfigureError {}
