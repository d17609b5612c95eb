//! The result: what goes into an encoder map.

use super::report::Report;
use crate::encoder_map::Direction;

/// Fractional bits of a learned error.
const ERROR_FRAC: i32 = 12;

/// Fractional bits of a placement.
const PLACEMENT_FRAC: i32 = 16;

/// What depends on direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Directional {
    /// Mean error of the edges k with k mod 4 = 0, 1, 2, 3, d; their mean is zero.
    pub phases_d: [f64; 4],
    /// Count latched at the front of the index pulse, relative to boundary 0: within a few lines.
    pub front: i32,
}

/// A learned encoder.
#[derive(Debug)]
pub struct Learned<'w> {
    /// Error of each edge from boundary 0 on, 1/4096 d.
    pub(super) errors: &'w [i16],
    pub(super) directions: [Option<Directional>; 2],
    pub(super) report: Report,
}

impl Learned<'_> {
    /// Edges per revolution.
    #[must_use]
    pub const fn edges_per_revolution(&self) -> usize {
        self.errors.len()
    }

    /// Error of edge `edge`, d, without its phase; the mean over each phase is zero. 0 beyond the revolution.
    #[must_use]
    pub fn error_d(&self, edge: usize) -> f64 {
        libm::ldexp(f64::from(self.error(edge)), ERROR_FRAC.wrapping_neg())
    }

    /// Error of edge `edge` in 1/4096 d, as [`Self::error_d`].
    #[must_use]
    pub fn error(&self, edge: usize) -> i16 {
        self.errors.get(edge).copied().unwrap_or(0)
    }

    /// Error of edge `edge` with its phase, the mean of the directions that are known, Q.16 d: what an encoder map
    /// is made of.
    #[must_use]
    pub fn placement(&self, edge: usize) -> i32 {
        let of_phase =
            |direction: &Directional| direction.phases_d.get(edge % 4).copied().unwrap_or(0.0);
        let known = || self.directions.iter().flatten();
        let phase = known().map(of_phase).sum::<f64>() / known().count().max(1) as f64;
        to_q16(self.error_d(edge) + phase)
    }

    /// As [`Self::phases_d`], Q.16 d.
    #[must_use]
    pub fn phases(&self, direction: Direction) -> [i32; 4] {
        self.phases_d(direction).map(to_q16)
    }

    /// Mean error of the edges k with k mod 4 = 0, 1, 2, 3 in a direction, d; their mean is zero. A direction
    /// without a run has those of the other.
    #[must_use]
    pub fn phases_d(&self, direction: Direction) -> [f64; 4] {
        let [forward, backward] = self.directions;
        let phases = match direction {
            Direction::Forward => forward.or(backward),
            Direction::Backward => backward.or(forward),
        };
        phases.map_or([0.0; 4], |known| known.phases_d)
    }

    /// Count latched at the front of the index pulse in a direction, relative to boundary 0; none without a run.
    ///
    /// In use boundary 0 is the multiple of 4 nearest to the latched count less this.
    #[must_use]
    pub fn index_front(&self, direction: Direction) -> Option<i16> {
        let known = *direction.of_pair(&self.directions);
        known.map(|known| known.front as i16)
    }

    /// What the map is worth.
    #[must_use]
    pub const fn report(&self) -> &Report {
        &self.report
    }
}

fn to_q16(error_d: f64) -> i32 {
    libm::round(libm::ldexp(error_d, PLACEMENT_FRAC)) as i32
}
