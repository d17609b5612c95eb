//! A map learned from simulated runs, used on others of the same encoder.

use leadscrew::encoder_map::{Direction, EncoderMap};
use leadscrew_hal_mock::encoder::{Encoder, EncoderModel};
use leadscrew_host::calibration::{Procedure, learn_simulated};

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

#[test]
fn the_map_of_the_real_encoder_is_within_a_hundredth_of_a_d() {
    let model = EncoderModel::real();
    let image = learn_simulated(&model, 3, &Procedure::default()).unwrap();
    let map = EncoderMap::from_bytes(&image).unwrap();
    let encoder = Encoder::new(&model, 1000.0, 0.0, 3).unwrap();
    for direction in [Direction::Forward, Direction::Backward] {
        let off = residual(&map, &encoder, direction);
        println!("{direction:?}: {off}");
        assert!(off < 0.002, "{direction:?}: {off}");
    }
    assert_eq!(map.front(Direction::Forward), Some(0));
    assert_eq!(map.front(Direction::Backward), Some(2));
}
