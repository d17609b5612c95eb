//! A learned map against the truth.

use leadscrew::capture::Unwrapper;
use leadscrew::edges::{EdgeConfig, EdgeReader};
use leadscrew::encoder_map::{Direction, EncoderMap};
use leadscrew::hal::Capture;
use leadscrew::uncertainty::EdgeErrors;
use leadscrew_hal_mock::encoder::{Encoder, EncoderModel};
use leadscrew_hal_mock::scene::{Motion, Scene};
use leadscrew_host::calibration::{Procedure, learn_simulated};

use crate::residual;

#[test]
fn the_map_of_the_real_encoder_is_within_a_hundredth_of_a_d() {
    let model = EncoderModel::real();
    let image = learn_simulated(&model, 3, &Procedure::default()).unwrap();
    let map = EncoderMap::from_bytes(&image).unwrap();
    let encoder = Encoder::new(&model, 1000.0, 0.0, 3).unwrap();
    for direction in [Direction::Forward, Direction::Backward] {
        let off = residual(&map, &encoder, direction);
        assert!(off < 0.002, "{direction:?}: {off}");
    }
    assert_eq!(map.front(Direction::Forward), Some(0));
    assert_eq!(map.front(Direction::Backward), Some(2));
}

/// Standard deviation of where single edges are said to lie against where the shaft was, over a revolution.
fn edge_sigma(map: Option<EncoderMap<'_>>, model: &EncoderModel, velocity: f64) -> f64 {
    let start = -10.0 * velocity;
    let mut scene = Scene::new(Motion::Steady { velocity }, model, 1000.0, start, 3).unwrap();
    let scale = EdgeConfig::new(1000.0, model.encoder.timer_hz, &EdgeErrors::default()).unwrap();
    let mut reader = EdgeReader::new(scale);
    reader.set_map(map);
    let mut unwrapper = Unwrapper::new();
    let mut errors = Vec::new();
    for tick in 0..12 + (10_000.0 / velocity.abs()) as u32 {
        scene.step();
        // The last edge alone: no mean over those of a tick.
        let capture = Capture {
            edges: [&[], &[]],
            ..scene.capture()
        };
        let observation = unwrapper.unwrap(&capture);
        reader.note(&observation);
        if tick >= 12 {
            let sample = reader.sample(&observation).unwrap();
            let then = scene.truth().position - velocity * sample.age.to_num::<f64>();
            errors.push(sample.position.to_num::<f64>() - then);
        }
    }
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let squares: f64 = errors.iter().map(|error| (error - mean).powi(2)).sum();
    (squares / errors.len() as f64).sqrt()
}

#[test]
fn edges_of_other_runs_lie_where_the_learned_map_says() {
    let model = EncoderModel::real();
    let image = learn_simulated(&model, 3, &Procedure::default()).unwrap();
    let map = EncoderMap::from_bytes(&image).unwrap();
    for velocity in [150.0, -150.0, 21.7, -21.7, 3.3, -3.3] {
        let (without, with) = (
            edge_sigma(None, &model, velocity),
            edge_sigma(Some(map), &model, velocity),
        );
        // Noise of place and time, the step of the timer.
        let noise: f64 = 0.005_f64
            .hypot(velocity * 2e-5)
            .hypot(velocity / 84_000.0 / 3.46);
        assert!(without > 0.9, "{velocity}: {without}");
        assert!(with < 0.01_f64.hypot(noise), "{velocity}: {with}");
    }
}
