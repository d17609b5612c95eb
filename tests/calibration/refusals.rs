//! What does not suffice, and that it is said with figures.

use leadscrew::calibration::{Learner, MAX_RUNS, Refusal, Requirements, RunPlan, Work};

use crate::generator::{Memory, Shaft, TIMER_HZ, Tick, learn, ticks};
use crate::motion::Motion;

const PLAN: RunPlan = RunPlan::steady(12);

/// Why a run in which each tick is spoiled by `spoil`, with its number, is refused.
fn refusal_of(motion: Motion, mut spoil: impl FnMut(usize, Tick) -> Tick) -> Refusal {
    let shaft = Shaft::small(1);
    let mut memory = Memory::new(shaft.edges());
    let mut learner = memory.learner();
    let run = ticks(&shaft, motion, 12, 5).enumerate();
    let refused = learn(
        &mut learner,
        PLAN,
        run.map(|(number, tick)| spoil(number, tick)),
    )
    .unwrap_err();
    // The run is dropped.
    assert_eq!(learner.end_run(), Err(Refusal::NoRun));
    refused
}

const STEADY: Motion = Motion::steady(50.0);

#[test]
fn lost_edge_times_are_refused() {
    let refused = refusal_of(STEADY, |number, mut tick| {
        if number == 300 {
            tick.times.pop();
        }
        tick
    });
    // 1 234 d before the first revolution, 300 ticks of 50 d: in the seventh from the index on.
    assert_eq!(refused, Refusal::MissedEdges { revolution: 7 });
    let overrun = refusal_of(STEADY, |number, tick| Tick {
        overrun: number == 300,
        ..tick
    });
    assert_eq!(overrun, Refusal::MissedEdges { revolution: 7 });
    let one_time_stamp = refusal_of(STEADY, |_, mut tick| {
        tick.times.clear();
        tick
    });
    assert!(
        matches!(one_time_stamp, Refusal::TooFewRevolutions { found: 0, .. }),
        "{one_time_stamp}"
    );
}

#[test]
fn missing_ticks_are_refused() {
    let shaft = Shaft::small(1);
    let mut memory = Memory::new(shaft.edges());
    let mut learner = memory.learner();
    let run = ticks(&shaft, STEADY, 12, 5)
        .enumerate()
        .filter(|(number, _)| *number != 300);
    let refused = learn(&mut learner, PLAN, run.map(|(_, tick)| tick)).unwrap_err();
    assert!(matches!(refused, Refusal::MissedEdges { .. }), "{refused}");
}

#[test]
fn a_shaft_that_turns_back_is_refused() {
    let mut count = None;
    let refused = refusal_of(STEADY, |number, mut tick| {
        if number >= 300 {
            let first = *count.get_or_insert(tick.count);
            tick.count = 2 * first - tick.count;
        }
        tick
    });
    assert_eq!(refused, Refusal::Reversed { revolution: 7 });
}

#[test]
fn a_speed_that_changes_is_refused() {
    let motion = Motion {
        acceleration: 0.005,
        ..STEADY
    };
    let refused = refusal_of(motion, |_, tick| tick);
    let Refusal::SpeedChanging { change, limit, .. } = refused else {
        panic!("{refused}");
    };
    assert!(change > limit && change < 0.03, "{change}");
}

#[test]
fn a_coast_that_stops_is_refused() {
    let shaft = Shaft::small(1);
    let mut memory = Memory::new(shaft.edges());
    let motion = Motion {
        acceleration: -0.04,
        ..STEADY
    };
    let run = ticks(&shaft, motion, 8, 5);
    let refused = learn(&mut memory.learner(), RunPlan::coast(12), run).unwrap_err();
    assert!(
        matches!(
            refused,
            Refusal::SpeedChanging { .. } | Refusal::TooFewRevolutions { .. }
        ),
        "{refused}"
    );
}

#[test]
fn a_revolution_longer_than_half_the_timer_is_refused() {
    let refused = refusal_of(Motion::steady(0.12), |_, tick| tick);
    let Refusal::TooSlow { longest_s } = refused else {
        panic!("{refused}");
    };
    assert!((longest_s - 12.78).abs() < 0.01, "{longest_s}");
}

#[test]
fn an_index_missing_or_out_of_place_is_refused() {
    let mut number = 0;
    let missing = refusal_of(STEADY, |_, mut tick| {
        number += u32::from(tick.index.is_some());
        tick.index = tick.index.filter(|_| number != 5);
        tick
    });
    assert!(matches!(missing, Refusal::IndexMissing { .. }), "{missing}");
    let mut number = 0;
    let slipped = refusal_of(STEADY, |_, mut tick| {
        if let Some(index) = &mut tick.index {
            number += 1;
            index.count = index.count.wrapping_add(if number == 5 { 4 } else { 0 });
        }
        tick
    });
    assert!(
        matches!(slipped, Refusal::IndexInconsistent { off_by: 4, .. }),
        "{slipped}"
    );
    let never = refusal_of(STEADY, |_, tick| Tick {
        index: None,
        ..tick
    });
    assert_eq!(
        never,
        Refusal::TooFewRevolutions {
            found: 0,
            needed: 12
        }
    );
}

#[test]
fn edges_per_revolution_that_are_others_are_refused() {
    let shaft = Shaft::small(1);
    let mut memory = Memory::new(1996);
    let refused = learn(&mut memory.learner(), PLAN, ticks(&shaft, STEADY, 12, 5)).unwrap_err();
    assert!(
        matches!(refused, Refusal::IndexInconsistent { off_by: 4, .. }),
        "{refused}"
    );
}

#[test]
fn a_run_that_ends_early_is_refused_and_the_runs_before_kept() {
    let shaft = Shaft::small(1);
    let mut memory = Memory::new(shaft.edges());
    let mut learner = memory.learner();
    learn(&mut learner, PLAN, ticks(&shaft, STEADY, 12, 5)).unwrap();
    let refused = learn(&mut learner, PLAN, ticks(&shaft, STEADY, 5, 5)).unwrap_err();
    assert!(
        matches!(
            refused,
            Refusal::TooFewRevolutions {
                found: 5..=6,
                needed: 12
            }
        ),
        "{refused:?}"
    );
    assert_eq!(
        learner
            .finish(&Requirements::NONE)
            .unwrap()
            .report()
            .runs()
            .len(),
        1
    );
}

#[test]
fn plans_encoders_and_memories_are_checked() {
    let shaft = Shaft::small(1);
    let mut memory = Memory::new(shaft.edges());
    let mut learner = memory.learner();
    for revolutions in [0, 11] {
        assert!(
            learner.begin_run(RunPlan::steady(revolutions)).is_err(),
            "{revolutions}"
        );
    }
    assert!(matches!(
        learner.finish(&Requirements::default()),
        Err(Refusal::NoRun)
    ));
    let (mut sums, mut mean) = (vec![0; 2000], vec![0; 1999]);
    for (edges, suits) in [
        (2000, false),
        (1998, false),
        (508, false),
        (1 << 18, false),
        (1996, true),
    ] {
        let work = Work {
            sums: &mut sums,
            mean: &mut mean,
        };
        assert_eq!(
            Learner::new(edges, TIMER_HZ, work).is_ok(),
            suits,
            "{edges}"
        );
    }
}

#[test]
fn a_run_too_many_is_refused() {
    let shaft = Shaft::small(1);
    let mut memory = Memory::new(shaft.edges());
    let mut learner = memory.learner();
    for seed in 0..MAX_RUNS as u64 {
        learn(&mut learner, PLAN, ticks(&shaft, STEADY, 12, seed + 1)).unwrap();
    }
    assert_eq!(
        learner.begin_run(PLAN),
        Err(Refusal::TooManyRuns { limit: MAX_RUNS })
    );
}

#[test]
fn edges_that_do_not_repeat_are_refused() {
    let shaft = Shaft {
        noise_d: 0.06,
        ..Shaft::small(1)
    };
    let mut memory = Memory::new(shaft.edges());
    let mut learner = memory.learner();
    learn(&mut learner, PLAN, ticks(&shaft, STEADY, 12, 5)).unwrap();
    let requirements = Requirements {
        max_edge_residual_d: 0.01,
        ..Requirements::NONE
    };
    let refused = learner.finish(&requirements).unwrap_err();
    assert!(
        matches!(refused, Refusal::ResidualTooLarge { .. }),
        "{refused}"
    );
}

#[test]
fn refusals_say_what_to_do() {
    let text = Refusal::RunsDisagree {
        order: 2,
        difference_d: 0.0461,
        limit_d: 0.01,
        run: 1,
    }
    .to_string();
    assert_eq!(
        text,
        "run 1 differs by 0.046 d at 2 cycles a revolution, allowed are 0.010 d: the motion trembles there; learn anew \
         at another speed (some 20 % off) or over more revolutions"
    );
    let text = Refusal::SpeedChanging {
        revolution: 3,
        change: -0.02,
        limit: 0.01,
    }
    .to_string();
    assert_eq!(
        text,
        "the speed changed by -2.00 % by revolution 3, allowed are 1.00 %: begin when it is steady, hold the feed"
    );
}
