//! What long waves of an encoder could do to a fit.

use crate::identification::drive::{PARAMETERS, Vector};
use crate::identification::matrix::Matrix;
use crate::identification::recorder::Records;

/// Lengths of the waves of an encoder that are thought of, of the travel.
const WAVES: [f64; 4] = [0.35, 0.7, 1.4, 2.8];

/// An encoder has two long waves: one a revolution from its eccentricity, and the second harmonic.
const SHARE_OF_WAVES: f64 = 2.0 / WAVES.len() as f64;

/// What long waves of the encoder do to the parameters. Every chunk passes over the same ones, so neither clusters nor
/// chunks show them; they are taken to have the variance of the errors that are left.
pub struct Waves<'r> {
    records: Records<'r>,
    index: usize,
    position: f64,
    length: f64,
    scores: [[Vector; 2]; WAVES.len()],
}

impl<'r> Waves<'r> {
    pub fn new(records: Records<'r>) -> Self {
        let (mut position, mut low, mut high) = (0.0_f64, 0.0_f64, 0.0_f64);
        for record in records.iter() {
            position += record.travel_d;
            low = low.min(position);
            high = high.max(position);
        }
        Self {
            records,
            index: 0,
            position: 0.0,
            length: (high - low).max(1.0),
            scores: [[[0.0; PARAMETERS]; 2]; WAVES.len()],
        }
    }

    /// Takes the slopes of the next record.
    pub fn add(&mut self, slopes: &Vector) {
        let record = self.records.get(self.index).unwrap_or_default();
        self.position += record.travel_d;
        self.index = self.index.wrapping_add(1);
        for (share, [sine, cosine]) in WAVES.iter().zip(&mut self.scores) {
            let angle = core::f64::consts::TAU * self.position / (share * self.length);
            let (s, c) = libm::sincos(angle);
            for ((sine, cosine), slope) in sine.iter_mut().zip(cosine).zip(slopes) {
                *sine += s * slope;
                *cosine += c * slope;
            }
        }
    }

    pub fn covariance(&self, inverse: &Matrix, variance: f64) -> Matrix {
        let mut covariance = Matrix::ZERO;
        for score in self.scores.iter().flatten() {
            let moved = inverse.apply(score);
            covariance.add_product(&moved, &moved, variance * SHARE_OF_WAVES);
        }
        covariance
    }
}
