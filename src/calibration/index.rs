//! The index over a run: where a revolution begins, and whether it keeps to that.
//!
//! The index pulse is a few d wide and latches at its front, which lies elsewhere in the other direction. The
//! front may come a count earlier or later from one revolution to the next, so the zero of a run is a boundary
//! with a count that is a multiple of 4, which the state of A and B identifies.

use super::refusal::Refusal;
use super::segments::within_revolution;

/// Counts by which a front may wander.
const FRONT_PLAY: i64 = 1;

/// The fronts of a run.
#[derive(Clone, Copy, Debug)]
pub struct Fronts {
    edges: u32,
    /// Count of the first front, and of the boundary 0 that it made.
    first: i64,
    zero: i64,
    /// Σ (front − first), modulo a revolution.
    play: i64,
    seen: i64,
    /// An index came in the present revolution.
    fresh: bool,
}

impl Fronts {
    /// Takes the first front. Boundary 0 is the first multiple of 4 that the shaft then passes, or passes with
    /// the front.
    pub fn new(edges: u32, front: i64, backward: bool) -> Self {
        let below = front & !3;
        let zero = if backward || below == front {
            below
        } else {
            below.wrapping_add(4)
        };
        Self {
            edges,
            first: front,
            zero,
            play: 0,
            seen: 1,
            fresh: true,
        }
    }

    /// Count of a boundary 0.
    pub const fn zero(&self) -> i64 {
        self.zero
    }

    /// Takes a later front.
    pub fn take(&mut self, front: i64, revolution: u32) -> Result<(), Refusal> {
        let half = self.edges / 2;
        let turned = front.wrapping_sub(self.first).wrapping_add(i64::from(half));
        let off_by = i64::from(within_revolution(turned, self.edges)).wrapping_sub(i64::from(half));
        if off_by.abs() > FRONT_PLAY {
            let off_by = off_by as i32;
            return Err(Refusal::IndexInconsistent { revolution, off_by });
        }
        self.play = self.play.wrapping_add(off_by);
        self.seen = self.seen.wrapping_add(1);
        self.fresh = true;
        Ok(())
    }

    /// Half a revolution away from the index: it must have come since the last time.
    pub const fn check_fresh(&mut self, revolution: u32) -> Result<(), Refusal> {
        if !self.fresh {
            return Err(Refusal::IndexMissing { revolution });
        }
        self.fresh = false;
        Ok(())
    }

    /// Count at the front relative to boundary 0, the mean of the run.
    pub fn front(&self) -> i32 {
        let play = libm::round(self.play as f64 / self.seen as f64) as i64;
        self.first.wrapping_sub(self.zero).wrapping_add(play) as i32
    }
}
