//! How well edges repeat: the noise of a pass.
//!
//! In each segment one triple of neighbouring edges is watched over the revolutions. Its second difference
//! r₊₁ − 2r₀ + r₋₁ keeps the encoder's error the same and takes out the motion; what varies is noise, with six
//! times the variance of one edge.

use super::segments::SEGMENTS;

/// Variance of a second difference over that of one edge.
const SECOND_DIFFERENCE_GAIN: f64 = 6.0;

/// Watches one triple a segment.
#[derive(Clone, Debug)]
pub struct Repeats {
    /// Second difference in the first revolution, Q.16 d.
    first: [i32; SEGMENTS],
    /// Sum of what it was off later.
    sums: [i32; SEGMENTS],
    squares: f64,
    /// Residuals of the last two edges.
    newest: i32,
    older: i32,
}

impl Repeats {
    pub const fn new() -> Self {
        Self {
            first: [0; SEGMENTS],
            sums: [0; SEGMENTS],
            squares: 0.0,
            newest: 0,
            older: 0,
        }
    }

    /// Takes the residual of an edge, Q.16 d.
    #[inline]
    pub const fn push(&mut self, residual: i32) {
        self.older = self.newest;
        self.newest = residual;
    }

    /// Takes the residual of an edge that ends the triple of a segment, before it is pushed.
    pub fn end_triple(&mut self, residual: i32, segment: u32, first_revolution: bool) {
        let second = residual
            .wrapping_sub(self.newest)
            .wrapping_sub(self.newest.wrapping_sub(self.older));
        let segment = segment as usize;
        let (Some(first), Some(sum)) = (self.first.get_mut(segment), self.sums.get_mut(segment))
        else {
            return;
        };
        if first_revolution {
            *first = second;
            return;
        }
        let off = second.wrapping_sub(*first);
        *sum = sum.wrapping_add(off);
        let off = f64::from(off);
        self.squares += off * off;
    }

    /// Standard deviation of one pass of an edge, d, over `revolutions` (≥ 2).
    pub fn sigma_d(&self, revolutions: u32) -> f64 {
        let passes = f64::from(revolutions);
        let of_means: f64 = self
            .sums
            .iter()
            .map(|&sum| f64::from(sum) * f64::from(sum))
            .sum();
        let freedom = SEGMENTS as f64 * (passes - 1.0);
        let variance = (self.squares - of_means / passes).max(0.0) / freedom;
        libm::sqrt(variance / SECOND_DIFFERENCE_GAIN) / 65_536.0
    }
}
