//! Responses by Fourier sums at chosen frequencies.

use std::f64::consts::TAU;

use super::Chirp;

/// Half the width of the band that a point is the mean of, as a share of its frequency.
const BAND: f64 = 0.06;

/// What was put out and what came of it, tick by tick.
pub(super) struct Records {
    /// Commands, shares of full command.
    pub command: Vec<f64>,
    /// Mean velocity while each was held, d/tick.
    pub velocity: Vec<f64>,
    /// What the program added.
    pub added: Vec<f64>,
}

/// A response at a frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// The frequency, Hz.
    pub hz: f64,
    /// Its size, 1.
    pub gain: f64,
    /// Its phase, degrees, without jumps from point to point.
    pub phase_deg: f64,
    /// Coherence: 1 where all of the output comes from the input.
    pub coherence: f64,
}

impl Point {
    /// The gain in decibel.
    #[must_use]
    pub fn gain_db(&self) -> f64 {
        20.0 * self.gain.log10()
    }
}

#[derive(Clone, Copy, Default)]
struct Complex {
    re: f64,
    im: f64,
}

impl Complex {
    fn times_conjugate(self, other: Self) -> Self {
        Self {
            re: self.re * other.re + self.im * other.im,
            im: self.im * other.re - self.re * other.im,
        }
    }

    fn square(self) -> f64 {
        self.re * self.re + self.im * self.im
    }

    fn add(&mut self, other: Self) {
        self.re += other.re;
        self.im += other.im;
    }
}

/// The response from `input` to `output` at frequencies spread evenly over the decades of a chirp.
pub(super) fn points(chirp: &Chirp, tick_hz: f64, input: &[f64], output: &[f64]) -> Vec<Point> {
    let (input, output) = (without_mean(input), without_mean(output));
    let (from, to) = chirp.hz;
    let count = chirp.points.max(2);
    let ratio = (to / from).powf(1.0 / (count - 1) as f64);
    let mut last = 0.0;
    (0..count)
        .map(|index| {
            let hz = from * ratio.powi(index as i32);
            let mut point = response(hz, tick_hz, &input, &output);
            // The way round that is nearest to the point before.
            point.phase_deg -= 360.0 * ((point.phase_deg - last) / 360.0).round();
            last = point.phase_deg;
            point
        })
        .collect()
}

/// Cross and own spectra over a band.
fn response(hz: f64, tick_hz: f64, input: &[f64], output: &[f64]) -> Point {
    let step = tick_hz / input.len() as f64;
    let bin = hz / step;
    let half = (BAND * bin).max(1.0);
    let (low, high) = ((bin - half).round().max(1.0), (bin + half).round());
    let mut cross = Complex::default();
    let (mut of_input, mut of_output) = (0.0, 0.0);
    let mut at = low;
    while at <= high {
        let turn = at / input.len() as f64;
        let (u, y) = (sum(input, turn), sum(output, turn));
        cross.add(y.times_conjugate(u));
        of_input += u.square();
        of_output += y.square();
        at += 1.0;
    }
    Point {
        hz,
        gain: cross.square().sqrt() / of_input,
        phase_deg: cross.im.atan2(cross.re).to_degrees(),
        coherence: cross.square() / (of_input * of_output),
    }
}

/// The Fourier sum at so many cycles a tick.
fn sum(values: &[f64], turn: f64) -> Complex {
    let mut total = Complex::default();
    for (tick, value) in values.iter().enumerate() {
        let (sine, cosine) = (TAU * (turn * tick as f64).fract()).sin_cos();
        total.re += value * cosine;
        total.im -= value * sine;
    }
    total
}

fn without_mean(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.iter().map(|value| value - mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_delay_and_a_gain_are_found() {
        let chirp = Chirp {
            hz: (2.0, 100.0),
            seconds: 4.0,
            amplitude: 0.1,
            centre: 0.2,
            points: 12,
        };
        let length = 5000;
        let input: Vec<f64> = (0..length)
            .map(|tick| {
                let time = (f64::from(tick) - 500.0) / 1000.0;
                let phase = TAU * (2.0 * time + 0.5 * 98.0 / 4.0 * time * time);
                if (0.0..4.0).contains(&time) {
                    phase.sin()
                } else {
                    0.0
                }
            })
            .collect();
        let mut output = vec![0.0; 3];
        output.extend(input.iter().map(|value| 0.5 * value));
        output.truncate(input.len());
        for point in points(&chirp, 1000.0, &input, &output) {
            assert!((point.gain - 0.5).abs() < 1e-3, "{point:?}");
            let expected = -360.0 * point.hz * 0.003;
            // At the ends of the chirp half of what is averaged over is not excited: such a point is that of a frequency
            // a few Hz further in.
            let is_inner = point.hz > 2.5 && point.hz < 99.0;
            let allowed = if is_inner { 1.0 } else { 5.0 };
            assert!((point.phase_deg - expected).abs() < allowed, "{point:?}");
            assert!(point.coherence > 0.99, "{point:?}");
        }
    }
}
