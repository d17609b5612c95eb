//! Runs found in recordings of the simulated encoder.

use leadscrew::calibration::Requirements;
use leadscrew::encoder_map::check::Verdict;
use leadscrew::encoder_map::{Direction, EncoderMap, Form};
use leadscrew_hal_mock::disc::DiscParams;
use leadscrew_hal_mock::encoder::{Encoder, EncoderModel};
use leadscrew_hal_mock::scene::Motion;
use leadscrew_host::calibration::{self, Options, learn_from_recordings, map_fit};
use leadscrew_host::sampler::Sampler;
use leadscrew_host::sim_encoder::record;

use crate::residual;

/// Options of a small encoder whose runs are all taken.
fn options(model: &EncoderModel, motion: calibration::Motion) -> Options {
    Options {
        edges: model.disc.edges_per_revolution as u32,
        tick_hz: 1000.0,
        motion,
        form: Form::Full,
        indexed: true,
        requirements: Requirements::default(),
        curve: true,
    }
}

fn small() -> EncoderModel {
    EncoderModel {
        disc: DiscParams {
            edges_per_revolution: 2000.0,
            ..DiscParams::default()
        },
        ..EncoderModel::real()
    }
}

#[test]
fn a_flywheel_that_coasts_is_learned_from() {
    let model = small();
    let coast = |velocity: f64, deceleration: f64| {
        let motion = Motion::Coast {
            velocity,
            deceleration,
        };
        (motion, (velocity / deceleration) as u64)
    };
    // To a stop; each loses a few percent a revolution at first.
    let motions = [coast(150.0, 0.08), coast(-110.0, -0.05)];
    let recordings = [record(&model, 3, &motions).unwrap()];
    let options = options(&model, calibration::Motion::Coast);
    let learned = learn_from_recordings(&recordings, &options).unwrap();
    assert_eq!(learned.runs.len(), 2);
    let encoder = Encoder::new(&model, 1000.0, 0.0, 3).unwrap();
    let map = EncoderMap::from_bytes(&learned.image).unwrap();
    for direction in [Direction::Forward, Direction::Backward] {
        let off = residual(&map, &encoder, direction);
        assert!(off < 0.01, "{direction:?}: {off}");
    }
}

#[test]
fn stretches_of_one_speed_are_found_between_ramps_and_stops() {
    let model = small();
    let feed = |velocity: f64, ticks| (Motion::Steady { velocity }, ticks);
    let ramp = |velocity, acceleration, ticks| {
        (
            Motion::Ramp {
                velocity,
                acceleration,
            },
            ticks,
        )
    };
    // Up in 0.8 s, 20 revolutions, down to half, 20 more, back, and a run that is too short.
    let motions = [
        ramp(5.0, 0.1, 800),
        feed(85.0, 471),
        ramp(85.0, -0.1, 425),
        feed(42.5, 941),
        feed(-85.0, 471),
        feed(-42.5, 941),
        feed(60.0, 300),
    ];
    let recordings = [record(&model, 3, &motions).unwrap()];
    let learned =
        learn_from_recordings(&recordings, &options(&model, calibration::Motion::Steady)).unwrap();
    let speeds: Vec<f64> = learned
        .runs
        .iter()
        .map(|run| run.stretch.speed * 2000.0)
        .map(|speed| (speed * 10.0).round() / 10.0)
        .collect();
    assert_eq!(speeds, [85.0, 42.5, 85.0, 42.5]);
    let ways: Vec<bool> = learned
        .runs
        .iter()
        .map(|run| run.summary.backward)
        .collect();
    assert_eq!(ways, [false, false, true, true]);
    let short: Vec<_> = learned
        .left
        .iter()
        .filter(|left| (left.stretch.speed * 2000.0 - 60.0).abs() < 0.1)
        .collect();
    assert_eq!(short.len(), 1);
    assert!((short[0].stretch.revolutions - 9.0).abs() <= 0.5);
    let map = EncoderMap::from_bytes(&learned.image).unwrap();
    let own = map_fit(&recordings[0], 1000.0, map);
    assert_eq!(own.verdict(map.form()), Verdict::Fits, "{own:?}");
    let other = record(&model, 4, &[feed(85.0, 100)]).unwrap();
    let other = map_fit(&other, 1000.0, map);
    assert_eq!(other.verdict(map.form()), Verdict::Useless, "{other:?}");
    let curve = learned.curve.unwrap();
    let rms = |errors: &[f64]| {
        (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
    };
    assert!(rms(&curve.before_d) > 1.0 && rms(&curve.after_d) < 0.005);
}

#[test]
fn a_simulated_recording_has_the_edges_of_the_simulator() {
    let model = EncoderModel::ideal();
    // There and back by a swing, with reversals within ticks.
    let recording = record(&model, 1, &[(Motion::SINE, 800)]).unwrap();
    let sampler = Sampler::new(&recording, 1000.0);
    let totals = sampler.totals();
    assert_eq!(totals.illegal, 0);
    assert!(
        totals.edges > 15_990 && totals.final_count.abs() <= 1,
        "{totals:?}"
    );
    let rises = recording
        .changes
        .windows(2)
        .filter(|pair| pair[1].levels.z && !pair[0].levels.z);
    assert_eq!(rises.count(), 0);
    // Forward the index rises at a multiple of the revolution, backward at the other end of its pulse.
    let recording = record(
        &model,
        1,
        &[
            (Motion::Steady { velocity: 90.0 }, 50),
            (Motion::Steady { velocity: -90.0 }, 50),
        ],
    )
    .unwrap();
    let mut sampler = Sampler::new(&recording, 1000.0);
    let mut fronts = Vec::new();
    let start = 6500 - sampler.start_count();
    while let Some(capture) = sampler.next_capture() {
        fronts.extend(capture.index.map(|latch| i64::from(latch.count) + start));
    }
    assert_eq!(fronts, [10_000, 10_002]);
}
