//! A map learned from simulated runs, used on others of the same encoder.

use leadscrew::calibration::Requirements;
use leadscrew::capture::Unwrapper;
use leadscrew::edges::{EdgeConfig, EdgeReader};
use leadscrew::encoder_map::check::{MapCheck, Verdict};
use leadscrew::encoder_map::encode::{MapContent, encode};
use leadscrew::encoder_map::format::image_len;
use leadscrew::encoder_map::{Direction, EncoderMap, Form, Residual};
use leadscrew::hal::Capture;
use leadscrew::uncertainty::EdgeErrors;
use leadscrew_hal_mock::disc::DiscParams;
use leadscrew_hal_mock::encoder::{Encoder, EncoderModel};
use leadscrew_hal_mock::scene::{Motion, Scene};
use leadscrew_host::calibration::{
    self, Options, Procedure, learn_from_recordings, learn_simulated, map_fit,
};
use leadscrew_host::sampler::Sampler;
use leadscrew_host::sim_encoder::record;

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
        assert!(off < 0.002, "{direction:?}: {off}");
    }
    assert_eq!(map.front(Direction::Forward), Some(0));
    assert_eq!(map.front(Direction::Backward), Some(2));
}

/// A check of a map by `revolutions` of the encoder that `seed` draws, at a velocity that is not that of learning.
fn checked<'m>(
    map: EncoderMap<'m>,
    model: &EncoderModel,
    seed: u64,
    velocity: f64,
) -> MapCheck<'m> {
    let edges = model.disc.edges_per_revolution;
    let motion = Motion::calibration(velocity, edges);
    let mut scene = Scene::new(motion, model, 1000.0, 123.4, seed).unwrap();
    let mut unwrapper = Unwrapper::new();
    let mut check = MapCheck::new(map);
    for _ in 0..(2.0 * edges / velocity.abs()) as u32 {
        scene.step();
        check.feed(&unwrapper.unwrap(&scene.capture()));
    }
    check
}

#[test]
fn a_map_keeps_its_gain_at_other_speeds_and_is_useless_on_another_encoder() {
    let model = EncoderModel::real();
    let image = learn_simulated(&model, 3, &Procedure::default()).unwrap();
    let map = EncoderMap::from_bytes(&image).unwrap();
    for velocity in [130.0, -130.0, 21.7, -21.7] {
        let own = checked(map, &model, 3, velocity);
        let fit = own.fit();
        assert_eq!(own.verdict(), Verdict::Fits, "{velocity}: {fit:?}");
        // Noise of 0.005 d and 20 ns a pass, 0.0013 d of map.
        assert!(
            fit.without_d > 0.09 && fit.with_d < 0.008,
            "{velocity}: {fit:?}"
        );
        for seed in [1, 2, 4] {
            let other = checked(map, &model, seed, velocity);
            assert_eq!(other.verdict(), Verdict::Useless, "{:?}", other.fit());
            // Patterns that have nothing in common add up.
            let ratio = other.fit().gain() * std::f64::consts::SQRT_2;
            assert!((ratio - 1.0).abs() < 0.1, "{:?}", other.fit());
        }
    }
}

#[test]
fn a_drift_of_the_phases_keeps_the_map() {
    let model = EncoderModel::real();
    let image = learn_simulated(&model, 5, &Procedure::default()).unwrap();
    let map = EncoderMap::from_bytes(&image).unwrap();
    let check = checked(map, &model.drifted(0.02), 5, 100.0);
    assert_eq!(check.verdict(), Verdict::Fits, "{:?}", check.fit());
}

#[test]
fn a_map_a_line_off_is_useless() {
    let model = EncoderModel::real();
    let encoder = Encoder::new(&model, 1000.0, 0.0, 3).unwrap();
    let turned = |by: usize| {
        let error =
            |edge: u32| (encoder.placement_error(edge as usize + by, false) * 65_536.0) as i32;
        let content = MapContent {
            edges: 10_000,
            error: &error,
            phases: [[0; 4]; 2],
            fronts: [Some(0), Some(2)],
            residual: Residual::default(),
        };
        let mut image = vec![0; image_len(10_000, Form::Full)];
        encode(&content, Form::Full, &mut image).unwrap();
        image
    };
    for (by, verdict) in [
        (0, Verdict::Fits),
        (4, Verdict::Useless),
        (9996, Verdict::Useless),
    ] {
        let image = turned(by);
        let check = checked(EncoderMap::from_bytes(&image).unwrap(), &model, 3, 80.0);
        assert_eq!(check.verdict(), verdict, "{by}: {:?}", check.fit());
    }
}

#[test]
fn lines_that_cannot_be_told_apart_give_no_verdict() {
    let model = EncoderModel::real();
    let coarse = Procedure {
        form: Form::Coarse,
        ..Procedure::default()
    };
    let image = learn_simulated(&model, 3, &coarse).unwrap();
    let check = checked(EncoderMap::from_bytes(&image).unwrap(), &model, 3, 80.0);
    assert_eq!(check.verdict(), Verdict::Unknown);
    let ideal = EncoderModel::ideal();
    let image = learn_simulated(&ideal, 3, &Procedure::default()).unwrap();
    let map = EncoderMap::from_bytes(&image).unwrap();
    assert_eq!(checked(map, &ideal, 3, 80.0).verdict(), Verdict::Unknown);
    // But an encoder with errors shows that the map is not its own, and too slow a motion shows nothing.
    assert_eq!(checked(map, &model, 3, 80.0).verdict(), Verdict::Useless);
    assert_eq!(checked(map, &model, 3, 5.0).verdict(), Verdict::Unknown);
}

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
