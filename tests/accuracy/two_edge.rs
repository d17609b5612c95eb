//! The method that the estimators are compared with does what it is known for.

use leadscrew::capture::Unwrapper;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::{Motion, Scene};
use leadscrew_host::accuracy::{TwoEdge, TwoEdgeEstimate};

/// What the method says of a motion, with the true velocity, tick by tick.
fn observe(motion: Motion, model: &EncoderModel, ticks: usize) -> Vec<(TwoEdgeEstimate, f64)> {
    let mut scene = Scene::new(motion, model, 1000.0, 0.3, 1).unwrap();
    let mut unwrapper = Unwrapper::new();
    let mut two_edge = TwoEdge::new(84_000.0);
    (0..ticks)
        .map(|_| {
            scene.step();
            let estimate = two_edge.update(&unwrapper.unwrap(&scene.capture()));
            (estimate, scene.truth().velocity)
        })
        .collect()
}

#[test]
fn on_an_ideal_encoder_it_is_right_to_the_timer_in_both_directions() {
    for velocity in [0.37, -0.37, 3.0, -42.7, 150.0] {
        let seen = observe(Motion::Steady { velocity }, &EncoderModel::ideal(), 200);
        for (estimate, truth) in &seen[20..] {
            // A clock over the span of an edge or a tick.
            assert!(
                (estimate.velocity - truth).abs() < 2.0 * velocity.abs() / 84_000.0,
                "{velocity}: {estimate:?}"
            );
        }
    }
}

#[test]
fn its_velocity_is_for_the_instant_that_it_says() {
    let motion = Motion::Ramp {
        velocity: 20.0,
        acceleration: 0.1,
    };
    for (estimate, truth) in &observe(motion, &EncoderModel::ideal(), 200)[20..] {
        let then = truth - 0.1 * estimate.lag_v;
        assert!(
            (estimate.velocity - then).abs() < 0.01,
            "{estimate:?} {then}"
        );
        assert!((0.4..0.7).contains(&estimate.lag_v), "{estimate:?}");
    }
}

#[test]
fn on_a_real_encoder_the_lines_hold_it_at_0_16_d_a_tick() {
    let seen = observe(
        Motion::Steady { velocity: 50.37 },
        &EncoderModel::real(),
        4000,
    );
    let squares: f64 = seen[20..]
        .iter()
        .map(|(estimate, truth)| (estimate.velocity - truth).powi(2))
        .sum();
    let sigma = (squares / (seen.len() - 20) as f64).sqrt();
    assert!((0.13..0.25).contains(&sigma), "{sigma}");
}
