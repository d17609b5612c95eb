//! Maps learned from simulated runs and recordings, used on other runs of the same encoder and of others.

mod edges;
mod fit;
mod recordings;

use leadscrew::encoder_map::{Direction, EncoderMap};
use leadscrew_hal_mock::encoder::Encoder;

/// Map less truth of all edges in a direction, the constant taken out, d rms.
fn residual(map: &EncoderMap<'_>, encoder: &Encoder, direction: Direction) -> f64 {
    let backward = direction == Direction::Backward;
    let off: Vec<f64> = (0..encoder.edges())
        .map(|edge| {
            let mapped = f64::from(map.error(edge as u32, direction)) / 65_536.0;
            mapped - encoder.placement_error(edge, backward)
        })
        .collect();
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    let squares: f64 = off.iter().map(|off| (off - mean).powi(2)).sum();
    (squares / off.len() as f64).sqrt()
}
