//! The state of motion in fixed point, carried from tick to tick and corrected.
//!
//! Formats are such that the high word of a state is the output's format, so that products are of 32 × 32 bits.

use super::classes::{GainScale, Response};
use crate::estimator::saturate;
use crate::units::Position;

/// Fractional bits of position and velocity.
pub const COARSE_FRAC: u32 = 52;
/// Fractional bits of acceleration and jerk.
pub const FINE_FRAC: u32 = 56;
/// Fractional bits of an innovation, which is within ±8 d.
pub const INNOVATION_FRAC: u32 = 28;

/// Bounds of the high words: ±2 047 d from the count, ±2 047 d/tick, ±127 d/tick² and d/tick³.
const HIGHEST_COARSE: u32 = 2047 << (COARSE_FRAC - 32);
const HIGHEST_FINE: u32 = 127 << (FINE_FRAC - 32);
/// Edges are taken for no older than just short of two ticks.
const OLDEST: u32 = (2 << 28) - 1;
/// 1/6 in Q.32.
const SIXTH: i32 = 0x2aaa_aaab;

/// Position relative to the newest count and velocity, Q11.52, acceleration and the jerk that the disturbance
/// causes, Q7.56, in d and ticks.
#[derive(Clone, Copy, Debug, Default)]
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
            position: 1 << (COARSE_FRAC - 1),
            velocity: (velocity as i64).wrapping_shl(32),
            acceleration: 0,
            disturbance: 0,
        }
    }

    /// A tick under constant `jerk` (Q.56), in which the count moved by `counts`.
    #[inline]
    pub const fn advance(&mut self, jerk: i64, counts: i32) {
        let sixth = product(high(jerk), SIXTH).wrapping_shr(4);
        let moved = (counts as i64).wrapping_shl(COARSE_FRAC);
        self.position = self
            .position
            .wrapping_sub(moved)
            .wrapping_add(self.velocity)
            .wrapping_add(self.acceleration.wrapping_shr(5))
            .wrapping_add(sixth);
        self.velocity = self
            .velocity
            .wrapping_add(self.acceleration.wrapping_shr(4))
            .wrapping_add(jerk.wrapping_shr(5));
        self.acceleration = self.acceleration.wrapping_add(jerk);
    }

    /// Goes on for `ticks`, Q.28, more than the tick just made.
    #[cold]
    pub const fn carry(&mut self, ticks: i32) {
        // Q20 · Q28 and Q24 · Q28 for 52.
        let way = product(high(self.velocity), ticks).wrapping_shl(4);
        let gain = product(high(self.acceleration), ticks);
        self.position = self.position.wrapping_add(way);
        self.velocity = self.velocity.wrapping_add(gain);
    }

    /// Position at an edge `age` (Q.28) ago, where the ages of its edges have the variance `spread` (Q.28), in
    /// d with [`INNOVATION_FRAC`] bits.
    #[inline]
    pub const fn position_ago(&self, age: u32, spread: i32) -> i64 {
        let age = if age > OLDEST { OLDEST } else { age };
        let square = (age as u64).wrapping_mul(age as u64).wrapping_shr(28) as i32;
        let square = square.wrapping_add(spread);
        let back = product(high(self.velocity), age.cast_signed());
        let bend = product(high(self.acceleration), square);
        self.position
            .wrapping_shr(COARSE_FRAC - INNOVATION_FRAC)
            .wrapping_sub(back.wrapping_shr(20))
            .wrapping_add(bend.wrapping_shr(25))
    }

    /// Adds what `gains` make of an innovation. Not inlined: the compiler then knows that it has 32 bits.
    #[inline(never)]
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
        is_beyond(self.position, HIGHEST_COARSE)
            || is_beyond(self.velocity, HIGHEST_COARSE)
            || is_beyond(self.acceleration, HIGHEST_FINE)
            || is_beyond(self.disturbance, HIGHEST_FINE)
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
    pub const fn position_q16(&self) -> i64 {
        super::super::shift_rounded(self.position, COARSE_FRAC - Position::FRAC_NBITS)
    }
}

impl Response {
    /// Jerk of the drive for a velocity `wanted` (Q11.20) of it, without disturbance, Q.56.
    #[inline]
    pub const fn jerk(&self, wanted: i64, velocity: i64, acceleration: i64) -> i64 {
        let gap = saturate(wanted.wrapping_sub(velocity.wrapping_shr(32)));
        let pull = product(gap, self.stiffness);
        let drag = product(high(acceleration), self.damping);
        multiplied(pull.wrapping_sub(drag), self.multiplier)
    }

    /// Velocity that the drive aims at under a command in Q.30.
    #[inline]
    pub const fn wanted(&self, command: i32) -> i64 {
        product(command, self.full_velocity)
            .wrapping_shr(30)
            .wrapping_add(self.offset as i64)
    }
}

/// Whether the high word of a state is beyond ±`bound`.
#[inline]
const fn is_beyond(state: i64, bound: u32) -> bool {
    let above = high(state).cast_unsigned().wrapping_add(bound);
    above > bound.wrapping_mul(2)
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
