//! The exact state of a planned motion.

use super::STATE_FRAC;
use crate::units::{Acceleration, Position, Velocity};

/// Where a planned motion is between two ticks, in whole units of 2⁻⁴⁸ d: no rounding adds up in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct State {
    /// Position, 2⁻⁴⁸ d.
    pub(in crate::setpoint) position: i128,
    /// Velocity, 2⁻⁴⁸ d/tick, the creep of a plan apart.
    pub(in crate::setpoint) velocity: i64,
    /// Acceleration, 2⁻⁴⁸ d/tick²; even.
    pub(in crate::setpoint) acceleration: i64,
}

/// `ticks` of constant jerk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::setpoint) struct Segment {
    pub(in crate::setpoint) ticks: u32,
    /// Jerk, 2⁻⁴⁸ d/tick³; even.
    pub(in crate::setpoint) jerk: i64,
}

impl Segment {
    /// What the jerk adds to the position in a tick: a sixth, towards zero.
    pub(in crate::setpoint) const fn sixth(&self) -> i64 {
        self.jerk.wrapping_div(6)
    }
}

impl State {
    /// At rest at `position`.
    #[must_use]
    pub fn at_rest(position: Position) -> Self {
        Self {
            position: in_units(position),
            velocity: 0,
            acceleration: 0,
        }
    }

    /// A state with these values.
    #[must_use]
    pub fn new(position: Position, velocity: Velocity, acceleration: Acceleration) -> Self {
        Self {
            position: in_units(position),
            velocity: i64::from(velocity.to_bits()).wrapping_shl(STATE_FRAC - Velocity::FRAC_NBITS),
            acceleration: i64::from(acceleration.to_bits())
                .wrapping_shl(STATE_FRAC - Acceleration::FRAC_NBITS),
        }
    }

    /// True if it neither moves nor begins to.
    #[must_use]
    pub const fn is_at_rest(&self) -> bool {
        self.velocity == 0 && self.acceleration == 0
    }

    /// Position to the nearest LSB, d.
    #[must_use]
    pub const fn position(&self) -> Position {
        const SHIFT: u32 = STATE_FRAC - Position::FRAC_NBITS;
        let rounded = self.position.wrapping_add(1 << (SHIFT - 1));
        Position::from_bits(rounded.wrapping_shr(SHIFT) as i64)
    }

    /// The state turned round.
    pub(super) const fn mirrored(&self) -> Self {
        Self {
            position: self.position.wrapping_neg(),
            velocity: self.velocity.wrapping_neg(),
            acceleration: self.acceleration.wrapping_neg(),
        }
    }

    /// The state after `ticks` of a segment: the sums of x += v + a/2 + j/6, v += a + j/2, a += j are
    /// x += T·v + T²·a/2 + (T − 1)·T·(T + 1)/3·j/2 + T·(j/6), v += T·a + T²·j/2, a += T·j. They fit 127 bits for 2³¹
    /// ticks without jerk and for 2²⁴ with.
    pub(super) fn after(&self, segment: &Segment, ticks: u32) -> Self {
        let time = i128::from(ticks);
        let square = time.wrapping_mul(time);
        let cube = square
            .wrapping_sub(1)
            .wrapping_mul(time)
            .checked_div(3)
            .unwrap_or_default();
        let half_jerk = i128::from(segment.jerk.wrapping_shr(1));
        let half_acceleration = i128::from(self.acceleration.wrapping_shr(1));
        let way = i128::from(self.velocity)
            .wrapping_add(i128::from(segment.sixth()))
            .wrapping_mul(time)
            .wrapping_add(half_acceleration.wrapping_mul(square))
            .wrapping_add(half_jerk.wrapping_mul(cube));
        let gain = i128::from(self.acceleration)
            .wrapping_mul(time)
            .wrapping_add(half_jerk.wrapping_mul(square));
        let bend = i128::from(segment.jerk).wrapping_mul(time);
        Self {
            position: self.position.wrapping_add(way),
            velocity: self.velocity.wrapping_add(gain as i64),
            acceleration: self.acceleration.wrapping_add(bend as i64),
        }
    }
}

/// A position in 2⁻⁴⁸ d.
pub(in crate::setpoint) fn in_units(position: Position) -> i128 {
    i128::from(position.to_bits()).wrapping_shl(STATE_FRAC - Position::FRAC_NBITS)
}
