//! What holds where edges are few: silence, and an edge passed to and fro.

use crate::edges::Span;
use crate::estimator::Variances;
use crate::narrowing::within_or_high;
use crate::units::{Position, Variance, Velocity};

/// How long no edge has come.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silence {
    /// Q24.8 ticks; stops at the maximum.
    ticks_q8: u32,
    /// Count when the last sample came; wraps.
    count: i32,
    /// The last sample came going backward.
    is_backward: bool,
}

/// A way of more than this within a silence (of reversals and faults) need not be told apart: 15 halves in Q.27 fit
/// 31 bits.
const MOST_MOVED: u32 = 6;

impl Silence {
    /// Not yet a silence, at a count.
    pub const fn none(count: i32) -> Self {
        Self {
            ticks_q8: 0,
            count,
            is_backward: false,
        }
    }

    /// Since an edge of that age, passed on the way to `count`.
    #[inline]
    pub fn since(age: Span, count: i32, is_backward: bool) -> Self {
        Self {
            ticks_q8: to_q8(age),
            count,
            is_backward,
        }
    }

    #[inline]
    pub fn lengthen(&mut self, by: Span) {
        self.ticks_q8 = self.ticks_q8.saturating_add(to_q8(by));
    }

    /// Ticks, Q24.8.
    pub const fn ticks_q8(&self) -> u32 {
        self.ticks_q8
    }

    /// A velocity no larger than the silence up to `count` allows, and not turned round: that would be seen on an edge;
    /// and the same where it may have turned.
    #[inline]
    pub fn hold(&self, velocity: i32, count: i32) -> (i32, i32) {
        let Some(most) = self.most(count) else {
            return (velocity, velocity);
        };
        let least = most.wrapping_neg();
        let (lowest, highest) = if self.is_backward {
            (least, 0)
        } else {
            (0, most)
        };
        (
            within_or_high(velocity, lowest, highest),
            within_or_high(velocity, least, most),
        )
    }

    /// The largest velocity after a silence of more than a tick, Q12.20 d/tick: one discrete, and half a one for displaced
    /// edges, in its time.
    #[inline]
    pub fn most(&self, count: i32) -> Option<i32> {
        const TICK_Q8: u32 = 1 << 8;
        if self.ticks_q8 <= TICK_Q8 {
            return None;
        }
        let moved = count.wrapping_sub(self.count).unsigned_abs();
        let halves = moved.min(MOST_MOVED).wrapping_mul(2).wrapping_add(3);
        // Halves of a d in Q.28 over Q.8 ticks: Q.20.
        let most = halves
            .wrapping_shl(Velocity::FRAC_NBITS + 8 - 1)
            .checked_div(self.ticks_q8)
            .unwrap_or(0);
        Some(most.cast_signed())
    }

    /// What is not known of a velocity at rest is what the silence up to `count` allows.
    pub fn variances(&self, count: i32) -> Variances {
        let most = self.most(count).unwrap_or(i32::MAX).cast_unsigned();
        let square = u64::from(most.min(1 << 24)).wrapping_mul(u64::from(most.min(1 << 24)));
        // Uniform within ±most: a third of the square.
        let variance = Variance::from_bits(
            square
                .wrapping_shl(Variance::FRAC_NBITS - 2 * Velocity::FRAC_NBITS)
                .checked_div(3)
                .unwrap_or(0),
        );
        Variances {
            velocity: variance,
            acceleration: variance,
        }
    }
}

#[inline]
const fn to_q8(span: Span) -> u32 {
    span.to_bits().wrapping_shr(Span::FRAC_NBITS - 8)
}

/// How many of the newest samples are one and the same boundary.
#[derive(Clone, Copy, Debug, Default)]
pub struct Dither {
    /// Place of the newest sample, 2⁻¹⁶ d modulo 2¹⁶ d.
    place: i32,
    samples: usize,
}

impl Dither {
    pub const NONE: Self = Self {
        place: 0,
        samples: 0,
    };

    /// Counts how often in a row the same boundary was passed: half a discrete is more than hysteresis, less than
    /// the distance to the next one. A place 2¹⁵ d away would be taken for the same, but is not one edge away.
    #[inline]
    pub fn note(&mut self, place: i64, edges: u32) {
        let place = place as i32;
        let apart = place.wrapping_sub(self.place).unsigned_abs();
        let same = edges == 1 && apart < 1 << (Position::FRAC_NBITS - 1);
        let before = if same { self.samples } else { 0 };
        *self = Self {
            place,
            samples: before.wrapping_add(1),
        };
    }

    pub const fn samples(&self) -> usize {
        self.samples
    }
}
