//! Simple moving average over N samples, then differenced (P2), in O(1) a tick.
//!
//! Over the last N differences Δ the velocity is their sum over N and the acceleration the newest
//! less the oldest over N; the position's distance behind the newest count is a running sum of sums.
//! All three sums are exact integers and each is divided once, so there is no drift and the outputs
//! are right to half their own LSB (test against an f64 oracle).

use super::{
    Delay, Estimate, Evidence, Lags, MAX_WINDOW, Quality, Variances, checked_window, steady_delta,
};
use crate::uncertainty::EdgeNoise;
use crate::units::{Acceleration, Position, RangeError, Velocity};

/// The window and what follows from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    window: i32,
    quality: Quality,
}

impl Config {
    /// A mean of `window` samples (the paper's optimum is 15).
    ///
    /// # Errors
    /// [`RangeError`] unless 1 ≤ window ≤ 64.
    pub fn new(window: u32) -> Result<Self, RangeError> {
        let window = checked_window(window)?;
        let samples = f64::from(window);
        // Weights ±1/N at both ends of the window; differenced again, twice as many, which meet if N is 1.
        let twice = if window == 1 { 6.0 } else { 4.0 };
        Ok(Self {
            window: window.cast_signed(),
            quality: Quality {
                lags: Lags::of_differenced((samples - 1.0) / 2.0),
                variances: Variances::of_counts(
                    2.0 / (samples * samples),
                    twice / (samples * samples),
                ),
            },
        })
    }

    pub(super) const fn lags(&self) -> Lags {
        self.quality.lags
    }

    pub(super) const fn warm_up_ticks(&self) -> u32 {
        self.window.cast_unsigned().wrapping_add(2)
    }

    /// The variance of the samples' age is (N² − 1)/12.
    pub(super) fn delay(&self) -> Delay {
        let window = f64::from(self.window);
        Delay::of_differenced(&self.quality.lags, (window * window - 1.0) / 12.0)
    }
}

/// Window of differences and the sums over it.
#[derive(Clone, Debug)]
pub struct Estimator {
    config: Config,
    deltas: [i32; MAX_WINDOW],
    oldest: usize,
    /// Σ Δ over the window: x − x₋ₙ, within ±2¹⁷.
    moved: i32,
    /// Σ (x − x₋ₖ) over k = 0 … N − 1, within ±2²².
    behind: i32,
}

impl Estimator {
    /// A filter at rest.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            deltas: [0; MAX_WINDOW],
            oldest: 0,
            moved: 0,
            behind: 0,
        }
    }

    /// Starts anew as after a long motion at `velocity`. Outside the tick.
    pub fn prime(&mut self, velocity: Velocity) {
        *self = Self::new(self.config);
        let window = self.config.window;
        // The oldest place of the ring is filled first.
        let ages = (0..window.cast_unsigned()).rev();
        for (place, age) in self.deltas.iter_mut().zip(ages) {
            *place = steady_delta(velocity, age);
            self.moved = self.moved.wrapping_add(*place);
            // A difference of age k separates the newest sample from the N − 1 − k oldest ones.
            let older = window.wrapping_sub(1).wrapping_sub(age.cast_signed());
            self.behind = self.behind.wrapping_add(place.wrapping_mul(older));
        }
    }

    /// Takes what a tick has to tell. An acceleration beyond ±128 d/tick² saturates.
    #[inline(never)]
    pub fn update_into(&mut self, evidence: &Evidence<'_>, estimate: &mut Estimate) {
        let observation = evidence.observation;
        let window = self.config.window;
        let newest = observation.delta;
        let oldest = self.exchange(newest);
        let change = newest.wrapping_sub(oldest);
        // Every older sample falls back by Δ, and the one that leaves takes its distance with it.
        let others = self.moved.wrapping_sub(oldest);
        self.behind = self
            .behind
            .wrapping_sub(others)
            .wrapping_add(newest.wrapping_mul(window.wrapping_sub(1)));
        self.moved = self.moved.wrapping_add(change);

        let behind = divide::<{ Position::FRAC_NBITS }>(self.behind, window);
        *estimate = Estimate {
            position: Position::from_bits(observation.position().to_bits().wrapping_sub(behind)),
            velocity: Velocity::from_bits(
                divide::<{ Velocity::FRAC_NBITS }>(self.moved, window) as i32
            ),
            acceleration: Acceleration::from_bits(super::saturate(divide::<
                { Acceleration::FRAC_NBITS },
            >(change, window))),
            lags: self.config.quality.lags,
        };
    }

    /// How uncertain the newest estimate is: its counts are rounded, and edges tell it nothing.
    #[must_use]
    pub const fn variances(&self, _: &EdgeNoise) -> Variances {
        self.config.quality.variances
    }

    /// Puts the newest difference in the place of the oldest and returns the latter.
    fn exchange(&mut self, newest: i32) -> i32 {
        let slot = self.oldest;
        let next = slot.wrapping_add(1);
        self.oldest = if next >= self.config.window as usize {
            0
        } else {
            next
        };
        self.deltas
            .get_mut(slot)
            .map_or(0, |place| core::mem::replace(place, newest))
    }
}

/// `sum`·2^`FRAC` / `count`, to nearest, by two 32-bit divisions; `count` is 1 to [`MAX_WINDOW`].
fn divide<const FRAC: u32>(sum: i32, count: i32) -> i64 {
    let whole = sum.checked_div(count).unwrap_or(0);
    let rest = sum.wrapping_sub(whole.wrapping_mul(count));
    let half = count.wrapping_shr(1);
    let half = if rest < 0 { half.wrapping_neg() } else { half };
    let fraction = rest
        .wrapping_shl(FRAC)
        .wrapping_add(half)
        .checked_div(count)
        .unwrap_or(0);
    i64::from(whole)
        .wrapping_shl(FRAC)
        .wrapping_add(i64::from(fraction))
}

#[cfg(test)]
mod tests {
    use super::divide;

    #[test]
    fn division_rounds_to_nearest() {
        for count in 1..=64 {
            for sum in [-131_008, -1001, -15, -1, 0, 1, 7, 1001, 131_008] {
                let exact = f64::from(sum) / f64::from(count) * f64::from(1 << 24);
                let error = divide::<24>(sum, count) as f64 - exact;
                assert!(error.abs() <= 0.5, "{sum} / {count}: off by {error} LSB");
            }
        }
    }
}
