//! What a tool looks at an axis with: scope, stream, records, experiments, fault page, counters.

use std::time::Duration;

use leadscrew::identification::program::{Bounds, Program, Segment, command};
use leadscrew::protocol::refusal::Refusal;
use leadscrew::scope::{Setup, Signal, Signals, Trigger};
use leadscrew_client::{Axis, ExperimentPhase, Kind, LearningPhase, ScopePhase};
use leadscrew_host::simulated_axis::FlashImage;

use crate::session::{axis, tuned};

const MS: fn(u64) -> Duration = Duration::from_millis;

fn ready() -> Axis {
    let mut tool = axis(&FlashImage::blank());
    tool.edit_parameters(|edit| {
        for (name, value) in tuned() {
            edit.set_parameter(&name, value)?;
        }
        Ok(())
    })
    .unwrap();
    tool.enable().unwrap();
    tool
}

#[test]
fn a_scope_records_the_begin_of_a_motion() {
    let mut tool = ready();
    let setup = Setup {
        signals: Signals::new(&[Signal::Tick, Signal::SetpointVelocity, Signal::Count]).unwrap(),
        every: 2,
        trigger: Trigger::Command,
        pre: 100,
        samples: 400,
    };
    tool.arm_scope(&setup).unwrap();
    tool.wait(MS(300)).unwrap();
    assert_eq!(tool.scope().unwrap().phase, ScopePhase::Waits);
    tool.move_and_wait(20.0, 3000.0).unwrap();
    tool.wait(MS(600)).unwrap();
    let scope = tool.scope().unwrap();
    assert_eq!(scope.phase, ScopePhase::Complete);
    assert_eq!((scope.every, scope.samples), (2, 400));
    assert_eq!(scope.signals, setup.signals.as_slice());
    let samples = tool.read_scope(&scope).unwrap();
    assert_eq!(samples.len(), 400);
    // Each sample is two ticks after the one before, and the axis moves from the trigger on.
    for (number, sample) in samples.iter().enumerate() {
        assert_eq!(sample[0] as u32, scope.tick + 2 * number as u32);
        let is_before = (number as u32) < scope.trigger.unwrap();
        assert!(!is_before || sample[1] == 0, "{number}: {sample:?}");
    }
    assert!(samples.iter().any(|sample| sample[1] > 0));
    assert!(!scope.is_torn && scope.interruptions.is_empty());
}

#[test]
fn samples_and_records_stream_without_a_gap() {
    let mut tool = ready();
    tool.stream(5, &[Signal::Tick as u8, Signal::State as u8])
        .unwrap();
    let mut samples = tool.samples(MS(100));
    let taken: Vec<_> = samples.by_ref().take(200).map(Result::unwrap).collect();
    assert_eq!(samples.lost(), 0);
    for pair in taken.windows(2) {
        assert_eq!(pair[1].0, pair[0].0 + 5);
    }
    assert!(
        taken
            .iter()
            .all(|(tick, signals)| *tick == signals[0] as u32)
    );
    tool.stream(0, &[]).unwrap();
    tool.subscribe(10).unwrap();
    let records: Vec<_> = tool.records(MS(100)).take(50).map(Result::unwrap).collect();
    assert!(
        records
            .windows(2)
            .all(|pair| pair[1].tick == pair[0].tick + 10)
    );
}

#[test]
fn an_experiment_is_told_run_and_read() {
    let mut tool = ready();
    let bounds = Bounds {
        window_d: 5_000,
        speed_d_per_tick: 50,
        ticks: 1000,
        command: command(0.1),
    };
    let program = Program::new(&[Segment::level(0.02, 100), Segment::rest(100)], bounds);
    let experiment = tool.run_experiment(&program, 2).unwrap();
    assert_eq!(
        (experiment.phase, experiment.is_torn),
        (ExperimentPhase::Complete, false)
    );
    // A record for each two ticks, and the one that it begins with.
    assert!((100..=102).contains(&experiment.records), "{experiment:?}");
    let words = tool.read_work_words(experiment.records).unwrap();
    assert_eq!(words.len() as u32, experiment.records);
    assert!(words.iter().any(|word| *word != words[0]));
    tool.end_experiment().unwrap();
    tool.move_and_wait(1.0, 1000.0).unwrap();

    let bad = Program::new(&[], bounds);
    let error = tool.run_experiment(&bad, 2).unwrap_err();
    assert_eq!(error.refusal(), Some(Refusal::WrongProgram));
}

#[test]
fn an_axis_without_troubles_says_so() {
    let mut tool = ready();
    assert_eq!(tool.fault_page().unwrap(), None);
    let counters = tool.tick_counters().unwrap();
    assert!(counters.ticks > 0 && counters.late == 0 && counters.lost_records == 0);
    assert_eq!(tool.learning().unwrap().phase, LearningPhase::None);
    assert_eq!(tool.stored(Kind::EncoderMap).unwrap().length, 0);
    tool.learn(2_000).unwrap();
    assert_eq!(tool.learning().unwrap().phase, LearningPhase::BetweenRuns);
    // There is no map without a run.
    let error = tool.finish_learning().unwrap_err();
    assert_eq!(error.refusal(), Some(Refusal::LearningRefused));
    tool.end_learning().unwrap();
}

#[test]
fn what_was_saved_is_there_after_a_restart() {
    let mut tool = ready();
    tool.disable().unwrap();
    let set = |tool: &mut Axis, value| tool.set_parameter("motion.max_feed_mm_per_min", value);
    set(&mut tool, 5000.0).unwrap();
    tool.save_parameters().unwrap();
    set(&mut tool, 4000.0).unwrap();
    tool.restart().unwrap();
    let feed = tool.parameter("motion.max_feed_mm_per_min").unwrap();
    assert_eq!(feed.number(), Some(5000.0));
    assert!(tool.stored(Kind::Parameters).unwrap().length > 0);
    tool.enable().unwrap();
    tool.move_and_wait(2.0, 1000.0).unwrap();
}
