//! What lines and arcs become under a correction: split only where it must be, with a bounded chord error.
//!
//! Places are machine coordinates. The *true corrected path* of a movement is P(t) + K(P(t)) over the programmed path P(t). What
//! is written instead are straight lines (or arcs) between corrected places. Guaranteed is
//!
//! - for lines: at every fraction t of the way the written path is within the tolerance of the true one, over X, Y, Z (U, V, W)
//!   together, and over A, B, C together. Every term is a polynomial of at most third degree along a line between its breaks
//!   ([`crate::terms::Term`]); four values give its Bernstein form, whose coefficients bound it, so nothing lies between samples.
//! - for arcs: at every angle the true place is within the tolerance of the written path, by bounds on the first and second
//!   derivatives of K ([`crate::terms::Steepness`]) between samples.
//!
//! Rounding of the written words comes on top, half a unit of their last place for each axis.

pub mod arc;
mod cubic;
mod error;
pub mod line;

pub use error::PathError;

use crate::coordinates::Coordinates;

/// Most pieces that one movement is split into; a table fine enough to ask for more is refused.
pub const MAX_PIECES: usize = 20_000;

/// How far the written path may be from the truly corrected one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Over linear axes, mm.
    pub mm: f64,
    /// Over rotary axes, degrees.
    pub degrees: f64,
}

/// Reversal that is not taken up before a movement, in shares of the tolerance.
const JUMP: f64 = 0.5;

impl Tolerance {
    /// A share of it, from 0 to 1.
    #[must_use]
    pub fn part(self, share: f64) -> Self {
        Self {
            mm: share * self.mm,
            degrees: share * self.degrees,
        }
    }

    /// Of the two shares, mm and degrees, the one that uses up more of the tolerance: 1 at the limit.
    #[must_use]
    pub fn share(&self, deviation: &Coordinates) -> f64 {
        let mut squares = [0.0; 2];
        for (axis, value) in deviation.iter() {
            squares[usize::from(axis.is_rotary())] += value * value;
        }
        (squares[0].sqrt() / self.mm).max(squares[1].sqrt() / self.degrees)
    }
}
