//! Feedforward over a change of the jerk that comes before the command acts.
//!
//! The feedforward is for τ ahead of the setpoint, v⁺ = v + τ·a + τ²·j/2 and a⁺ = a + τ·j, as if the jerk stayed. Where it
//! changes by Δj after n < τ ticks, which a planned motion knows ([`Turn`](crate::setpoint::Turn)), r = τ − n ticks of the new
//! one are missing:
//!
//! Δu = Δj·(ff_v·r²/2 + ff_a·r + ff_j).
//!
//! Without it each change of the jerk costs Δj·τ/ω² d of the command's integral, which feedback has to take out.

use super::config::Gains;
use super::weights::weight;
use crate::estimator::saturate;
use crate::setpoint::Setpoint;
use crate::units::Jerk;

/// Fractional bits of τ.
const LEAD_FRAC: u32 = 8;
/// Fractional bits of the weights.
const WEIGHT_FRAC: u32 = 20;

/// Quantised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Config {
    /// τ; the weights are those of r²/2, r and 1.
    lead: u32,
    by_square: i32,
    by_time: i32,
    by_jerk: i32,
}

impl Config {
    /// Of the feedforward of `gains`, which are in their ranges.
    pub(super) fn new(gains: &Gains) -> Self {
        let fixed = |gain: f64| {
            libm::ldexp(weight(gain, Jerk::FRAC_NBITS), WEIGHT_FRAC.cast_signed()) as i32
        };
        Self {
            lead: libm::ldexp(gains.feedforward_lead, LEAD_FRAC.cast_signed()) as u32,
            by_square: fixed(gains.velocity_feedforward / 2.0),
            by_time: fixed(gains.acceleration_feedforward),
            by_jerk: fixed(gains.jerk_feedforward),
        }
    }

    /// Nothing.
    pub(super) const NONE: Self = Self {
        lead: 0,
        by_square: 0,
        by_time: 0,
        by_jerk: 0,
    };

    /// Of weights of r²/2 (halved), r and 1, per bit of a jerk with [`WEIGHT_FRAC`], and τ in Q.8.
    pub(super) const fn of_weights(lead: u32, by_square: i32, by_time: i32, by_jerk: i32) -> Self {
        Self {
            lead,
            by_square,
            by_time,
            by_jerk,
        }
    }

    /// Whole ticks of τ.
    pub(super) const fn horizon(&self) -> u32 {
        self.lead.wrapping_shr(LEAD_FRAC)
    }

    /// Δu, Q.30; saturates.
    #[inline]
    pub(super) fn command(&self, setpoint: &Setpoint) -> i32 {
        match rest_of(self.lead, LEAD_FRAC, setpoint) {
            Some(rest) => saturate(self.over(rest, setpoint)),
            None => 0,
        }
    }

    #[cold]
    #[inline(never)]
    fn over(&self, rest: u32, setpoint: &Setpoint) -> i64 {
        let rest = i64::from(rest);
        let linear = i64::from(self.by_square)
            .wrapping_mul(rest)
            .wrapping_shr(LEAD_FRAC)
            .wrapping_add(i64::from(self.by_time));
        let per_jerk = linear
            .wrapping_mul(rest)
            .wrapping_shr(LEAD_FRAC)
            .wrapping_add(i64::from(self.by_jerk));
        i64::from(change(setpoint))
            .wrapping_mul(i64::from(saturate(per_jerk)))
            .wrapping_shr(WEIGHT_FRAC)
    }
}

/// Δj, bits of a [`Jerk`].
#[inline]
pub(super) const fn change(setpoint: &Setpoint) -> i32 {
    setpoint
        .turn
        .jerk
        .to_bits()
        .saturating_sub(setpoint.jerk.to_bits())
}

/// r of a `lead` with `frac` fractional bits, if the jerk changes within it.
#[inline]
pub(super) const fn rest_of(lead: u32, frac: u32, setpoint: &Setpoint) -> Option<u32> {
    let ticks = setpoint.turn.ticks;
    if ticks > lead.wrapping_shr(frac) {
        return None;
    }
    Some(lead.wrapping_sub(ticks.wrapping_shl(frac)))
}
