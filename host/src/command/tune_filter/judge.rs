//! What an estimator's acceleration is worth: its lag, and its error against a reference.

use leadscrew::estimator::Estimate;

use super::sweep::Candidate;
use crate::statistics::Spread;

/// Running figures of one candidate.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Judge {
    error: Spread,
    lags: f64,
}

impl Judge {
    /// Takes an estimate in; `reference` gives the acceleration so many ticks before the sample, where it is known.
    pub(super) fn push(&mut self, estimate: &Estimate, reference: impl Fn(f64) -> Option<f64>) {
        let lag: f64 = estimate.lags.acceleration.to_num();
        if let Some(expected) = reference(lag) {
            self.error
                .push(estimate.acceleration.to_num::<f64>() - expected);
            self.lags += lag;
        }
    }

    /// Ticks taken in.
    pub(super) const fn ticks(&self) -> u64 {
        self.error.count()
    }

    /// Rms error of the acceleration, d/tick².
    pub(super) fn sigma(&self) -> f64 {
        self.error.rms()
    }

    /// Mean lag of the acceleration as the estimator computes it, ticks.
    pub(super) fn lag(&self) -> f64 {
        self.lags / self.error.count().max(1) as f64
    }
}

/// Ticks after which all candidates have settled: they are judged on the same ones.
pub(super) fn warm_up(candidates: &[Candidate]) -> u64 {
    let ticks = candidates
        .iter()
        .map(|candidate| candidate.config.warm_up_ticks());
    u64::from(ticks.max().unwrap_or(0))
}
