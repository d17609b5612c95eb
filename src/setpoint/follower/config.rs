//! The limits of a follower and the acceleration that they allow in a tick.

use super::stopping::Stopping;
use super::{ACCELERATION_SHIFT, JERK_SHIFT};
use crate::narrowing::within_or_high;
use crate::setpoint::Setpoint;
use crate::setpoint::profile::{Limits, STATE_FRAC};
use crate::units::{Acceleration, Position};

/// The largest change of velocity, d/tick.
const LARGEST_CHANGE: f64 = 4096.0;
/// A unit of the state, d.
const UNIT: f64 = 1.0 / (1_u64 << STATE_FRAC) as f64;

/// Limits of a follower, as the tick needs them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Largest acceleration that is built up, 2⁻⁴⁸ d/tick².
    acceleration: i64,
    /// Largest jerk, 2⁻⁴⁸ d/tick³.
    jerk: i64,
    /// Bits that an acceleration drops to have 32.
    coarse_shift: u32,
    /// 2³² / jerk, the jerk as coarse.
    per_jerk: u32,
    stopping: Stopping,
}

impl Config {
    /// The acceleration and jerk of `limits`. An acceleration of which no change of velocity within the format
    /// makes use is never reached.
    #[must_use]
    pub fn new(limits: &Limits) -> Self {
        let useful = libm::sqrt(2.0 * LARGEST_CHANGE * limits.jerk().to_num::<f64>());
        let useful = libm::ldexp(useful, Acceleration::FRAC_NBITS.cast_signed()) as i64;
        let acceleration = useful
            .min(i64::from(limits.acceleration().to_bits()))
            .wrapping_shl(ACCELERATION_SHIFT);
        // A jerk that goes from one end to the other in a tick is as good as any greater one.
        let jerk = i64::from(limits.jerk().to_bits())
            .wrapping_shl(JERK_SHIFT)
            .min(acceleration.wrapping_mul(2));
        let largest = acceleration.wrapping_add(jerk);
        let coarse_shift = 32_u32.saturating_sub(largest.leading_zeros());
        let coarse_jerk = jerk.wrapping_shr(coarse_shift).unsigned_abs().max(2);
        let per_jerk = (1_u64 << 32).checked_div(coarse_jerk).unwrap_or_default() as u32;
        Self {
            acceleration,
            jerk,
            coarse_shift,
            per_jerk,
            stopping: Stopping::new(acceleration as f64 * UNIT, jerk as f64 * UNIT),
        }
    }

    /// The acceleration after the next tick, from `current`, when `gap` is the velocity E to be gained.
    pub(super) fn next_acceleration(&self, gap: i64, current: i64) -> i64 {
        if gap < 0 {
            self.climb(gap.wrapping_neg(), current.wrapping_neg())
                .wrapping_neg()
        } else {
            self.climb(gap, current)
        }
    }

    /// The same for a gap that is not negative.
    fn climb(&self, gap: i64, current: i64) -> i64 {
        let highest = current.wrapping_add(self.jerk).min(self.acceleration);
        let lowest = current.wrapping_sub(self.jerk);
        if highest <= 0 {
            return highest;
        }
        let mut level = lowest.max(0);
        if level >= highest {
            return level;
        }
        let whole = self.ticks_of_jerk(level);
        let below = whole.wrapping_mul(self.jerk);
        let mut slope = whole.wrapping_add(1);
        // j·n(n + 1)/2 + (n + 1)·r; both stay below 2⁶¹ by the largest change of velocity.
        let triangle = below.wrapping_mul(slope).wrapping_shr(1);
        let over = level.wrapping_sub(below);
        let mut rest = gap
            .wrapping_sub(triangle)
            .wrapping_sub(over.wrapping_mul(slope));
        if rest <= 0 {
            return level;
        }
        // From the lowest acceleration to the highest there are at most three slopes of G.
        let mut room = self.jerk.wrapping_sub(over);
        for _ in 0..3 {
            let capacity = room.wrapping_mul(slope);
            if rest < capacity {
                level = level.wrapping_add(divided(rest, slope));
                break;
            }
            rest = rest.wrapping_sub(capacity);
            level = level.wrapping_add(room);
            slope = slope.wrapping_add(1);
            room = self.jerk;
        }
        level.min(highest) & !1
    }

    /// ⌊`acceleration` / j⌋ of an acceleration from zero to the largest.
    fn ticks_of_jerk(&self, acceleration: i64) -> i64 {
        let coarse = acceleration
            .wrapping_shr(self.coarse_shift)
            .wrapping_mul(i64::from(self.per_jerk));
        let ticks = coarse.unsigned_abs().wrapping_shr(32).cast_signed();
        let over = acceleration.wrapping_sub(ticks.wrapping_mul(self.jerk));
        if over < 0 {
            ticks.wrapping_sub(1)
        } else if over >= self.jerk {
            ticks.wrapping_add(1)
        } else {
            ticks
        }
    }

    /// The acceleration to which a setpoint goes, its jerk within the limits.
    pub(super) fn announced(&self, acceleration: i64, jerk: i64) -> i64 {
        let limit = self.acceleration;
        let wanted = within_or_high(acceleration.wrapping_add(jerk), limit.wrapping_neg(), limit);
        within_or_high(
            wanted,
            acceleration.wrapping_sub(self.jerk),
            acceleration.wrapping_add(self.jerk),
        )
    }

    /// How far ahead of `setpoint` a stop that takes over there ends, d, signed: never less than it will be in the
    /// direction in which it ends, and more by a few d at the most.
    #[must_use]
    pub fn stopping_distance(&self, setpoint: &Setpoint) -> Position {
        let before = i64::from(setpoint.acceleration.to_bits()).wrapping_shl(ACCELERATION_SHIFT);
        let jerk = i64::from(setpoint.jerk.to_bits()).wrapping_shl(JERK_SHIFT);
        let after = self
            .announced(before, jerk)
            .wrapping_shr(ACCELERATION_SHIFT);
        self.stopping.distance(setpoint, after as i32)
    }
}

/// `rest` / `slope` by one 32-bit division, not above it; exact for the slope 1. The slope fits 32 bits.
fn divided(rest: i64, slope: i64) -> i64 {
    if slope == 1 {
        return rest;
    }
    let drop = 32_u32.saturating_sub(rest.leading_zeros());
    let coarse = rest.wrapping_shr(drop) as u32;
    let quotient = coarse.checked_div(slope as u32).unwrap_or_default();
    i64::from(quotient).wrapping_shl(drop)
}
