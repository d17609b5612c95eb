//! With the true map of its disc the simulator's edges lie where the shaft was.

use leadscrew::capture::Unwrapper;
use leadscrew::edges::{EdgeConfig, EdgeReader};
use leadscrew::encoder_map::tie::MapState;
use leadscrew::encoder_map::{EncoderMap, Form};
use leadscrew::hal::Capture;
use leadscrew::uncertainty::EdgeErrors;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::{Motion, Scene};

use crate::content::Errors;

const TICK_HZ: f64 = 1000.0;
const REVOLUTION_D: f64 = 10_000.0;

/// Places of the edges less where the shaft was, over one revolution after the index.
fn errors(image: &[u8], velocity: f64, one_stamp: bool) -> Vec<f64> {
    let model = EncoderModel::real();
    let motion = Motion::Steady { velocity };
    let mut scene = Scene::new(motion, &model, TICK_HZ, -10.0 * velocity, 1).unwrap();
    let scale = EdgeConfig::new(TICK_HZ, model.encoder.timer_hz, &EdgeErrors::default()).unwrap();
    let map = EncoderMap::from_bytes(image).unwrap();
    let mut reader = EdgeReader::new(scale).with_map(map);
    let mut unwrapper = Unwrapper::new();
    let mut errors = Vec::new();
    let ticks = 12 + (REVOLUTION_D / velocity.abs()) as u32;
    for tick in 0..ticks {
        scene.step();
        let mut capture = scene.capture();
        if one_stamp {
            capture = Capture {
                edges: [&[], &[]],
                ..capture
            };
        }
        let observation = unwrapper.unwrap(&capture);
        reader.note(&observation);
        if tick < 12 {
            continue;
        }
        let sample = reader.sample(&observation).expect("every tick has edges");
        let then = scene.truth().position - velocity * sample.age.to_num::<f64>();
        errors.push(sample.position.to_num::<f64>() - then);
    }
    let found = map.form() != Form::Phases;
    assert_eq!(reader.map_state() == Some(MapState::Tied), found);
    errors
}

fn mean_and_sigma(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, (squares / count).sqrt())
}

/// What noise and the steps of the bytes leave of a mean over `edges`.
fn noise_d(velocity: f64, edges: f64) -> f64 {
    let model = EncoderModel::real().encoder;
    let timed = model.noise_s * velocity * TICK_HZ;
    let clock = velocity * TICK_HZ / model.timer_hz;
    let step = 1.0 / 256.0;
    let variance = model.noise_d.powi(2) + timed.powi(2) + (clock.powi(2) + step * step) / 12.0;
    (variance / edges).sqrt()
}

#[test]
fn what_is_left_of_the_encoders_errors_is_noise() {
    let image = Errors::true_of(&EncoderModel::real(), 1).encode(Form::Full);
    let mut means = Vec::new();
    for velocity in [5.0, -5.0, 150.0, -150.0] {
        for one_stamp in [false, true] {
            let (mean, sigma) = mean_and_sigma(&errors(&image, velocity, one_stamp));
            let edges = if one_stamp { 1.0 } else { velocity.abs() };
            let expected = noise_d(velocity.abs(), edges);
            let ratio = sigma / expected;
            assert!(
                (0.75..1.25).contains(&ratio),
                "{velocity}, {one_stamp}: {sigma} for {expected}"
            );
            means.push(mean);
        }
    }
    // A constant is left, the same in both directions: the map is 0 at edge 0.
    let (_, spread) = mean_and_sigma(&means);
    assert!(spread < 0.002, "{means:?}");
}

#[test]
fn without_the_index_the_phases_take_their_share() {
    let errors_of_disc = Errors::true_of(&EncoderModel::real(), 1);
    let phases = errors_of_disc.encode(Form::Phases);
    let none = Errors {
        phases: [[0; 4]; 2],
        ..errors_of_disc.clone()
    }
    .encode(Form::Phases);
    // Short waves only: one tick against the next.
    let short = |image: &[u8], velocity: f64| {
        let errors = errors(image, velocity, true);
        let steps: Vec<f64> = errors.windows(2).map(|pair| pair[1] - pair[0]).collect();
        mean_and_sigma(&steps).1 / 2.0_f64.sqrt()
    };
    for (velocity, phases_d) in [
        (5.0, errors_of_disc.phases[0]),
        (-5.0, errors_of_disc.phases[1]),
    ] {
        let (with, without) = (short(&phases, velocity), short(&none, velocity));
        // Lines 0.10 d and edges 0.03 d stay.
        assert!((0.09..0.12).contains(&with), "{velocity}: {with}");
        // Five edges on is the next phase.
        let steps = (0..4).map(|phase| phases_d[(phase + 1) % 4] - phases_d[phase]);
        let share = steps
            .map(|step| (f64::from(step) / 65536.0).powi(2))
            .sum::<f64>()
            / 8.0;
        let taken = without.powi(2) - with.powi(2);
        assert!(
            (0.6..1.4).contains(&(taken / share)),
            "{velocity}: {taken} of {share}"
        );
    }
}
