//! What an estimator makes of the shaft's motion, by frequency: position, velocity and acceleration that it gives for a
//! swing of the shaft, and for one of the command where it knows that.
//!
//! Estimators that weigh counts: the impulse response, by running the estimator itself. The polynomial: the weights of its
//! least squares over samples one a tick. The observer: its steady-state equations at a density of edges, the command included.
#![expect(
    clippy::arithmetic_side_effects,
    reason = "complex numbers of floats, which cannot overflow into a panic"
)]

use super::complex::Complex;
use crate::capture::Unwrapper;
use crate::edges::{EdgeConfig, EdgeReader};
use crate::estimator::observer::{Gains, Model};
use crate::estimator::{Estimator, EstimatorConfig, Evidence, observer, polynomial};
use crate::hal::Capture;
use crate::uncertainty::EdgeErrors;
use crate::units::RangeError;

/// Ticks of an impulse response.
const RESPONSE_TICKS: usize = 128;
/// Counts of the step that an impulse response is taken from.
const STEP: u32 = 512;

/// Responses of x̂, v̂, â to the shaft's position and to the command.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    /// For 1 d of the shaft.
    pub of_shaft: [Complex; 3],
    /// For full command.
    pub of_command: [Complex; 3],
}

/// An estimator's linear model.
#[derive(Clone, Debug)]
pub enum Sensing {
    /// Impulse responses of x̂, v̂, â for counts.
    Counts([[f64; RESPONSE_TICKS]; 3]),
    /// Weights of x̂, v̂, â for samples half a tick old and older.
    Samples([[f64; RESPONSE_TICKS]; 3]),
    /// The observer's equations.
    Observer(observer::Linear),
}

impl Sensing {
    /// The model of `config`; `octave` is log₂ of the edges in a tick that an observer counts on, whose `gains` they are.
    ///
    /// # Errors
    /// None with estimators that have been configured.
    pub fn new(config: &EstimatorConfig, gains: &Gains, octave: i32) -> Result<Self, RangeError> {
        match config {
            EstimatorConfig::Observer(config) => {
                Ok(Self::Observer(config.linear(gains, Model::Drive, octave)))
            }
            EstimatorConfig::Polynomial(config) => Ok(Self::Samples(least_squares(config))),
            other => Ok(Self::Counts(impulse(*other)?)),
        }
    }

    /// What it makes of a swing of `angle` rad/tick.
    #[must_use]
    pub fn at(&self, angle: f64) -> Seen {
        match self {
            Self::Counts(weights) => Seen {
                of_shaft: weights.each_ref().map(|weights| sum(weights, angle)),
                ..Seen::default()
            },
            Self::Samples(weights) => {
                let sampled = mean_of_tick(angle);
                Seen {
                    of_shaft: weights
                        .each_ref()
                        .map(|weights| sum(weights, angle) * sampled),
                    ..Seen::default()
                }
            }
            Self::Observer(linear) => {
                let (of_place, of_command) = linear.at(angle);
                let sampled = mean_of_tick(angle);
                Seen {
                    of_shaft: of_place.map(|response| response * sampled),
                    of_command,
                }
            }
        }
    }
}

/// The mean place of the tick just past.
fn mean_of_tick(angle: f64) -> Complex {
    let half = angle / 2.0;
    let size = if half == 0.0 {
        1.0
    } else {
        libm::sin(half) / half
    };
    Complex::turned(-half).times(size)
}

fn sum(weights: &[f64; RESPONSE_TICKS], angle: f64) -> Complex {
    let back = Complex::turned(-angle);
    let (total, _) = weights
        .iter()
        .fold((Complex::ZERO, Complex::ONE), |(total, turn), weight| {
            (total + turn.times(*weight), turn * back)
        });
    total
}

/// Differences of what the estimator says of a step.
fn impulse(config: EstimatorConfig) -> Result<[[f64; RESPONSE_TICKS]; 3], RangeError> {
    let edges = EdgeReader::new(EdgeConfig::new(1000.0, 1e6, &EdgeErrors::default())?);
    let mut estimator = Estimator::new(config);
    let mut unwrapper = Unwrapper::new();
    let mut heard = |count: u32| {
        let capture = Capture {
            count,
            ..Capture::default()
        };
        let observation = unwrapper.unwrap(&capture);
        let estimate = estimator.update(&Evidence {
            observation: &observation,
            edges: &edges,
            sample: None,
            command: None,
        });
        [
            estimate.position.to_num::<f64>() - 0.5,
            estimate.velocity.to_num(),
            estimate.acceleration.to_num(),
        ]
    };
    let mut before = heard(0);
    let mut weights = [[0.0; RESPONSE_TICKS]; 3];
    for tick in 0..RESPONSE_TICKS {
        let now = heard(STEP);
        for ((weights, now), before) in weights.iter_mut().zip(now).zip(before) {
            if let Some(weight) = weights.get_mut(tick) {
                *weight = (now - before) / f64::from(STEP);
            }
        }
        before = now;
    }
    Ok(weights)
}

/// Weights of a quadratic through W samples: with z from their middle, x = m + s·z + c·z².
fn least_squares(config: &polynomial::Config) -> [[f64; RESPONSE_TICKS]; 3] {
    let samples = f64::from(config.window());
    let middle = (samples - 1.0) / 2.0;
    // Ages count from half a tick, so the newest instant lies half a tick beyond the first sample.
    let ahead = if config.answers_newest() {
        middle + 0.5
    } else {
        0.0
    };
    let place = |age: usize| middle - age as f64;
    let ages = 0..config.window() as usize;
    let second: f64 = ages.clone().map(|age| place(age) * place(age)).sum();
    let fourth: f64 = ages.clone().map(|age| libm::pow(place(age), 4.0)).sum();
    let mean_square = second / samples;
    let spread = fourth - second * mean_square;
    let mut weights = [[0.0; RESPONSE_TICKS]; 3];
    for age in ages {
        let z = place(age);
        let bend = (z * z - mean_square) / spread;
        let slope = z / second;
        let found = [
            1.0 / samples + slope * ahead + bend * (ahead * ahead - mean_square),
            slope + 2.0 * bend * ahead,
            2.0 * bend,
        ];
        for (weights, found) in weights.iter_mut().zip(found) {
            if let Some(weight) = weights.get_mut(age) {
                *weight = found;
            }
        }
    }
    weights
}
