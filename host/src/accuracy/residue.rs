//! What a map leaves.

use leadscrew::encoder_map::{Direction, EncoderMap};
use leadscrew_hal_mock::encoder::Encoder;

/// Harmonics of a revolution that are long waves.
const LONG_ORDERS: usize = 150;

/// What a map leaves at each edge, forward and backward, d: all of it, and its long waves.
#[derive(Clone, Debug)]
pub struct Residue {
    /// Where the edge really lies from its boundary.
    pub truth: [Vec<f64>; 2],
    /// Where the map says it lies.
    pub map: [Vec<f64>; 2],
    /// Long waves of the map less the truth.
    pub long: [Vec<f64>; 2],
}

impl Residue {
    /// Of `map` on `encoder`, whose edge 0 is that of the map.
    pub fn new(encoder: &Encoder, map: &EncoderMap<'_>) -> Self {
        let edges = encoder.edges();
        let truth = [false, true].map(|backward| {
            let error = |edge| encoder.placement_error(edge, backward);
            (0..edges).map(error).collect::<Vec<_>>()
        });
        let map = [Direction::Forward, Direction::Backward].map(|direction| {
            let error = |edge| f64::from(map.error(edge as u32, direction)) / 65_536.0;
            (0..edges).map(error).collect::<Vec<_>>()
        });
        let long = [0, 1].map(|way| {
            let left: Vec<f64> = map[way]
                .iter()
                .zip(&truth[way])
                .map(|(map, truth)| map - truth)
                .collect();
            long_waves(&left)
        });
        Self { truth, map, long }
    }
}

/// The mean and the harmonics up to [`LONG_ORDERS`] of a revolution.
fn long_waves(values: &[f64]) -> Vec<f64> {
    let edges = values.len();
    let turn = std::f64::consts::TAU / edges as f64;
    let cosines: Vec<f64> = (0..edges).map(|edge| (turn * edge as f64).cos()).collect();
    let sines: Vec<f64> = (0..edges).map(|edge| (turn * edge as f64).sin()).collect();
    let mean = values.iter().sum::<f64>() / edges as f64;
    let mut waves = vec![mean; edges];
    for order in 1..=LONG_ORDERS.min(edges / 2 - 1) {
        let angles = || {
            (0..edges).scan(0, |angle, _| {
                let at = *angle;
                *angle = (at + order) % edges;
                Some(at)
            })
        };
        let (mut cosine, mut sine) = (0.0, 0.0);
        for (value, angle) in values.iter().zip(angles()) {
            cosine += value * cosines[angle];
            sine += value * sines[angle];
        }
        let scale = 2.0 / edges as f64;
        for (wave, angle) in waves.iter_mut().zip(angles()) {
            *wave += scale * (cosine * cosines[angle] + sine * sines[angle]);
        }
    }
    waves
}

#[cfg(test)]
mod tests {
    use super::long_waves;

    #[test]
    fn long_waves_are_kept_and_short_ones_go() {
        let wave =
            |order: f64, edge: usize| (order * edge as f64 * std::f64::consts::TAU / 1000.0).sin();
        let values: Vec<f64> = (0..1000)
            .map(|edge| 0.5 + wave(3.0, edge) + wave(200.0, edge))
            .collect();
        for (edge, found) in long_waves(&values).into_iter().enumerate() {
            assert!((found - 0.5 - wave(3.0, edge)).abs() < 1e-9);
        }
    }
}
