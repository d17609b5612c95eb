//! The second encoder: no lag, and an index that must come where it is due.

use leadscrew::edges::EdgeConfig;
use leadscrew::hal::Capture;
use leadscrew::setpoint::master::{Index, Master, MasterParams};
use leadscrew::uncertainty::EdgeErrors;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::{Motion, Scene};

pub fn master(counts_per_revolution: f64) -> Master {
    let edges = EdgeConfig::new(1000.0, 84e6, &EdgeErrors::default()).unwrap();
    let params = MasterParams {
        master_counts_per_revolution: counts_per_revolution,
        ..MasterParams::default()
    };
    Master::new(params.quantise(edges).unwrap())
}

pub fn scene(motion: Motion, model: &EncoderModel) -> Scene {
    Scene::new(motion, model, 1000.0, 0.5, 3).unwrap()
}

/// Runs `ticks` of a scene whose captures are `changed`; ticks in which the index slipped.
fn slips(velocity: f64, ticks: u32, mut changed: impl FnMut(u32, &mut Capture<'_>)) -> Vec<u32> {
    let mut scene = scene(Motion::Steady { velocity }, &EncoderModel::ideal());
    let mut master = master(10_000.0);
    let mut found = Vec::new();
    for tick in 0..ticks {
        scene.step();
        let mut capture = scene.capture();
        changed(tick, &mut capture);
        master.step(Some(&capture), false);
        if master.is_slipped() {
            found.push(tick);
        }
    }
    found
}

#[test]
fn a_sound_encoder_never_slips() {
    for velocity in [137.0, -137.0, 3.3] {
        assert!(slips(velocity, 5000, |_, _| ()).is_empty());
    }
}

#[test]
fn counts_that_are_lost_show_at_the_next_index() {
    // The index at 20 000 d comes in tick 199.
    let lost = |tick: u32, capture: &mut Capture<'_>| {
        if tick >= 150 {
            capture.count = capture.count.wrapping_sub(4);
            if let Some(index) = &mut capture.index {
                index.count = index.count.wrapping_sub(4);
            }
        }
    };
    // Once: then it is where it is.
    assert_eq!(slips(100.0, 1000, lost), [199]);
}

#[test]
fn an_index_that_does_not_come_is_missed_within_the_tolerance() {
    let silent = |tick: u32, capture: &mut Capture<'_>| {
        if tick > 150 {
            capture.index = None;
        }
    };
    // Seen at 10 000 d in tick 99; 20 003 d are passed in tick 200, and 30 003 d in tick 300.
    assert_eq!(slips(100.0, 350, silent), [200, 300]);
}

#[test]
fn what_it_says_of_a_ramp_holds_for_the_sampling_instant() {
    let ramp = Motion::Ramp {
        velocity: 20.0,
        acceleration: 0.05,
    };
    let mut scene = scene(ramp, &EncoderModel::ideal());
    let mut master = master(10_000.0);
    for tick in 0..600 {
        scene.step();
        master.step(Some(&scene.capture()), false);
        if tick > 20 {
            let truth = scene.truth();
            let estimate = master.estimate();
            assert!((estimate.position.to_num::<f64>() - truth.position).abs() < 0.01);
            assert!((estimate.velocity.to_num::<f64>() - truth.velocity).abs() < 0.005);
            assert!((estimate.acceleration.to_num::<f64>() - 0.05).abs() < 0.002);
        }
    }
    let index = master.index().unwrap();
    assert_eq!(
        (index.place % 10_000, index.is_forward),
        (0, true),
        "{index:?}"
    );
}

#[test]
fn the_index_going_backward_is_its_other_flank() {
    let mut scene = scene(Motion::Steady { velocity: -50.0 }, &EncoderModel::ideal());
    let mut master = master(10_000.0);
    for _ in 0..300 {
        scene.step();
        master.step(Some(&scene.capture()), false);
    }
    // Three discretes wide; the boundary above the count that was latched.
    assert_eq!(
        master.index(),
        Some(Index {
            place: -9_997,
            is_forward: false
        })
    );
}

#[test]
fn without_a_capture_or_a_signal_it_is_not_present() {
    let mut master = master(4096.0);
    assert!(!master.is_present());
    master.step(Some(&Capture::default()), false);
    assert!(master.is_present());
    master.step(Some(&Capture::default()), true);
    assert!(!master.is_present());
    master.step(None, false);
    assert!(!master.is_present());
}
