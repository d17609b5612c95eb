//! Whether a map belongs to the encoder that turns.

use leadscrew::capture::Unwrapper;
use leadscrew::encoder_map::check::{MapCheck, Verdict};
use leadscrew::encoder_map::encode::{MapContent, encode};
use leadscrew::encoder_map::format::image_len;
use leadscrew::encoder_map::{EncoderMap, Form, Residual};
use leadscrew_hal_mock::encoder::{Encoder, EncoderModel};
use leadscrew_hal_mock::scene::{Motion, Scene};
use leadscrew_host::calibration::{Procedure, learn_simulated};

/// A check of a map by two revolutions of the encoder that `seed` draws, at a velocity that is not that of learning.
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
