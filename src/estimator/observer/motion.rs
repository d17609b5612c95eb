//! The state of motion in fixed point, carried from tick to tick and corrected.
//!
//! Formats are such that the high word of a state is the output's format, so that products are of 32 × 32 bits, and
//! that a product of a high word and a time is the position's format: a multiplication that accumulates does the rest.

use super::classes::{GainScale, Response};

/// Fractional bits of the position. Its range is 16 times the greatest way in a tick, so that a tick, or the way from an
/// edge of [`crate::edges::MAX_SPAN_TICKS`], does not leave it and it is watched at a tick's end alone.
pub const PLACE_FRAC: u32 = 48;
/// Fractional bits of the velocity.
pub const COARSE_FRAC: u32 = 52;
/// Fractional bits of acceleration and jerk.
pub const FINE_FRAC: u32 = 56;
/// Fractional bits of an innovation, which is within ±8 d.
pub const INNOVATION_FRAC: u32 = 28;

/// Bound of the position's high word, ±2 047 d from the count.
const FARTHEST: i32 = 0x7ff << (PLACE_FRAC - 32);
/// Bound of the others' high words, ±2 047 d/tick, ±127.9 d/tick² and d/tick³.
const HIGHEST: i32 = 0x7ff << (COARSE_FRAC - 32);

/// 1/6 in Q.24: times a high word of Q.24 it is the position's format.
const SIXTH: i32 = 0x002a_aaab;

/// Position relative to the newest count, Q15.48, velocity, Q11.52, acceleration and the jerk that the disturbance
/// causes, Q7.56, in d and ticks.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Motion {
    pub position: i64,
    pub velocity: i64,
    pub acceleration: i64,
    /// δ = k₁·d of a disturbance d in d/tick: a jerk, so that its format does not depend on the drive.
    pub disturbance: i64,
}

impl Motion {
    /// At the middle of the count, moving at `velocity`, Q11.20.
    pub const fn steady(velocity: i32) -> Self {
        Self {
            position: 1 << (PLACE_FRAC - 1),
            velocity: (velocity as i64).wrapping_shl(32),
            acceleration: 0,
            disturbance: 0,
        }
    }

    /// A tick under constant `jerk` (Q.56), in which the count moved by `counts`.
    #[inline]
    pub const fn advance(&mut self, jerk: i64, counts: i32) {
        // v + a/2 is the way but for j/6, and half the acceleration before and half of that after are the gain.
        let way = self
            .velocity
            .wrapping_add(self.acceleration.wrapping_shr(5));
        self.acceleration = self.acceleration.wrapping_add(jerk);
        self.velocity = way.wrapping_add(self.acceleration.wrapping_shr(5));
        let moved = (counts as i64).wrapping_shl(PLACE_FRAC);
        self.position = self
            .position
            .wrapping_sub(moved)
            .wrapping_add(way.wrapping_shr(COARSE_FRAC - PLACE_FRAC))
            .wrapping_add(product(high(jerk), SIXTH));
    }

    /// Goes on for `ticks`, Q.28, more than the tick just made.
    pub const fn carry(&mut self, ticks: i32) {
        // Q20 · Q28 for 48, and Q24 · Q28 for 52.
        self.position = self
            .position
            .wrapping_add(product(high(self.velocity), ticks));
        self.velocity = self
            .velocity
            .wrapping_add(product(high(self.acceleration), ticks));
    }

    /// By how much the shaft missed `place` (Q15.16 d) at an edge `age` (Q.28) ago, where the ages of its edges have half
    /// the variance `half_spread` (Q.24), d with [`PLACE_FRAC`] bits.
    #[inline]
    pub const fn missed_by(&self, place: i32, age: u32, half_spread: i32) -> i64 {
        let square = (age as u64).wrapping_mul(age as u64).wrapping_shr(32) as i32;
        let half = half_spread.wrapping_add(square.wrapping_shr(1));
        // A place is the high word of a position.
        (place as i64)
            .wrapping_shl(32)
            .wrapping_sub(self.position)
            .wrapping_add(product(high(self.velocity), age.cast_signed()))
            .wrapping_add(product(high(self.acceleration), half.wrapping_neg()))
    }

    /// Adds what `gains` make of an innovation.
    #[inline]
    pub const fn correct(&mut self, innovation: i32, gains: &[i32; 4], scale: &GainScale) {
        let [by_x, by_v, by_a, by_d] = *gains;
        let [x, v, a, d] = scale.0;
        self.position = self.position.wrapping_add(scaled(innovation, by_x, x));
        self.velocity = self.velocity.wrapping_add(scaled(innovation, by_v, v));
        self.acceleration = self.acceleration.wrapping_add(scaled(innovation, by_a, a));
        self.disturbance = self.disturbance.wrapping_add(scaled(innovation, by_d, d));
    }

    /// Whether a part is beyond what any axis does.
    #[inline]
    pub const fn is_wild(&self) -> bool {
        let x = room(self.position, FARTHEST);
        let v = room(self.velocity, HIGHEST);
        let a = room(self.acceleration, HIGHEST);
        let d = room(self.disturbance, HIGHEST);
        // One branch for all: their union has a sign if one of them has.
        (x | v | a | d) < 0
    }

    /// Velocity, Q11.20, rounded.
    pub const fn velocity_q20(&self) -> i32 {
        high(self.velocity.wrapping_add(1 << 31))
    }

    /// Acceleration, Q7.24, rounded.
    pub const fn acceleration_q24(&self) -> i32 {
        high(self.acceleration.wrapping_add(1 << 31))
    }

    /// Position relative to the count, rounded.
    pub const fn position_q16(&self) -> i32 {
        high(self.position.wrapping_add(1 << 31))
    }
}

impl Response {
    /// Jerk of the drive for a velocity `wanted` (Q11.20) of it, without disturbance, Q.56.
    #[inline]
    pub const fn jerk(&self, wanted: i32, velocity: i64, acceleration: i64) -> i64 {
        let gap = wanted.saturating_sub(high(velocity));
        let pull = product(gap, self.stiffness);
        let drag = product(high(acceleration), self.damping);
        multiplied(pull.wrapping_sub(drag), self.multiplier)
    }

    /// Velocity that the drive aims at under a command in Q.30, Q11.20.
    #[inline]
    pub const fn wanted(&self, command: i32) -> i32 {
        let wanted = product(command, self.full_velocity).wrapping_shr(30) as i32;
        wanted.saturating_add(self.offset)
    }
}

/// What is left from a state's size to the `bound` of its high word; below zero beyond it.
#[inline]
const fn room(state: i64, bound: i32) -> i32 {
    let high = high(state);
    // |high|, or one less where it is negative, in one instruction.
    let size = high ^ high.wrapping_shr(31);
    bound.wrapping_sub(size)
}

/// The high word of a state.
pub const fn high(state: i64) -> i32 {
    state.wrapping_shr(32) as i32
}

const fn product(one: i32, other: i32) -> i64 {
    (one as i64).wrapping_mul(other as i64)
}

/// The high word of `one`·`other`, times `multiplier`.
#[inline]
const fn scaled(one: i32, other: i32, multiplier: i32) -> i64 {
    // Rounded: a bias would be held against the small gains between rare edges.
    let rounded = product(one, other).wrapping_add(1 << 31);
    product(high(rounded), multiplier)
}

/// `value`·`multiplier`, by words.
#[inline]
const fn multiplied(value: i64, multiplier: u32) -> i64 {
    let low = (value as u32 as u64).wrapping_mul(multiplier as u64);
    let high = high(value).wrapping_mul(multiplier.cast_signed());
    low.cast_signed()
        .wrapping_add((high as i64).wrapping_shl(32))
}
