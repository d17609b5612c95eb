//! The observer at a steady density of edges as linear equations, for the margins of the loop around it.
#![expect(
    clippy::arithmetic_side_effects,
    reason = "complex numbers of floats, which cannot overflow into a panic"
)]

use super::Model;
use super::config::Config;
use super::design::{Dynamics, MEAN_AGE, Matrix};
use super::gains::Gains;
use crate::tuning::complex::Complex;
use crate::units::Velocity;

/// s₊ = F·s + g·u₋D, then s += K·(place − h·s), with s = (x, v, a, δ).
#[derive(Clone, Copy, Debug)]
pub struct Linear {
    gains: [f64; 4],
    stiffness: f64,
    damping: f64,
    full_velocity: f64,
    delay: u32,
}

/// h, at the mean age of an edge.
const MEASURED: [f64; 4] = [1.0, -MEAN_AGE, MEAN_AGE * MEAN_AGE / 2.0, 0.0];

impl Config {
    /// The equations with those of the `gains` solved for it that are for 2^`octave` edges a tick, by `model`.
    #[must_use]
    pub fn linear(&self, gains: &Gains, model: Model, octave: i32) -> Linear {
        let [stiffness, damping] = match model {
            Model::Drive => self.jerk_coefficients(),
            Model::Kinematic => [0.0; 2],
        };
        let full = libm::ldexp(
            f64::from(self.response.full_velocity),
            Velocity::FRAC_NBITS.cast_signed().wrapping_neg(),
        );
        Linear {
            gains: gains.of(model, octave),
            stiffness,
            damping,
            full_velocity: full,
            delay: self.response.delay as u32,
        }
    }
}

impl Linear {
    /// Responses of x, v, a at `angle` rad/tick to the place that the edges give, per d, and to the command, per full
    /// command.
    #[must_use]
    pub fn at(&self, angle: f64) -> ([Complex; 3], [Complex; 3]) {
        let back = Complex::turned(-angle);
        let transition = self.transition();
        let mut matrix = [[Complex::ZERO; 6]; 4];
        let measured = |column: [f64; 4]| -> f64 {
            let products = MEASURED.iter().zip(column);
            products.map(|(weight, value)| weight * value).sum()
        };
        let jerk = self.stiffness * self.full_velocity;
        let input = [jerk / 6.0, jerk / 2.0, jerk, 0.0];
        let late = Complex::turned(-angle * (1.0 + f64::from(self.delay)));
        let seen_input = measured(input);
        // The rows of 1 − (1 − K·h)·F/z, and on the right what the command and the place put in.
        for (((row, line), gain), (place, input)) in matrix
            .iter_mut()
            .zip(&transition)
            .zip(self.gains)
            .zip(input.iter().enumerate())
        {
            for (column, cell) in row.iter_mut().enumerate().take(4) {
                let along = transition.map(|line| line.get(column).copied().unwrap_or(0.0));
                let own = line.get(column).copied().unwrap_or(0.0);
                let kept = own - gain * measured(along);
                let unit = if column == place { 1.0 } else { 0.0 };
                *cell = Complex::real(unit) - back.times(kept);
            }
            let [.., by_place, by_command] = row;
            *by_place = Complex::real(gain);
            *by_command = late.times(input - gain * seen_input);
        }
        solved(matrix)
    }

    /// F.
    fn transition(&self) -> Matrix {
        let dynamics = Dynamics {
            jerk: [0.0, -self.stiffness, -self.damping, 1.0],
            jerk_noise: 0.0,
            disturbance_noise: 0.0,
        };
        dynamics.transition()
    }
}

/// The solutions for the last two columns, by elimination with pivots.
fn solved(mut matrix: [[Complex; 6]; 4]) -> ([Complex; 3], [Complex; 3]) {
    for pivot in 0..4 {
        let cell = |matrix: &[[Complex; 6]; 4], row: usize| {
            matrix
                .get(row)
                .and_then(|row| row.get(pivot))
                .copied()
                .unwrap_or_default()
        };
        let largest = (pivot..4)
            .max_by(|one, other| {
                let (one, other) = (cell(&matrix, *one).size(), cell(&matrix, *other).size());
                one.total_cmp(&other)
            })
            .unwrap_or(pivot);
        matrix.swap(pivot, largest);
        let Some(line) = matrix.get(pivot).copied() else {
            break;
        };
        let head = cell(&matrix, pivot);
        let line = line.map(|value| value / head);
        for (place, row) in matrix.iter_mut().enumerate() {
            if place == pivot {
                *row = line;
            } else {
                let factor = row.get(pivot).copied().unwrap_or_default();
                for (value, part) in row.iter_mut().zip(line) {
                    *value = *value - factor * part;
                }
            }
        }
    }
    let [[.., xp, xu], [.., vp, vu], [.., ap, au], _] = matrix;
    ([xp, vp, ap], [xu, vu, au])
}
