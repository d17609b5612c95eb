//! Errors of one quantity of one estimator, run up tick by tick.

use crate::statistics::Spread;

/// Errors, lags and stated standard deviations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Estimate less truth at its instant.
    pub error: Spread,
    ticks: u64,
    /// Ticks in which the shaft moves, and the lags in them.
    moving: u64,
    lags: f64,
    stated: f64,
    within: u64,
}

impl Tally {
    /// Takes in an error, the lag it was taken at (none where the shaft stands still and lags are of no account) and the
    /// 1σ that the estimate stated.
    pub fn push(&mut self, error: f64, lag_ticks: Option<f64>, stated: f64) {
        self.error.push(error);
        self.ticks += 1;
        if let Some(lag) = lag_ticks {
            self.moving += 1;
            self.lags += lag;
        }
        self.stated += stated;
        self.within += u64::from(error.abs() <= 2.0 * stated);
    }

    /// Both together.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        Self {
            error: self.error.and(&other.error),
            ticks: self.ticks + other.ticks,
            moving: self.moving + other.moving,
            lags: self.lags + other.lags,
            stated: self.stated + other.stated,
            within: self.within + other.within,
        }
    }

    /// Mean lag while the shaft moves, ticks.
    #[must_use]
    pub fn mean_lag(&self) -> f64 {
        self.lags / self.moving as f64
    }

    /// Rms error over the mean of the stated 1σ: 1 where it is honest.
    #[must_use]
    pub fn honesty(&self) -> f64 {
        self.error.rms() * self.ticks as f64 / self.stated
    }

    /// Share of the errors within twice the stated 1σ.
    #[must_use]
    pub fn within_two_sigma(&self) -> f64 {
        self.within as f64 / self.ticks as f64
    }
}

#[cfg(test)]
mod tests {
    use super::Tally;

    #[test]
    fn tallies_add_up() {
        let mut one = Tally::default();
        one.push(3.0, Some(1.0), 2.0);
        let mut other = Tally::default();
        other.push(-4.0, Some(2.0), 1.0);
        let both = one.and(&other);
        assert_eq!(
            (both.error.rms(), both.error.peak()),
            (12.5_f64.sqrt(), 4.0)
        );
        assert_eq!(both.mean_lag(), 1.5);
        assert_eq!(both.honesty(), 12.5_f64.sqrt() / 1.5);
        assert_eq!(both.within_two_sigma(), 0.5);
    }
}
