//! Runs of one encoder put together: order, captures apart, directions, the simulator's own encoder.

use leadscrew::calibration::{Direction, Learner, Progress, Refusal, Requirements, RunPlan};
use leadscrew::capture::Unwrapper;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene;

use crate::generator::{Memory, Shaft, Tick, learn, ticks};
use crate::motion::Motion;
use crate::truth::Off;

const PLAN: RunPlan = RunPlan::steady(12);

/// Ticks as another capture gives them, whose count began elsewhere.
fn counted_from(mut tick: Tick, first: i64) -> Tick {
    tick.count += first;
    if let Some(index) = &mut tick.index {
        index.count = index.count.wrapping_add(first as u32);
    }
    tick
}

#[test]
fn captures_whose_counts_begin_anywhere_are_aligned_in_any_order() {
    let shaft = Shaft::small(1);
    for velocities in [
        [50.0, -50.0, 37.0],
        [-50.0, -37.0, 50.0],
        [50.0, 37.0, -50.0],
    ] {
        let mut memory = Memory::new(shaft.edges());
        let mut learner = memory.learner();
        for (velocity, first) in velocities.into_iter().zip([-5_000_004, 1236, 77_777_776]) {
            let run = ticks(&shaft, Motion::steady(velocity), 12, 5);
            learn(
                &mut learner,
                PLAN,
                run.map(|tick| counted_from(tick, first)),
            )
            .unwrap();
        }
        let learned = learner.finish(&Requirements::default()).unwrap();
        assert_eq!(
            learned.index_front(Direction::Forward),
            Some(0),
            "{velocities:?}"
        );
        assert_eq!(
            learned.index_front(Direction::Backward),
            Some(2),
            "{velocities:?}"
        );
        for direction in [Direction::Forward, Direction::Backward] {
            let off = Off::new(&learned, &shaft, direction);
            assert!(
                off.rms() < 0.002,
                "{velocities:?} {direction:?}: {}",
                off.rms()
            );
        }
    }
}

#[test]
fn a_count_that_does_not_tell_the_state_of_a_and_b_is_refused() {
    let shaft = Shaft::small(1);
    let mut memory = Memory::new(shaft.edges());
    let mut learner = memory.learner();
    learn(
        &mut learner,
        PLAN,
        ticks(&shaft, Motion::steady(50.0), 12, 5),
    )
    .unwrap();
    let run = ticks(&shaft, Motion::steady(37.0), 12, 6).map(|tick| counted_from(tick, 2));
    let refused = learn(&mut learner, PLAN, run).unwrap_err();
    assert!(
        matches!(
            refused,
            Refusal::PatternShifted {
                run: 1,
                off_by: 2 | -2
            }
        ),
        "{refused:?}"
    );
}

#[test]
fn the_lines_of_another_encoder_are_refused_and_the_runs_before_kept() {
    let shaft = Shaft::small(1);
    let mut memory = Memory::new(shaft.edges());
    let mut learner = memory.learner();
    learn(
        &mut learner,
        PLAN,
        ticks(&shaft, Motion::steady(50.0), 12, 5),
    )
    .unwrap();
    let other = ticks(&Shaft::small(2), Motion::steady(37.0), 12, 6).collect::<Vec<_>>();
    let refused = learn(&mut learner, PLAN, other.into_iter()).unwrap_err();
    assert_eq!(refused, Refusal::PatternDiffers { run: 1 });
    learn(
        &mut learner,
        PLAN,
        ticks(&shaft, Motion::steady(-37.0), 12, 7),
    )
    .unwrap();
    let learned = learner.finish(&Requirements::default()).unwrap();
    assert!(Off::new(&learned, &shaft, Direction::Backward).rms() < 0.002);
}

#[test]
fn an_index_that_moved_between_runs_is_refused() {
    let shaft = Shaft::small(1);
    let mut memory = Memory::new(shaft.edges());
    let mut learner = memory.learner();
    learn(
        &mut learner,
        PLAN,
        ticks(&shaft, Motion::steady(50.0), 12, 5),
    )
    .unwrap();
    let run = ticks(&shaft, Motion::steady(37.0), 12, 6).map(|mut tick| {
        if let Some(index) = &mut tick.index {
            index.count = index.count.wrapping_add(8);
        }
        tick
    });
    let refused = learn(&mut learner, PLAN, run).unwrap_err();
    assert!(
        matches!(
            refused,
            Refusal::PatternShifted {
                run: 1,
                off_by: 8 | -8
            }
        ),
        "{refused:?}"
    );
}

#[test]
fn a_front_that_wanders_by_a_count_is_taken() {
    let shaft = Shaft::small(3);
    let mut memory = Memory::new(shaft.edges());
    let mut learner = memory.learner();
    for (velocity, seed) in [(50.0, 5), (37.0, 6)] {
        let mut number = 0;
        let run = ticks(&shaft, Motion::steady(velocity), 12, seed).map(|mut tick| {
            if let Some(index) = &mut tick.index {
                number += 1;
                index.count = index.count.wrapping_sub(u32::from(number % 3 == 0));
            }
            tick
        });
        learn(&mut learner, PLAN, run).unwrap();
    }
    let learned = learner
        .finish(&Requirements {
            both_directions: false,
            ..Requirements::default()
        })
        .unwrap();
    assert_eq!(learned.index_front(Direction::Forward), Some(0));
    let off = Off::new(&learned, &shaft, Direction::Forward);
    assert!(off.rms() < 0.002, "{}", off.rms());
}

#[test]
fn an_encoder_without_errors_has_none() {
    let shaft = Shaft {
        errors: vec![0.0; 2000],
        ..Shaft::small(1)
    };
    let mut memory = Memory::new(shaft.edges());
    let mut learner = memory.learner();
    for velocity in [50.0, -37.0] {
        learn(
            &mut learner,
            PLAN,
            ticks(&shaft, Motion::steady(velocity), 12, 5),
        )
        .unwrap();
    }
    let learned = learner.finish(&Requirements::default()).unwrap();
    assert!(Off::new(&learned, &shaft, Direction::Backward).rms() < 0.002);
    assert_eq!(learned.index_front(Direction::Backward), Some(2));
}

#[test]
fn one_speed_and_one_direction_are_accepted_where_asked_for() {
    let shaft = Shaft::small(1);
    let learn_one = |requirements: &Requirements| {
        let mut memory = Memory::new(shaft.edges());
        let mut learner = memory.learner();
        learn(
            &mut learner,
            PLAN,
            ticks(&shaft, Motion::steady(-50.0), 12, 5),
        )
        .unwrap();
        learner.finish(requirements).map(|learned| {
            let report = learned.report();
            assert_eq!(
                report.check(&Requirements::default()),
                Err(Refusal::OneDirection)
            );
            assert!(
                report.one_speed
                    && report.hysteresis_a_less_b_d.is_none()
                    && report.noise.is_none()
            );
            // The halves of a single run stand for its errors.
            assert!(report.residual.long_wave_d > 0.0 && report.residual.long_wave_d < 0.005);
            assert_eq!(learned.index_front(Direction::Forward), None);
            assert_eq!(
                learned.phases_d(Direction::Forward),
                learned.phases_d(Direction::Backward)
            );
            assert!(Off::new(&learned, &shaft, Direction::Backward).rms() < 0.003);
        })
    };
    let strict = Requirements::default();
    assert_eq!(learn_one(&strict), Err(Refusal::OneDirection));
    let one_way = Requirements {
        both_directions: false,
        ..strict
    };
    assert!(matches!(learn_one(&one_way), Err(Refusal::OneSpeed { .. })));
    assert_eq!(
        learn_one(&Requirements {
            two_speeds: false,
            ..one_way
        }),
        Ok(())
    );
}

/// Feeds a run of the simulator's encoder.
fn simulate(learner: &mut Learner<'_>, velocity: f64, seed: u64) {
    let motion = scene::Motion::Steady { velocity };
    let model = EncoderModel::real();
    let mut scene = scene::Scene::new(motion, &model, 1000.0, 777.3, seed).unwrap();
    let mut unwrapper = Unwrapper::new();
    learner.begin_run(PLAN).unwrap();
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
