//! Why a movement has no corrected path.

use std::fmt;

use crate::terms::TermError;

use super::MAX_PIECES;

/// Why a movement has no corrected path.
#[derive(Clone, Debug, PartialEq)]
pub enum PathError {
    /// A term has no correction somewhere on it.
    Term(TermError),
    /// It would take too many pieces.
    TooManyPieces,
    /// The arc's radius at its end is not that at its start.
    Radii {
        /// At the start, mm.
        start_mm: f64,
        /// At the end, mm.
        end_mm: f64,
        /// What the control allows, mm.
        tolerance_mm: f64,
    },
    /// The radius of the R form is too small to reach the end.
    RadiusTooSmall {
        /// As written, mm.
        radius_mm: f64,
        /// Half of the way from start to end, mm.
        half_chord_mm: f64,
    },
    /// An arc in R form that ends where it starts has no centre.
    NoChord,
    /// An arc without a radius.
    NoRadius,
    /// What the correction makes of an arc is no arc any more, however short its pieces: K is as large as the radius.
    NotAnArc,
}

impl From<TermError> for PathError {
    fn from(error: TermError) -> Self {
        Self::Term(error)
    }
}

impl fmt::Display for PathError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Term(error) => error.fmt(f),
            Self::TooManyPieces => write!(
                f,
                "the movement would be split into more than {MAX_PIECES} pieces: raise tolerance_mm or take a coarser table"
            ),
            Self::Radii {
                start_mm,
                end_mm,
                tolerance_mm,
            } => write!(
                f,
                "the arc has radius {start_mm:.5} mm at its start and {end_mm:.5} mm at its end, the control allows \
                 {tolerance_mm} mm of difference: correct its centre or its end, or state the control's \
                 radius_tolerance_mm in the setup"
            ),
            Self::RadiusTooSmall {
                radius_mm,
                half_chord_mm,
            } => write!(
                f,
                "the arc's radius of {radius_mm:.5} mm is smaller than half of the way to its end, {half_chord_mm:.5} mm: \
                 correct the radius or the end"
            ),
            Self::NoChord => write!(
                f,
                "an arc in R form ends where it starts, so its centre is unknown: write it with I, J, K"
            ),
            Self::NoRadius => write!(
                f,
                "the arc's centre is its start, so it has no radius: correct I, J, K"
            ),
            Self::NotAnArc => write!(
                f,
                "the correction changes the arc by as much as its radius: no arc is left; check the terms' units"
            ),
        }
    }
}

impl std::error::Error for PathError {}
