//! What is offered, how good it is, and why nothing is.

use core::fmt;

use super::{LEAST_GAIN_DB, LEAST_PHASE_DEG};
use crate::params::ParamError;
use crate::tuning::check::Trial;
use crate::tuning::margins::Margins;

/// Why nothing can be offered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AutotuneError {
    /// A parameter, a figure of the model, or a feed too near to the full-command speed.
    Param(ParamError),
    /// No bandwidth keeps the margins; those of the slowest loop.
    NoMargin(Margins),
    /// The trial on the model, or on a corner, does not come to rest, oscillates, or is stopped by a fault.
    Trial(Trial),
    /// The trial on the model, or on a corner, follows so far behind that the supervisor would warn.
    Behind {
        /// Largest following error, d.
        peak_d: f64,
        /// From where on the supervisor warns of an axis at rest, d.
        warned_from_d: f64,
        /// What the drive accelerates by, m/s².
        drive_m_s2: f64,
    },
}

impl<E: Into<ParamError>> From<E> for AutotuneError {
    fn from(error: E) -> Self {
        Self::Param(error.into())
    }
}

impl fmt::Display for AutotuneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Param(error) => error.fmt(f),
            Self::NoMargin(margins) => write!(
                f,
                "no loop keeps {LEAST_GAIN_DB} dB and {LEAST_PHASE_DEG}° with this estimator and delay: the slowest one has \
                 {:.1} dB and {:.0}°; shorten the delay or choose an estimator with less lag",
                margins.gain_db, margins.phase_deg
            ),
            Self::Trial(Trial {
                fault: Some(fault), ..
            }) => write!(
                f,
                "on the model, or on a drive 20 % beside it, the supervisor stops the axis for {}; ask for less feed or \
                 acceleration, ease the guides, or identify the drive again",
                fault.name()
            ),
            Self::Trial(trial) => write!(
                f,
                "the loop does not settle on the model: {:.1} d at rest, swinging by {:.1} d; look for coarse steps of command, \
                 dead time or stiction in the drive, or identify it again",
                trial.standing_d, trial.swing_d
            ),
            Self::Behind {
                peak_d,
                warned_from_d,
                drive_m_s2,
            } => write!(
                f,
                "the axis would be {peak_d:.0} d behind on the model, and the supervisor warns from {warned_from_d:.0} d on: ask \
                 for less feed or acceleration (the drive gives {drive_m_s2:.2} m/s² at most), or identify it again"
            ),
        }
    }
}

impl core::error::Error for AutotuneError {}

/// What was found, and how good it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// Radius of the poles, rad/s.
    pub bandwidth_rad_per_s: f64,
    /// Their damping.
    pub damping: f64,
    /// Radius of the poles at rest and creep, rad/s.
    pub calm_rad_per_s: f64,
    /// Margins on the model.
    pub nominal: Margins,
    /// Least margins over all corners and densities.
    pub worst: Margins,
    /// A move on the model with all its imperfections.
    pub trial: Trial,
    /// The worst of moves on the corners.
    pub corner_trial: Trial,
}
