//! The reading head: where the edges of the disc are for the shaft that passes them now.

use crate::disc::Disc;
use crate::encoder::EncoderParams;
use crate::random::{Noise, bell_scale_q32};
use crate::track::{POSITION_FRAC, Track, to_q32};

/// The count, and the thresholds at which it changes, Q.32 d modulo 2³² d.
///
/// The noise of a threshold is drawn anew after each edge, and stays until then.
#[derive(Clone, Debug)]
pub struct Head {
    disc: Disc,
    noise: Noise,
    noise_scale: i32,
    /// How much lower a backward edge lies: even boundaries, odd boundaries.
    hysteresis: [i64; 2],
    index_width: usize,
    /// Count k lies between the boundaries k and k + 1.
    count: i32,
    /// Edge of the disc at boundary `count`.
    edge: usize,
    upper: Option<i64>,
    lower: Option<i64>,
}

impl Head {
    /// A head that sees `disc` on a shaft at `position`.
    pub fn new(params: &EncoderParams, disc: Disc, noise: Noise, position: i64) -> Self {
        let count = (position >> POSITION_FRAC) as i32;
        let edge = count.rem_euclid(disc.edges() as i32) as usize;
        let mut head = Self {
            disc,
            noise,
            noise_scale: bell_scale_q32(params.noise_d) as i32,
            hysteresis: [params.hysteresis_b_d, params.hysteresis_a_d].map(to_q32),
            index_width: params.index_width_d as usize,
            count,
            edge,
            upper: None,
            lower: None,
        };
        while position.wrapping_sub(head.upper()) >= 0 {
            head.pass_upper();
        }
        while position.wrapping_sub(head.lower()) < 0 {
            head.pass_lower();
        }
        head
    }

    /// The x4 count.
    pub const fn count(&self) -> i32 {
        self.count
    }

    /// True if no threshold lies within reach of the track.
    pub fn is_clear_of(&mut self, track: &Track) -> bool {
        let reach = track.reach().min(i64::MAX as u64).cast_signed();
        self.upper().wrapping_sub(track.start()) > reach
            && track.start().wrapping_sub(self.lower()) >= reach
    }

    /// Edges a revolution.
    pub const fn edges(&self) -> usize {
        self.disc.edges()
    }

    /// Where edge `edge` lies, off its ideal place, but for what does not repeat, Q.32 d.
    pub fn placement_error(&self, edge: usize, backward: bool) -> i64 {
        let lower = if backward {
            self.hysteresis[edge & 1]
        } else {
            0
        };
        self.disc.error_q32(edge) - lower
    }

    /// The place from which on the count is larger.
    pub fn upper(&mut self) -> i64 {
        if let Some(threshold) = self.upper {
            return threshold;
        }
        let threshold = self.threshold(self.count.wrapping_add(1), self.next_edge());
        self.upper = Some(threshold);
        threshold
    }

    /// The place below which the count is smaller.
    pub fn lower(&mut self) -> i64 {
        if let Some(threshold) = self.lower {
            return threshold;
        }
        let forward = self.threshold(self.count, self.edge);
        let threshold = forward.wrapping_sub(self.hysteresis[self.edge & 1]);
        self.lower = Some(threshold);
        threshold
    }

    /// Counts up; true at the front of the index pulse.
    pub fn pass_upper(&mut self) -> bool {
        self.count = self.count.wrapping_add(1);
        self.edge = self.next_edge();
        self.forget_thresholds();
        self.edge == 0
    }

    /// Counts down; true at the front of the index pulse.
    pub fn pass_lower(&mut self) -> bool {
        let passed = self.edge;
        self.count = self.count.wrapping_sub(1);
        self.edge = if passed == 0 {
            self.disc.edges() - 1
        } else {
            passed - 1
        };
        self.forget_thresholds();
        passed == self.index_width
    }

    fn threshold(&mut self, boundary: i32, edge: usize) -> i64 {
        let error = self.disc.error_q32(edge) + i64::from(self.noise());
        (i64::from(boundary) << POSITION_FRAC).wrapping_add(error)
    }

    fn noise(&mut self) -> i32 {
        if self.noise_scale == 0 {
            0
        } else {
            self.noise.bell() * self.noise_scale
        }
    }

    const fn next_edge(&self) -> usize {
        if self.edge + 1 == self.disc.edges() {
            0
        } else {
            self.edge + 1
        }
    }

    const fn forget_thresholds(&mut self) {
        self.upper = None;
        self.lower = None;
    }
}
