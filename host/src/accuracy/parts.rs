//! Where an error comes from: the same fit in `f64`, on each part of the samples' errors.
//!
//! A least-squares fit is linear in the places of its samples, so it is taken of each [part](super::anatomy) by itself: what
//! comes of the motion, less the truth, is the bias of the fit. What the core's estimate differs by from the sum of all is
//! its fixed point. Where the samples do not reach over a regular window, or the last one is old, rules for silence and
//! rest take the place of the fit: there the error is not taken apart.

use std::collections::VecDeque;

use leadscrew::capture::Observation;
use leadscrew::estimator::Estimate;
use serde::Serialize;

use super::anatomy::{Anatomy, LONG, MOTION, PARTS, SHORT, Sample, TIMER, WHITE};
use super::columns::{Column, Quantity};
use crate::statistics::Spread;
use crate::truth::TruthTrack;

/// Rms of each part of an error; their squares add up to about that of the whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Parts {
    /// Noise that does not repeat, of place and time.
    pub white: f64,
    /// What the map leaves of waves shorter than 67 d.
    pub short_wave: f64,
    /// What the map leaves of the harmonics up to the 150th.
    pub long_wave: f64,
    /// Rounding of the time stamps.
    pub timer: f64,
    /// Fixed point.
    pub fixed_point: f64,
    /// Bias of a quadratic on this motion.
    pub bias: f64,
    /// All of the error in ticks in which the window is stretched or the edges are silent.
    pub low_speed: f64,
}

/// The core's window in `f64`, and what came of it.
#[derive(Clone, Debug)]
pub struct Dissection {
    column: Column,
    samples: VecDeque<Sample>,
    spreads: [Spread; PARTS],
    fixed_point: Spread,
    low_speed: Spread,
    ticks: u64,
}

/// Fewest samples of a quadratic, and the widest window, ticks: those of the core.
const MIN_SAMPLES: usize = 4;
const WIDEST_TICKS: f64 = 64.0;
/// Largest weight of a sample, the core's.
const MOST_WEIGHT: usize = 4;
/// Ticks by which a window may be longer than set, and age of the newest sample, for the fit to be all there is.
const MOST_STRETCH: f64 = 4.0;
const LONGEST_SILENCE: f64 = 4.0;

impl Sample {
    /// Its time as the core holds it, in steps of half a tick.
    fn step(&self) -> f64 {
        (2.0 * self.time + 0.5).floor() / 2.0
    }
}

impl Dissection {
    /// Of the estimator of `column`.
    pub const fn new(column: Column) -> Self {
        Self {
            column,
            samples: VecDeque::new(),
            spreads: [Spread::NONE; PARTS],
            fixed_point: Spread::NONE,
            low_speed: Spread::NONE,
            ticks: 0,
        }
    }

    /// Takes a tick.
    pub fn note(
        &mut self,
        anatomy: &Anatomy<'_>,
        tick: usize,
        seen: &Observation<'_>,
        track: &TruthTrack,
    ) {
        if let Some(sample) = anatomy.sample(tick, seen, track) {
            self.samples.push_back(sample);
        }
        let age = |sample: &Sample| tick as f64 - sample.step();
        while let Some(oldest) = self.samples.front() {
            let limit = if self.samples.len() > MIN_SAMPLES {
                f64::from(self.column.window)
            } else {
                WIDEST_TICKS
            };
            if age(oldest) < limit {
                break;
            }
            self.samples.pop_front();
        }
    }

    /// Compares with what the core said in the tick noted last.
    pub fn compare(&mut self, tick: usize, estimate: &Estimate, track: &TruthTrack) {
        let (said, lag) = match self.column.quantity {
            Quantity::Velocity => (
                estimate.velocity.to_num::<f64>(),
                estimate.lags.velocity.to_num(),
            ),
            Quantity::Acceleration => (
                estimate.acceleration.to_num(),
                estimate.lags.acceleration.to_num(),
            ),
        };
        let Some(truth) = track.before(tick, lag) else {
            return;
        };
        let truth = match self.column.quantity {
            Quantity::Velocity => truth.velocity,
            Quantity::Acceleration => truth.acceleration,
        };
        self.ticks += 1;
        let now = tick as f64;
        let Some(found) = self.is_regular(now).then(|| self.fit(now - lag)) else {
            self.low_speed.push(said - truth);
            return;
        };
        for (part, (spread, found)) in self.spreads.iter_mut().zip(found).enumerate() {
            spread.push(if part == MOTION { found - truth } else { found });
        }
        self.fixed_point.push(said - found.iter().sum::<f64>());
    }

    /// Neither stretched nor silent.
    fn is_regular(&self, now: f64) -> bool {
        let age = |sample: &Sample| now - sample.time;
        let span = f64::from(self.column.window) + MOST_STRETCH;
        self.samples.len() >= MIN_SAMPLES
            && self
                .samples
                .front()
                .is_some_and(|oldest| age(oldest) <= span)
            && self
                .samples
                .back()
                .is_some_and(|newest| age(newest) <= LONGEST_SILENCE)
    }

    /// The quantity that the least-squares quadratic gives at an instant, for each part.
    fn fit(&self, instant: f64) -> [f64; PARTS] {
        let weigh = self.weights();
        let weighed = || self.samples.iter().map(|sample| (weigh(sample), sample));
        let count: f64 = weighed().map(|(weight, _)| weight).sum();
        let middle = weighed()
            .map(|(weight, sample)| weight * sample.time)
            .sum::<f64>()
            / count;
        let asked = instant - middle;
        // Orthogonal polynomials 1, z and z² − β·z − mean of z².
        let moment = |power: i32| {
            let powers =
                weighed().map(|(weight, sample)| weight * (sample.time - middle).powi(power));
            powers.sum::<f64>() / count
        };
        let (second, third) = (moment(2), moment(3));
        let skew = third / second;
        let bend = |time: f64| time * time - skew * time - second;
        let bends: f64 = weighed()
            .map(|(weight, sample)| weight * bend(sample.time - middle).powi(2))
            .sum();
        let start = self
            .samples
            .front()
            .map_or(0.0, |sample| sample.parts[MOTION]);
        let mut found = [0.0; PARTS];
        for (weight, sample) in weighed() {
            let time = sample.time - middle;
            let curvature = bend(time) / bends;
            let slope = time / (count * second);
            let gain = weight
                * match self.column.quantity {
                    Quantity::Acceleration => 2.0 * curvature,
                    Quantity::Velocity => slope + curvature * (2.0 * asked - skew),
                };
            for (part, (found, of)) in found.iter_mut().zip(sample.parts).enumerate() {
                *found += gain * if part == MOTION { of - start } else { of };
            }
        }
        found
    }

    /// The weight of a sample: of samples one a tick, all alike; elsewhere its edges, as far as that matters.
    fn weights(&self) -> fn(&Sample) -> f64 {
        let steps = || self.samples.iter().map(Sample::step);
        let is_even = steps()
            .zip(steps().skip(1))
            .all(|(one, next)| next - one == 1.0);
        if is_even && self.samples.len() == self.column.window as usize {
            |_| 1.0
        } else {
            |sample| sample.edges.min(MOST_WEIGHT) as f64
        }
    }

    /// Rms of each part over all ticks.
    pub fn parts(&self) -> Parts {
        let rms =
            |spread: &Spread| spread.rms() * (spread.count() as f64 / self.ticks as f64).sqrt();
        let of = |part: usize| rms(&self.spreads[part]);
        Parts {
            white: of(WHITE),
            short_wave: of(SHORT),
            long_wave: of(LONG),
            timer: of(TIMER),
            fixed_point: rms(&self.fixed_point),
            bias: of(MOTION),
            low_speed: rms(&self.low_speed),
        }
    }
}
