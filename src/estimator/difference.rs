//! Differences of the count: V = X − X₋₁, a = V − V₋₁ (P1, formulas 1 and 2).
//!
//! Exact in fixed point; what it lacks is resolution: one discrete a tick.

use super::{Delay, Estimate, Evidence, Lags, Variances};
use crate::uncertainty::EdgeNoise;
use crate::units::{Acceleration, Lag, Variance, Velocity};

/// There is nothing to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config;

impl Config {
    pub(super) const fn lags(&self) -> Lags {
        const HALF: Lag = Lag::lit("0.5");
        Lags {
            position: Lag::ZERO,
            velocity: HALF,
            acceleration: Lag::ONE,
        }
    }

    pub(super) const fn warm_up_ticks(&self) -> u32 {
        2
    }

    /// Weights 1, −1 and 1, −2, 1: their squares add up to 2 and 6, see [`Variances::of_counts`].
    const fn variances(&self) -> Variances {
        const SIXTH: Variance = Variance::lit("0.166666666666666667");
        const HALF: Variance = Variance::lit("0.5");
        Variances {
            velocity: SIXTH,
            acceleration: HALF,
        }
    }

    pub(super) fn delay(&self) -> Delay {
        Delay::of_differenced(&self.lags(), 0.0)
    }
}

/// The previous difference is the whole state.
#[derive(Clone, Debug)]
pub struct Estimator {
    previous_delta: i32,
}

impl Estimator {
    /// An estimator at rest.
    #[must_use]
    pub const fn new(_: Config) -> Self {
        Self { previous_delta: 0 }
    }

    /// Starts anew as after a long motion at `velocity`.
    pub fn prime(&mut self, velocity: Velocity) {
        self.previous_delta = velocity.round().to_num();
    }

    /// Takes what a tick has to tell. An acceleration beyond ±128 d/tick² saturates.
    #[inline(never)]
    pub fn update_into(&mut self, evidence: &Evidence<'_>, estimate: &mut Estimate) {
        let observation = evidence.observation;
        let delta = observation.delta;
        let change = delta.wrapping_sub(self.previous_delta);
        self.previous_delta = delta;
        *estimate = Estimate {
            position: observation.position(),
            velocity: Velocity::wrapping_from_num(delta),
            acceleration: Acceleration::saturating_from_num(change),
            lags: const { Config.lags() },
        };
    }

    /// How uncertain the newest estimate is: its counts are rounded, and edges tell it nothing.
    #[must_use]
    pub const fn variances(&self, _: &EdgeNoise) -> Variances {
        Config.variances()
    }
}
