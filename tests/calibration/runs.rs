//! Runs of one encoder put together: order, captures apart, directions.

use leadscrew::calibration::{Learner, Refusal, Requirements, RunPlan};
use leadscrew::encoder_map::Direction;

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

/// A learner that has one run of `shaft`, forward.
fn after_a_run<'m>(memory: &'m mut Memory, shaft: &Shaft) -> Learner<'m> {
    let mut learner = memory.learner();
    let run = ticks(shaft, Motion::steady(50.0), 12, 5);
    learn(&mut learner, PLAN, run).unwrap();
    learner
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
    let mut learner = after_a_run(&mut memory, &shaft);
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
    let mut learner = after_a_run(&mut memory, &shaft);
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
    let mut learner = after_a_run(&mut memory, &shaft);
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
fn a_placement_is_the_error_with_the_mean_phase_of_both_directions() {
    let shaft = Shaft::small(1);
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
    let forward = learned.phases(Direction::Forward);
    let backward = learned.phases(Direction::Backward);
    // A (odd) lies 0.04 d lower backward, B 0.02 d: 0.01 d to each side of what is common.
    for (phase, (forward, backward)) in forward.into_iter().zip(backward).enumerate() {
        let expected = if phase % 2 == 0 { -0.01 } else { 0.01 };
        let seen = f64::from(forward - backward) / 65_536.0;
        assert!((seen - expected).abs() < 0.0005, "{phase}: {seen}");
    }
    for edge in 0..2000 {
        let phase = (forward[edge % 4] + backward[edge % 4]) / 2;
        let expected = i32::from(learned.error(edge)) * 16 + phase;
        assert!((learned.placement(edge) - expected).abs() <= 2, "{edge}");
    }
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
