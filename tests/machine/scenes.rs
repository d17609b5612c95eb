//! Prescribed motions follow their truth, and the encoder on them sees it.

use leadscrew_hal_mock::arc::{Arc, State};
use leadscrew_hal_mock::encoder::{EncoderModel, EncoderParams};
use leadscrew_hal_mock::scene::{Motion, Scene};
use proptest::prelude::*;

use crate::seeded::seeded;

fn ideal(motion: Motion) -> Scene {
    Scene::new(motion, &EncoderModel::ideal(), 1000.0, 0.5, 1).unwrap()
}

/// State after `ticks` by the closed form of `motion` from 0.5 d on.
fn exact(motion: Motion, ticks: f64) -> State {
    let cubic = |velocity: f64, acceleration: f64, jerk: f64| State {
        position: 0.5 + ticks * (velocity + ticks * (acceleration / 2.0 + ticks * jerk / 6.0)),
        velocity: velocity + ticks * (acceleration + ticks * jerk / 2.0),
        acceleration: acceleration + ticks * jerk,
    };
    match motion {
        Motion::Steady { velocity } => cubic(velocity, 0.0, 0.0),
        Motion::Ramp {
            velocity,
            acceleration,
        } => cubic(velocity, acceleration, 0.0),
        Motion::Jerk { jerk } => cubic(0.0, 0.0, jerk),
        Motion::Coast {
            velocity,
            deceleration,
        } => cubic(velocity, -deceleration, 0.0),
        _ => unreachable!("not a cubic"),
    }
}

/// Rounding of f64 that adds up over some thousand ticks.
fn close(seen: State, exact: State) -> bool {
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (1.0 + b.abs());
    same(seen.position, exact.position)
        && same(seen.velocity, exact.velocity)
        && same(seen.acceleration, exact.acceleration)
}

#[test]
fn every_motion_follows_its_closed_form_and_the_count_its_floor() {
    for (motion, ticks) in [
        (Motion::Steady { velocity: 130.0 }, 2000),
        (Motion::Steady { velocity: -0.37 }, 2000),
        (
            Motion::Ramp {
                velocity: 0.0,
                acceleration: 0.14147,
            },
            300,
        ),
        (
            Motion::Ramp {
                velocity: 20.0,
                acceleration: -0.05,
            },
            2000,
        ),
        (Motion::Jerk { jerk: 1e-4 }, 2000),
        (Motion::FLYWHEEL, 3300),
    ] {
        let mut scene = ideal(motion);
        for tick in 1..=ticks {
            scene.step();
            let truth = scene.truth();
            assert!(
                close(truth, exact(motion, f64::from(tick))),
                "{motion:?}, tick {tick}: {truth:?}"
            );
            if (truth.position - truth.position.round()).abs() > 1e-7 {
                assert_eq!(
                    f64::from(scene.capture().count as i32),
                    truth.position.floor(),
                    "{motion:?}, tick {tick}"
                );
            }
        }
    }
}

#[test]
fn the_flywheel_coasts_from_20_d_a_tick_at_minus_0_006_to_a_stop_and_stays() {
    let mut scene = ideal(Motion::FLYWHEEL);
    let mut velocity = 20.0;
    for _ in 0..3333 {
        scene.step();
        let truth = scene.truth();
        assert!(truth.velocity < velocity && truth.velocity > 0.0);
        velocity = truth.velocity;
    }
    (0..2).for_each(|_| scene.step());
    let rest = scene.truth();
    assert_eq!(rest.velocity, 0.0);
    // v²/2a, give or take what the last tick makes of it.
    assert!(
        (rest.position - 0.5 - 400.0 / 0.012).abs() < 0.01,
        "{rest:?}"
    );
    for _ in 0..100 {
        scene.step();
        assert_eq!(scene.truth().position, rest.position);
        assert_eq!(scene.truth().acceleration, 0.0);
        assert_eq!(scene.capture().last_edge_at, None);
    }
}

#[test]
fn the_truth_of_a_jittered_scene_is_that_of_its_mean_sampling_instant() {
    let jitter = EncoderParams {
        sampling_jitter_s: 1e-5,
        ..EncoderModel::ideal().encoder
    };
    let model = EncoderModel {
        encoder: jitter,
        ..EncoderModel::ideal()
    };
    let motion = Motion::Ramp {
        velocity: 10.0,
        acceleration: 0.1,
    };
    let mut scene = Scene::new(motion, &model, 1000.0, 0.5, 1).unwrap();
    let (mut behind, ticks) = (0.0, 2000);
    for tick in 1..=ticks {
        scene.step();
        // The jitter is a sum of four uniform bytes, of which the largest, 510, is 3.45 times its σ of √21845.
        let advance = 510.0 / 21_845.0_f64.sqrt() * 1e-5 * 1000.0;
        let (truth, exact) = (scene.truth(), exact(motion, f64::from(tick) - advance));
        assert!(
            (truth.position - exact.position).abs() < 1e-6
                && (truth.velocity - exact.velocity).abs() < 1e-8
        );
        // The count is the floor: half a d below the position on average.
        behind += scene.truth().position - 0.5 - f64::from(scene.capture().count);
    }
    // Uniform remainders of 0.29 d, and the jitter of 0.01 ticks at up to 210 d/tick.
    let mean = behind / f64::from(ticks);
    assert!(
        mean.abs() < 4.0 * (0.29_f64.powi(2) + 1.3_f64.powi(2)).sqrt() / f64::from(ticks).sqrt(),
        "{mean}"
    );
}

#[test]
fn scenes_are_determined_by_their_seed() {
    let run = |seed| {
        let mut scene =
            Scene::new(Motion::FLYWHEEL, &EncoderModel::real(), 1000.0, 0.5, seed).unwrap();
        let tick = |_| {
            scene.step();
            scene.capture().edges.concat()
        };
        (0..100).map(tick).collect::<Vec<_>>()
    };
    assert_eq!(run(1), run(1));
    assert_ne!(run(1), run(2));
}

proptest! {
    #![proptest_config(seeded(256))]

    #[test]
    fn an_arc_is_the_cubic_of_its_state_and_its_joint_meets_both_ends(
        position in -1e3..1e3_f64,
        velocity in -100.0..100.0_f64,
        to in (-1e3..1e3_f64, -100.0..100.0_f64),
    ) {
        let arc = Arc::joining((position, velocity), to);
        let (start, end) = (arc.at(0.0), arc.end());
        prop_assert_eq!((start.position, start.velocity), (position, velocity));
        // Coefficients of some 1e4 cancel here.
        prop_assert!((end.position - to.0).abs() < 1e-9 && (end.velocity - to.1).abs() < 1e-9);
        // Derivatives by central differences, exact for a cubic up to a third of the jerk times the step squared.
        for time in [0.2, 0.7] {
            let (before, at, after) = (arc.at(time - 1e-3), arc.at(time), arc.at(time + 1e-3));
            let slope = (after.position - before.position) / 2e-3;
            prop_assert!((slope - at.velocity).abs() < 1e-6 * (1.0 + arc.jerk.abs()));
            prop_assert!(((after.velocity - before.velocity) / 2e-3 - at.acceleration).abs() < 1e-6 * (1.0 + arc.jerk.abs()));
        }
    }
}
