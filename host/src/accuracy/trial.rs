//! Estimators on prescribed motions: error against the truth, and lag by response.

use leadscrew::edges::EdgeConfig;
use leadscrew::estimator::{Estimate, EstimatorConfig};
use leadscrew::uncertainty::EdgeErrors;
use leadscrew::units::RangeError;
use leadscrew_hal_mock::arc::State;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::{Motion, Scene};

use crate::listening::Listening;
use crate::statistics::Spread;
use crate::truth::TruthTrack;

/// What is to be measured.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Motion of the shaft.
    pub motion: Motion,
    /// The encoder on it.
    pub encoder: EncoderModel,
    /// Control rate, Hz.
    pub tick_hz: f64,
    /// Ticks to run after warm-up.
    pub ticks: u32,
    /// What is said of the encoder's edges.
    pub errors: EdgeErrors,
    /// Seed of the encoder.
    pub seed: u64,
}

/// Estimates of a trial after warm-up, with the truth.
#[derive(Clone, Debug)]
pub struct Observed {
    /// Estimates, one a tick.
    pub estimates: Vec<Estimate>,
    warm_up: usize,
    truth: TruthTrack,
}

impl Trial {
    /// Runs an estimator on the trial.
    ///
    /// # Errors
    /// A parameter of the encoder out of range.
    pub fn observe(&self, config: EstimatorConfig) -> Result<Observed, RangeError> {
        let mut scene = Scene::new(self.motion, &self.encoder, self.tick_hz, 0.0, self.seed)?;
        let scale = EdgeConfig::new(self.tick_hz, self.encoder.encoder.timer_hz, &self.errors)?;
        let mut listening = Listening::new(&[config], scale);
        let mut truth = TruthTrack::default();
        let mut estimates = Vec::new();
        let warm_up = config.warm_up_ticks();
        for tick in 0..warm_up + self.ticks {
            scene.step();
            truth.push(scene.truth());
            listening.hear(&scene.capture(), None, |_, estimate| {
                if tick >= warm_up {
                    estimates.push(estimate);
                }
            });
        }
        Ok(Observed {
            estimates,
            warm_up: warm_up as usize,
            truth,
        })
    }
}

impl Observed {
    /// Velocity error against the truth at the estimate's instant, d/tick.
    #[must_use]
    pub fn velocity_error(&self) -> Spread {
        self.errors(
            |estimate| estimate.lags.velocity.to_num(),
            |estimate, truth| estimate.velocity.to_num::<f64>() - truth.velocity,
        )
        .collect()
    }

    /// Acceleration error against the truth at the estimate's instant, d/tick².
    #[must_use]
    pub fn acceleration_error(&self) -> Spread {
        self.errors(
            |estimate| estimate.lags.acceleration.to_num(),
            |estimate, truth| estimate.acceleration.to_num::<f64>() - truth.acceleration,
        )
        .collect()
    }

    /// Lag of the position in ticks, on a motion of constant velocity.
    #[must_use]
    pub fn response_lag_x(&self) -> f64 {
        self.mean_now(|estimate, truth| {
            (truth.position - estimate.position.to_num::<f64>()) / truth.velocity
        })
    }

    /// Lag of the velocity in ticks, on a motion of constant acceleration.
    #[must_use]
    pub fn response_lag_v(&self) -> f64 {
        self.mean_now(|estimate, truth| {
            (truth.velocity - estimate.velocity.to_num::<f64>()) / truth.acceleration
        })
    }

    /// Lag of the acceleration in ticks, on a motion of constant `jerk` in d/tick³.
    #[must_use]
    pub fn response_lag_a(&self, jerk: f64) -> f64 {
        self.mean_now(|estimate, truth| {
            (truth.acceleration - estimate.acceleration.to_num::<f64>()) / jerk
        })
    }

    /// Mean over the ticks of a figure from the estimate and the truth at the sampling instant.
    #[must_use]
    pub fn mean_now(&self, figure: impl Fn(&Estimate, State) -> f64) -> f64 {
        let values: Vec<f64> = self.errors(|_| 0.0, figure).collect();
        values.iter().sum::<f64>() / values.len() as f64
    }

    fn errors(
        &self,
        lag: impl Fn(&Estimate) -> f64,
        error: impl Fn(&Estimate, State) -> f64,
    ) -> impl Iterator<Item = f64> {
        self.estimates
            .iter()
            .enumerate()
            .filter_map(move |(index, estimate)| {
                let truth = self.truth.before(self.warm_up + index, lag(estimate))?;
                Some(error(estimate, truth))
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_those_against_the_instant_of_the_estimate() {
        let trial = Trial {
            motion: Motion::Ramp {
                velocity: 10.0,
                acceleration: 0.5,
            },
            encoder: EncoderModel::ideal(),
            tick_hz: 1000.0,
            ticks: 300,
            errors: EdgeErrors::default(),
            seed: 1,
        };
        let simple = EstimatorConfig::by_name("simple").ok().flatten();
        let observed = trial
            .observe(simple.expect("an estimator"))
            .expect("in range");
        assert_eq!(observed.estimates.len(), 300);
        // Against the instant of the sample it would be 0.5 d/tick² times a lag of 7.5 ticks.
        assert!(observed.velocity_error().rms() < 0.1);
        assert!((observed.response_lag_v() - 7.5).abs() < 0.1);
    }
}
