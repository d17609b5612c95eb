//! The simulator's encoder, from its captures.

use leadscrew::calibration::{Learner, Progress, Requirements, RunPlan};
use leadscrew::capture::Unwrapper;
use leadscrew::encoder_map::Direction;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene;

use crate::generator::{Memory, Shaft};
use crate::truth::Off;

/// Feeds a run of the simulator's encoder.
fn simulate(learner: &mut Learner<'_>, velocity: f64, seed: u64) {
    let motion = scene::Motion::Steady { velocity };
    let model = EncoderModel::real();
    let mut scene = scene::Scene::new(motion, &model, 1000.0, 777.3, seed).unwrap();
    let mut unwrapper = Unwrapper::new();
    learner.begin_run(RunPlan::steady(12)).unwrap();
    for _ in 0..3000 {
        scene.step();
        let capture = scene.capture();
        if learner.feed(&unwrapper.unwrap(&capture)).unwrap() == Progress::Complete {
            learner.end_run().unwrap();
            return;
        }
    }
    panic!("15 revolutions in 3000 ticks");
}

#[test]
fn the_simulators_encoder_is_learned_from_its_captures() {
    let shaft = Shaft::real(8);
    let mut memory = Memory::new(shaft.edges());
    let mut learner = memory.learner();
    for velocity in [100.0, -100.0, 71.3, -71.3] {
        simulate(&mut learner, velocity, 8);
    }
    let learned = learner.finish(&Requirements::default()).unwrap();
    for direction in [Direction::Forward, Direction::Backward] {
        let off = Off::new(&learned, &shaft, direction);
        assert!(off.rms() < 0.0015, "{direction:?}: {}", off.rms());
    }
    assert_eq!(learned.index_front(Direction::Backward), Some(2));
}
