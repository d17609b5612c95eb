//! The state of motion in fixed point, carried from tick to tick and corrected.

use super::config::{GainScale, INNOVATION_FRAC, Response, STATE_FRAC};
use crate::estimator::saturate;
use crate::units::{Acceleration, Position, Velocity};

/// One, as a state.
const UNIT: i64 = 1 << STATE_FRAC;
/// Bounds of the state's high words: ±4 096 d from the count, ±2 047 d/tick, ±127 d/tick² and d/tick³.
const HIGHEST: [u32; 4] = [
    4096 << HIGH_FRAC,
    2047 << HIGH_FRAC,
    127 << HIGH_FRAC,
    127 << HIGH_FRAC,
];
/// Fractional bits of a state's high word.
const HIGH_FRAC: u32 = STATE_FRAC - 32;
/// Edges are taken for no older than just short of two ticks.
const OLDEST: u32 = (2 << 28) - 1;

/// Position relative to the newest count, velocity, acceleration and the jerk that the disturbance
/// causes, in d and ticks with [`STATE_FRAC`] fractional bits.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motion {
    pub position: i64,
    pub velocity: i64,
    pub acceleration: i64,
    /// δ = k₁·d of a disturbance d in d/tick: a jerk, so that its format does not depend on the drive.
    pub disturbance: i64,
}

impl Motion {
    /// At the middle of the count, moving at `velocity`.
    pub const fn steady(velocity: i64) -> Self {
        Self {
            position: UNIT / 2,
            velocity,
            acceleration: 0,
            disturbance: 0,
        }
    }

    /// A tick under constant `jerk`, in which the count moved by `counts`.
    #[inline]
    pub const fn advance(&mut self, jerk: i64, counts: i32) {
        // 1/6 = (1 + 1/3)/8, and 1/3 = 0x5555…/2³²; the jerk's high part suffices.
        let third = (jerk.wrapping_shr(16) as i32 as i64).wrapping_mul(0x5556);
        let sixth = jerk.wrapping_add(third).wrapping_shr(3);
        let half_acceleration = self.acceleration.wrapping_shr(1);
        let moved = (counts as i64).wrapping_shl(STATE_FRAC);
        self.position = self
            .position
            .wrapping_add(self.velocity)
            .wrapping_add(half_acceleration)
            .wrapping_add(sixth)
            .wrapping_sub(moved);
        self.velocity = self
            .velocity
            .wrapping_add(self.acceleration)
            .wrapping_add(jerk.wrapping_shr(1));
        self.acceleration = self.acceleration.wrapping_add(jerk);
    }

    /// Goes on for `ticks`, Q.28, more than the tick just made.
    #[cold]
    pub const fn carry(&mut self, ticks: i32) {
        let way = product(self.velocity_q20(), ticks, 4);
        let gain = product(self.acceleration_q24(), ticks, 8);
        self.position = self.position.wrapping_add(way);
        self.velocity = self.velocity.wrapping_add(gain);
    }

    /// Position at an edge `age` (Q.28) ago, where the ages of its edges have the variance `spread` (Q.28), in
    /// d with [`INNOVATION_FRAC`] bits.
    #[inline]
    pub const fn position_ago(&self, age: u32, spread: i32) -> i64 {
        let age = if age > OLDEST { OLDEST } else { age };
        let root = age.wrapping_shr(14);
        let square = root.wrapping_mul(root).wrapping_add(spread.cast_unsigned());
        let back = (self.velocity_q20() as i64).wrapping_mul(age as i64);
        let bend = (self.acceleration_q24() as i64).wrapping_mul(square as i64);
        self.position
            .wrapping_shr(STATE_FRAC - INNOVATION_FRAC)
            .wrapping_sub(back.wrapping_shr(24))
            .wrapping_add(bend.wrapping_shr(29))
    }

    /// Adds what `gains` make of an innovation.
    #[inline]
    pub const fn correct(&mut self, innovation: i32, gains: &[i32; 4], scale: &GainScale) {
        let [by_x, by_v, by_a, by_d] = *gains;
        let [x, v, a, d] = scale.0;
        self.position = self.position.wrapping_add(product_shr(innovation, by_x, x));
        self.velocity = self.velocity.wrapping_add(product_shr(innovation, by_v, v));
        self.acceleration = self
            .acceleration
            .wrapping_add(product_shr(innovation, by_a, a));
        self.disturbance = self
            .disturbance
            .wrapping_add(product_shr(innovation, by_d, d));
    }

    /// Whether a part is beyond what any axis does.
    #[inline]
    pub const fn is_wild(&self) -> bool {
        let [x, v, a, d] = HIGHEST;
        high(self.position) > x
            || high(self.velocity) > v
            || high(self.acceleration) > a
            || high(self.disturbance) > d
    }

    /// Velocity, rounded.
    pub const fn velocity_q20(&self) -> i32 {
        rounded(self.velocity, STATE_FRAC - Velocity::FRAC_NBITS) as i32
    }

    /// Acceleration, rounded.
    pub const fn acceleration_q24(&self) -> i32 {
        rounded(self.acceleration, STATE_FRAC - Acceleration::FRAC_NBITS) as i32
    }

    /// Position relative to the count, rounded.
    pub const fn position_q16(&self) -> i64 {
        rounded(self.position, STATE_FRAC - Position::FRAC_NBITS)
    }
}

impl Response {
    /// Jerk of the drive for a velocity `wanted` (Q11.20) of it, without disturbance, as a state.
    #[inline]
    pub const fn jerk(&self, wanted: i64, velocity: i32, acceleration: i32) -> i64 {
        let gap = saturate(wanted.wrapping_sub(velocity as i64));
        let pull = (gap as i64).wrapping_mul(self.stiffness as i64);
        let drag = (acceleration as i64).wrapping_mul(self.damping as i64);
        pull.wrapping_sub(drag).wrapping_shr(self.shift)
    }

    /// Velocity that the drive aims at under a command in Q.30.
    #[inline]
    pub const fn wanted(&self, command: i32) -> i64 {
        (command as i64)
            .wrapping_mul(self.full_velocity as i64)
            .wrapping_shr(30)
            .wrapping_add(self.offset as i64)
    }
}

/// Size of a state's high word; rounds up below zero, so that no bound is too high.
const fn high(state: i64) -> u32 {
    (state.wrapping_shr(32) as i32).unsigned_abs()
}

const fn product(one: i32, other: i32, shift: u32) -> i64 {
    // Q20 · Q28 and Q24 · Q28 for 44.
    (one as i64).wrapping_mul(other as i64).wrapping_shr(shift)
}

/// `one`·`other` / 2^`shift`, rounded to nearest.
const fn product_shr(one: i32, other: i32, shift: u32) -> i64 {
    let half = 1_i64.wrapping_shl(shift.wrapping_sub(1));
    (one as i64)
        .wrapping_mul(other as i64)
        .wrapping_add(half)
        .wrapping_shr(shift)
}

const fn rounded(state: i64, bits: u32) -> i64 {
    super::super::shift_rounded(state, bits)
}
