//! What depends on the times of the samples alone.
//!
//! With u the time from the origin and brackets for n·Σ(…) − Σ·Σ, the covariances times n²: s = [x,u]/[u,u] is the
//! slope of the line, β = [u²,u]/[u,u], the spread [u²,u²] − β·[u²,u], and the variances of the fit are σ²·n·4/spread
//! of the acceleration and σ²·n·(1/[u,u] + (2u − β)²/spread) of the velocity at u.

use super::GRID_BITS;
use super::config::MIN_SAMPLES;
use super::fit::{Sums, times, wide};
use super::ratio::Reciprocal;

/// Fractional bits of β, steps.
pub const BETA_FRAC: u32 = 20;
/// Fractional bits of [`Geometry::middle`], steps.
pub const MIDDLE_FRAC: u32 = 8;
/// Fractional bits of the gains of variances.
pub const GAIN_FRAC: u32 = 28;
/// Fractional bits of the arm 2u − β, steps.
const ARM_FRAC: u32 = 4;

/// Brackets of the times and what is divided by them.
#[derive(Clone, Copy, Debug)]
pub struct Geometry {
    /// [u,u]; positive with two samples at different times.
    pub uu: i64,
    /// [u²,u].
    pub u2u: i64,
    /// [u²,u²] − β·[u²,u].
    pub spread: i64,
    /// Steps in Q.20.
    pub beta: i32,
    pub by_uu: Reciprocal,
    /// 1/spread where a quadratic goes through the samples.
    pub by_spread: Option<Reciprocal>,
    /// Mean time of the samples, steps in Q.8.
    pub middle: i32,
}

/// Variances of a fit per d² of an edge times the mean weight, [`GAIN_FRAC`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gains {
    /// Of the velocity at the middle, (d/tick)².
    pub velocity: u32,
    /// Of the acceleration, (d/tick²)².
    pub acceleration: u32,
}

impl Geometry {
    #[inline(never)]
    /// Of samples at the times of `m`.
    pub fn of(m: &Sums) -> Self {
        let uu = wide(m.weight, m.t2).wrapping_sub(wide(m.t1, m.t1));
        let u2u = wide(m.weight, m.t3).wrapping_sub(wide(m.t1, m.t2));
        let by_uu = Reciprocal::new(uu.cast_unsigned());
        let mut geometry = Self {
            uu,
            u2u,
            by_uu,
            beta: by_uu.ratio(u2u, BETA_FRAC),
            middle: m
                .t1
                .wrapping_shl(MIDDLE_FRAC)
                .checked_div(m.weight)
                .unwrap_or(0),
            spread: 0,
            by_spread: None,
        };
        geometry.spread = times(m.t4, m.weight)
            .wrapping_sub(wide(m.t2, m.t2))
            .wrapping_sub(geometry.beta_times(u2u));
        if m.samples >= MIN_SAMPLES && geometry.spread > 0 {
            geometry.by_spread = Some(Reciprocal::new(geometry.spread.cast_unsigned()));
        }
        geometry
    }

    /// β·`value`, rounded down, where it fits: by two 32-bit products.
    #[inline]
    pub fn beta_times(&self, value: i64) -> i64 {
        let high = wide(value.wrapping_shr(32) as i32, self.beta);
        let low = times(i64::from(value as u32), self.beta);
        high.wrapping_shl(32 - BETA_FRAC)
            .wrapping_add(low.wrapping_shr(BETA_FRAC))
    }

    /// Of samples whose weights add up to `weight`.
    pub fn gains(&self, weight: i32) -> Gains {
        let weight = u64::from(weight.unsigned_abs());
        let velocity = self.by_uu.size(weight, 2 * GRID_BITS + GAIN_FRAC);
        let Some(by_spread) = self.by_spread else {
            return Gains {
                velocity,
                acceleration: 0,
            };
        };
        let arm = self
            .middle
            .wrapping_shr(MIDDLE_FRAC - ARM_FRAC - 1)
            .wrapping_sub(self.beta.wrapping_shr(BETA_FRAC - ARM_FRAC));
        let turned = weight.saturating_mul(u64::from(arm.unsigned_abs().saturating_pow(2)));
        let of_bend = by_spread.size(turned, 2 * GRID_BITS + GAIN_FRAC - 2 * ARM_FRAC);
        Gains {
            velocity: velocity.saturating_add(of_bend),
            acceleration: by_spread.size(weight, 4 * GRID_BITS + 2 + GAIN_FRAC),
        }
    }
}
