//! Exponential smoothing: y += α(x − y), then differenced (P2).
//!
//! Kept as the distance `behind` = x − y in Q31.32, not as y itself: with u = behind₋₁ + Δx the
//! update is v = α·u, behind = u − v, so one multiplication gives position and velocity and the state
//! stays small wherever the axis stands. α is rounded to 2⁻³¹. The product is rounded down by at most
//! 2⁻³² d; what is cut stays in `behind`, so the sum of the velocities is exactly the motion of y.
//! Against an f64 oracle (test) the outputs are right to half their own LSB and what the rounding of α
//! adds: at the paper's α = 0.18 and 150 d/tick 7.8e-7 d and 2.8e-7 d/tick, at 2 047 d/tick 1.1e-5 d and
//! 3.9e-6 d/tick.

use super::{Delay, Estimate, Evidence, Lags, Quality, Variances, estimate_from};
use crate::uncertainty::EdgeNoise;
use crate::units::{RangeError, Velocity, checked};

const STATE_FRAC: u32 = 32;
const ALPHA_FRAC: u32 = 31;

/// The smoothing factor and what follows from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// α in Q0.31.
    alpha: i32,
    quality: Quality,
    warm_up_ticks: u32,
}

impl Config {
    /// A filter with smoothing factor `alpha` (the paper's optimum is 0.18).
    ///
    /// # Errors
    /// [`RangeError`] unless 0.001 ≤ α ≤ 0.999.
    pub fn new(alpha: f64) -> Result<Self, RangeError> {
        let alpha = checked("estimator.alpha", alpha, 0.001, 0.999)?;
        // Of the weights α(1 − α)^k, differenced once and twice.
        let once = 2.0 * alpha * alpha / (2.0 - alpha);
        let twice = alpha * alpha * (1.0 + (1.0 + alpha) * (1.0 + alpha))
            + libm::pow(alpha, 5.0) / (2.0 - alpha);
        Ok(Self {
            alpha: libm::round(libm::ldexp(alpha, 31)) as i32,
            quality: Quality {
                lags: Lags::of_differenced((1.0 - alpha) / alpha),
                variances: Variances::of_counts(once, twice),
            },
            warm_up_ticks: libm::ceil(libm::log(1e-6) / libm::log(1.0 - alpha)) as u32,
        })
    }

    pub(super) const fn lags(&self) -> Lags {
        self.quality.lags
    }

    pub(super) const fn warm_up_ticks(&self) -> u32 {
        self.warm_up_ticks
    }

    /// The variance of the geometric weights' age is (1 − α)/α².
    pub(super) fn delay(&self) -> Delay {
        let alpha = libm::ldexp(
            f64::from(self.alpha),
            ALPHA_FRAC.cast_signed().wrapping_neg(),
        );
        Delay::of_differenced(&self.quality.lags, (1.0 - alpha) / (alpha * alpha))
    }
}

/// Filter state.
#[derive(Clone, Debug)]
pub struct Estimator {
    config: Config,
    /// x − y, d in Q31.32; at most 2 047 d / α < 2²¹ d.
    behind: i64,
    /// Velocity of the previous tick, Q31.32.
    velocity: i64,
}

impl Estimator {
    /// A filter at rest.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            behind: 0,
            velocity: 0,
        }
    }

    /// Starts anew as after a long motion at `velocity`: then x − y = v·(1 − α)/α. Outside the tick.
    pub fn prime(&mut self, velocity: Velocity) {
        self.velocity =
            i64::from(velocity.to_bits()).wrapping_shl(STATE_FRAC - Velocity::FRAC_NBITS);
        let ahead = i128::from(self.velocity).wrapping_shl(ALPHA_FRAC);
        let ahead = ahead
            .checked_div(i128::from(self.config.alpha))
            .unwrap_or(0);
        self.behind = (ahead as i64).wrapping_sub(self.velocity);
    }

    /// Takes what a tick has to tell.
    #[inline(never)]
    pub fn update_into(&mut self, evidence: &Evidence<'_>, estimate: &mut Estimate) {
        let observation = evidence.observation;
        let step = i64::from(observation.delta).wrapping_shl(STATE_FRAC);
        let ahead = self.behind.wrapping_add(step);
        let velocity = scale(ahead, self.config.alpha);
        let change = velocity.wrapping_sub(self.velocity);
        self.behind = ahead.wrapping_sub(velocity);
        self.velocity = velocity;
        *estimate = estimate_from::<STATE_FRAC>(
            observation,
            self.behind,
            velocity,
            change,
            &self.config.quality,
        );
    }

    /// How uncertain the newest estimate is: its counts are rounded, and edges tell it nothing.
    #[must_use]
    pub const fn variances(&self, _: &EdgeNoise) -> Variances {
        self.config.quality.variances
    }
}

/// `value`·`factor`/2³¹, rounded down, by two 32-bit multiplications; `factor` is not negative and
/// |value| stays below 2⁶².
const fn scale(value: i64, factor: i32) -> i64 {
    let high = value.wrapping_shr(32) as i32;
    let low = value as u32;
    let from_high = (high as i64)
        .wrapping_mul(factor as i64)
        .wrapping_shl(32 - ALPHA_FRAC);
    let from_low = (low as u64)
        .wrapping_mul(factor as u32 as u64)
        .wrapping_shr(ALPHA_FRAC);
    from_high.wrapping_add(from_low.cast_signed())
}

#[cfg(test)]
mod tests {
    use super::scale;

    #[test]
    fn scale_is_the_wide_product_rounded_down() {
        let values = [
            0,
            1,
            -1,
            0x1234_5678_9abc,
            -0x1234_5678_9abc,
            (1 << 61) + 12_345,
            -(1 << 61) - 12_345,
        ];
        for value in values {
            for factor in [0, 1, 386_547_057, 1 << 30, i32::MAX] {
                let exact = (i128::from(value) * i128::from(factor)) >> 31;
                assert_eq!(
                    i128::from(scale(value, factor)),
                    exact,
                    "{value} * {factor}"
                );
            }
        }
    }
}
