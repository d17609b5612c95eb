//! A learned map against what the encoder is made of.

use leadscrew::calibration::Learned;
use leadscrew::encoder_map::Direction;

use crate::generator::Shaft;

/// Map less truth.
pub struct Off(Vec<f64>);

impl Off {
    /// In one direction, the constant taken out.
    pub fn new(learned: &Learned<'_>, shaft: &Shaft, direction: Direction) -> Self {
        let phases = learned.phases_d(direction);
        let backward = direction == Direction::Backward;
        let place = |edge: usize| {
            let hysteresis = if backward {
                shaft.hysteresis[edge % 2]
            } else {
                0.0
            };
            learned.error_d(edge) + phases[edge % 4] - (shaft.errors[edge] - hysteresis)
        };
        let off: Vec<f64> = (0..shaft.errors.len()).map(place).collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        Self(off.iter().map(|off| off - mean).collect())
    }

    /// d rms.
    pub fn rms(&self) -> f64 {
        (self.0.iter().map(|off| off * off).sum::<f64>() / self.0.len() as f64).sqrt()
    }

    /// Amplitude of a harmonic of the revolution, d.
    pub fn amplitude(&self, order: usize) -> f64 {
        let (mut cosine, mut sine) = (0.0, 0.0);
        for (edge, off) in self.0.iter().enumerate() {
            let phase = std::f64::consts::TAU * (order * edge) as f64 / self.0.len() as f64;
            cosine += off * phase.cos();
            sine += off * phase.sin();
        }
        2.0 * f64::hypot(cosine, sine) / self.0.len() as f64
    }

    /// Rms of the harmonics up to 32, differentiated so many times.
    pub fn harmonics(&self, derivative: i32) -> f64 {
        let squares: f64 = (1..=32)
            .map(|order| {
                let wave_number = std::f64::consts::TAU * order as f64 / self.0.len() as f64;
                (self.amplitude(order) * wave_number.powi(derivative)).powi(2) / 2.0
            })
            .sum();
        squares.sqrt()
    }
}
