//! One-sided Gaussian-weighted moving average, then differenced (P2).
//!
//! The newest sample weighs most: α_k ∝ exp(−k²/2σ²), k = 0 … N − 1, Σ α_k = 1. The difference of the
//! mean is the weighted mean of the differences, v = Σ α_k Δ₋ₖ, so the filter runs over the small
//! differences. Weights are integers in Q0.30 whose sum is made exactly 2³⁰; every product and sum is
//! then exact, position included, and only the outputs are rounded, to half their LSB. The weights
//! themselves are off by at most 2⁻³¹ each (the newest by N·2⁻³¹). Against an f64 oracle (test) the paper's
//! σ = 6, N = 25 are right to half an LSB and, for motion up to 150 d/tick, 4.7e-6 d and 1.1e-6 d/tick; up to
//! 2 047 d/tick 6.4e-5 d and 1.5e-5 d/tick.

use super::{
    Delay, Estimate, Evidence, Lags, MAX_WINDOW, Quality, Variances, checked_window, estimate_from,
    steady_delta,
};
use crate::uncertainty::EdgeNoise;
use crate::units::{RangeError, Velocity, checked};

const WEIGHT_FRAC: u32 = 30;

/// The weights and what follows from them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// α_k in Q0.30, newest first; zero beyond the window.
    weights: [i32; MAX_WINDOW],
    window: usize,
    quality: Quality,
}

impl Config {
    /// A window of `window` samples with standard deviation `sigma_ticks` (the paper's optimum is 6;
    /// 25 samples hold 99.99 % of that bell).
    ///
    /// # Errors
    /// [`RangeError`] unless 0.1 ≤ σ ≤ 64 and 1 ≤ window ≤ 64.
    pub fn new(sigma_ticks: f64, window: u32) -> Result<Self, RangeError> {
        let sigma = checked("estimator.sigma_ticks", sigma_ticks, 0.1, 64.0)?;
        let window = checked_window(window)? as usize;
        let bell = |age: usize| libm::exp(-libm::pow(age as f64 / sigma, 2.0) / 2.0);
        let total: f64 = (0..window).map(bell).sum();

        let mut weights = [0_i32; MAX_WINDOW];
        let mut missing = 1_i32.wrapping_shl(WEIGHT_FRAC);
        for (age, weight) in weights.iter_mut().enumerate().take(window) {
            *weight = libm::round(libm::ldexp(bell(age) / total, WEIGHT_FRAC.cast_signed())) as i32;
            missing = missing.wrapping_sub(*weight);
        }
        if let Some(newest) = weights.first_mut() {
            *newest = newest.wrapping_add(missing);
        }
        let lag = (0..window).map(|age| age as f64 * bell(age) / total).sum();
        let weight = |age: Option<usize>| {
            age.filter(|age| *age < window)
                .map_or(0.0, |age| bell(age) / total)
        };
        let squares = |of: &dyn Fn(usize) -> f64| -> f64 {
            (0..window.wrapping_add(2))
                .map(|age| of(age) * of(age))
                .sum()
        };
        let once = |age: usize| weight(Some(age)) - weight(age.checked_sub(1));
        let twice = |age: usize| once(age) - age.checked_sub(1).map_or(0.0, once);
        Ok(Self {
            weights,
            window,
            quality: Quality {
                lags: Lags::of_differenced(lag),
                variances: Variances::of_counts(squares(&once), squares(&twice)),
            },
        })
    }

    pub(super) const fn lags(&self) -> Lags {
        self.quality.lags
    }

    pub(super) const fn warm_up_ticks(&self) -> u32 {
        (self.window as u32).wrapping_add(2)
    }

    pub(super) fn delay(&self) -> Delay {
        let moment = |power: f64| -> f64 {
            let weighted = |(age, weight): (usize, &i32)| {
                libm::pow(age as f64, power)
                    * libm::ldexp(f64::from(*weight), WEIGHT_FRAC.cast_signed().wrapping_neg())
            };
            self.weights.iter().enumerate().map(weighted).sum()
        };
        Delay::of_differenced(&self.quality.lags, moment(2.0) - moment(1.0) * moment(1.0))
    }
}

/// Window of differences.
#[derive(Clone, Debug)]
pub struct Estimator {
    config: Config,
    /// The differences, newest first from `newest` on; each is stored twice, [`MAX_WINDOW`] apart, so
    /// that the window is one slice wherever it starts.
    deltas: [i32; 2 * MAX_WINDOW],
    newest: usize,
    /// x − y, d in Q33.30.
    behind: i64,
    /// Velocity of the previous tick, Q33.30.
    velocity: i64,
}

impl Estimator {
    /// A filter at rest.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            deltas: [0; 2 * MAX_WINDOW],
            newest: 0,
            behind: 0,
            velocity: 0,
        }
    }

    /// Starts anew as after a long motion at `velocity`. Outside the tick.
    pub fn prime(&mut self, velocity: Velocity) {
        *self = Self::new(self.config);
        for age in (0..MAX_WINDOW as u32).rev() {
            self.push(steady_delta(velocity, age));
        }
        self.velocity = self.weighted_sum();
        let window = self.deltas.get(self.newest..).unwrap_or(&[]);
        let mut distance = 0_i64;
        for (&weight, &delta) in self.config.weights.iter().zip(window) {
            self.behind = self
                .behind
                .wrapping_add(i64::from(weight).wrapping_mul(distance));
            distance = distance.wrapping_add(i64::from(delta));
        }
    }

    /// Takes what a tick has to tell.
    #[inline(never)]
    pub fn update_into(&mut self, evidence: &Evidence<'_>, estimate: &mut Estimate) {
        let observation = evidence.observation;
        self.push(observation.delta);
        let velocity = self.weighted_sum();
        let change = velocity.wrapping_sub(self.velocity);
        let step = i64::from(observation.delta).wrapping_shl(WEIGHT_FRAC);
        self.behind = self.behind.wrapping_add(step).wrapping_sub(velocity);
        self.velocity = velocity;
        *estimate = estimate_from::<WEIGHT_FRAC>(
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

    fn push(&mut self, delta: i32) {
        self.newest = self.newest.wrapping_sub(1) % MAX_WINDOW;
        for place in [self.newest, self.newest.wrapping_add(MAX_WINDOW)] {
            if let Some(slot) = self.deltas.get_mut(place) {
                *slot = delta;
            }
        }
    }

    /// Σ α_k Δ₋ₖ in Q33.30: at most 2 047·2³⁰.
    fn weighted_sum(&self) -> i64 {
        let window = self.deltas.get(self.newest..).unwrap_or(&[]);
        let weights = self.config.weights.get(..self.config.window).unwrap_or(&[]);
        let products = weights
            .iter()
            .zip(window)
            .map(|(&weight, &delta)| i64::from(weight).wrapping_mul(i64::from(delta)));
        products.fold(0, i64::wrapping_add)
    }
}
