//! Gain and phase margin of the loop, broken at the drive's input.
//!
//! L = S·A·P/(1 + S·Σcᵢz⁻ⁱ + S·B) at z = e^(iθ): P is the drive and shaft under a held command with its delay, A the feedback
//! part on what the estimator makes of the shaft, B the feedback part on what an observer makes of the command, S the filter
//! sections, cᵢ the taps of the prediction. The hold, the sampling and every lag are exact in it; the encoder's
//! quantisation is not in it.
//!
//! The gain margin is how much more, and the gain reserve how much less, gain the loop takes: it has two integrators
//! and may oscillate at too low a gain as well. Crossings count; that the loop is stable at all is for
//! [`check`](super::check) to show.
#![expect(
    clippy::arithmetic_side_effects,
    reason = "complex numbers of floats, which cannot overflow into a panic"
)]

use core::f64::consts::PI;

use super::complex::Complex;
use super::model::DriveModel;
use super::plant::Plant;
use super::sensing::{Seen, Sensing};
use crate::controller::biquad::Section;
use crate::controller::params::{Feedback, LawParams};
use crate::estimator::paths::{Choice, Config as Estimators, PositionFeedback};
use crate::params::{AxisParams, ParamError};
use crate::units::AxisScale;

/// How far a loop is from instability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins {
    /// Factor of gain at which it begins to oscillate, dB; infinite if at none.
    pub gain_db: f64,
    /// Factor of gain below one at which it begins to oscillate, dB, positive; infinite if at none.
    pub reserve_db: f64,
    /// Lag that it takes at the frequencies of gain 1, degrees.
    pub phase_deg: f64,
    /// Highest frequency of gain 1, rad/tick.
    pub crossover: f64,
}

impl Margins {
    /// No limit at all.
    pub const WIDEST: Self = Self {
        gain_db: f64::INFINITY,
        reserve_db: f64::INFINITY,
        phase_deg: 180.0,
        crossover: 0.0,
    };

    /// The smaller of both in each.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        Self {
            gain_db: self.gain_db.min(other.gain_db),
            reserve_db: self.reserve_db.min(other.reserve_db),
            phase_deg: self.phase_deg.min(other.phase_deg),
            crossover: self.crossover.max(other.crossover),
        }
    }

    /// Takes in the way of the loop's response from `before` at `from` to `after` at `to`, rad/tick.
    fn pass(&mut self, before: Complex, after: Complex, from: f64, to: f64) {
        let crosses_axis = before.im * after.im <= 0.0 && before.im != after.im;
        if crosses_axis {
            let share = before.im / (before.im - after.im);
            let place = before.re + share * (after.re - before.re);
            if place < 0.0 {
                let db = -20.0 * libm::log10(-place);
                if db >= 0.0 {
                    self.gain_db = self.gain_db.min(db);
                } else {
                    self.reserve_db = self.reserve_db.min(-db);
                }
            }
        }
        let (inner, outer) = (before.size() - 1.0, after.size() - 1.0);
        if inner * outer <= 0.0 && inner != outer {
            let share = inner / (inner - outer);
            let (re, im) = (
                before.re + share * (after.re - before.re),
                before.im + share * (after.im - before.im),
            );
            let lag = (libm::atan2(im, re).abs() - PI).abs();
            self.phase_deg = self.phase_deg.min(lag * 180.0 / PI);
            self.crossover = self.crossover.max(from + share * (to - from));
        }
    }
}

/// A loop to be judged: the feedback part of an axis and its estimators; the drive comes with each question.
#[derive(Clone, Debug)]
pub struct Loop {
    feedback: Feedback,
    position: PositionFeedback,
    sensing: [Sensing; 2],
    scale: AxisScale,
}

/// Frequencies that are looked at, rad/tick.
const LOWEST: f64 = 1e-3;
/// How many.
const FREQUENCIES: u32 = 320;

impl Loop {
    /// The loop of `params` in motion, its estimators counting on 2^`octave` edges a tick.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(params: &AxisParams, octave: i32) -> Result<Self, ParamError> {
        let scale = AxisScale::new(params.motion.counts_per_mm, params.tick_hz)?;
        let full = scale.velocity_from_feed(params.motion.full_command_feed_mm_per_min)?;
        let law = LawParams {
            controller: &params.controller,
            filter: &params.filter,
            friction: &params.friction,
            calm: &params.calm,
        };
        let estimators = Estimators::new(params.estimator, params.second_estimator, params.paths)?;
        let gains = estimators.gains();
        let sensing = |choice: Choice| Sensing::new(estimators.of(choice), &gains, octave);
        Ok(Self {
            feedback: law.feedback(scale, full)?,
            position: params.paths.position,
            sensing: [
                sensing(params.paths.velocity)?,
                sensing(params.paths.acceleration)?,
            ],
            scale,
        })
    }

    /// Margins on `drive`, which need not be that which the loop was tuned on.
    ///
    /// # Errors
    /// A figure of the drive out of range.
    pub fn margins(&self, drive: &DriveModel) -> Result<Margins, ParamError> {
        let rate = self.scale.tick_hz();
        let full = self
            .scale
            .velocity_from_feed(drive.full_command_feed_mm_per_min)?;
        let plant = Plant::with_period(drive.natural_period_s * rate, drive.damping, full);
        let delay = drive.delay_s * rate;
        let step = libm::pow(PI / LOWEST, 1.0 / f64::from(FREQUENCIES));
        let mut margins = Margins::WIDEST;
        let mut from = LOWEST;
        let mut before = self.at(&plant, delay, from);
        for _ in 0..FREQUENCIES {
            let to = (from * step).min(PI);
            let after = self.at(&plant, delay, to);
            margins.pass(before, after, from, to);
            (from, before) = (to, after);
        }
        Ok(margins)
    }

    /// L at `angle` rad/tick.
    fn at(&self, plant: &Plant, delay: f64, angle: f64) -> Complex {
        let back = Complex::turned(-angle);
        let gains = &self.feedback.gains;
        let [velocity, acceleration] = self.sensing.each_ref().map(|sensing| sensing.at(angle));
        let change = Complex::ONE - back;
        let on_error = Complex::real(gains.position)
            + Complex::real(gains.integral) / change
            + change.times(gains.derivative);
        let part = |pick: fn(&Seen) -> &[Complex; 3], place: Complex| {
            let ([x, v, _], [_, _, a]) = (*pick(&velocity), *pick(&acceleration));
            let x = match self.position {
                PositionFeedback::Count => place,
                PositionFeedback::Estimate => x,
            };
            on_error * x + v.times(gains.velocity) + a.times(gains.acceleration)
        };
        let of_shaft = part(|seen| &seen.of_shaft, Complex::ONE);
        let of_command = part(|seen| &seen.of_command, Complex::ZERO);
        let mut taps = Complex::ZERO;
        let mut turn = back;
        for tap in self.feedback.taps {
            taps = taps + turn.times(tap);
            turn = turn * back;
        }
        let sections = self.feedback.sections.iter().flatten();
        let filter = sections.fold(Complex::ONE, |all, section| all * response(section, back));
        let loop_gain = filter * of_shaft * plant.response(angle, delay);
        loop_gain / (Complex::ONE + filter * (taps + of_command))
    }
}

/// A section's response; `back` is z⁻¹.
fn response(section: &Section, back: Complex) -> Complex {
    let ([b0, b1, b2], [a1, a2]) = section.coefficients();
    let square = back * back;
    let over = Complex::real(b0) + back.times(b1) + square.times(b2);
    over / (Complex::ONE + back.times(a1) + square.times(a2))
}

impl Plant {
    /// Position for full command at `angle` rad/tick, `delay` ticks late.
    #[must_use]
    pub fn response(&self, angle: f64, delay: f64) -> Complex {
        let turn = Complex::turned(angle);
        let [[_, xv, xa], [_, vv, va], [_, av, aa]] = self.transition;
        let [gx, gv, ga] = self.input;
        // The two rows of v and a, then x.
        let (one, four) = (turn - Complex::real(vv), turn - Complex::real(aa));
        let whole = one * four - Complex::real(va * av);
        let v = (four.times(gv) + Complex::real(va * ga)) / whole;
        let a = (one.times(ga) + Complex::real(av * gv)) / whole;
        let x = (v.times(xv) + a.times(xa) + Complex::real(gx)) / (turn - Complex::ONE);
        x * Complex::turned(-angle * delay)
    }
}
