//! The part before the trigger, wherever in the ring the trigger comes, and force.

use leadscrew::scope::{Scope, Setup, Signal, Signals, State, Trigger};

use crate::puppet::{Pull, Puppet};

const SAMPLES: u32 = 7;

fn setup(trigger: Trigger, pre: u32, every: u16) -> Setup {
    Setup {
        signals: Signals::new(&[Signal::Tick, Signal::Count]).unwrap(),
        every,
        trigger,
        pre,
        samples: SAMPLES,
    }
}

/// Ticks of the samples of a scope that is triggered before tick `at` of 64.
fn ticks(setup: &Setup, at: u32) -> (State, Vec<u32>, Option<u32>) {
    let mut memory = [0; 2 * SAMPLES as usize];
    let mut scope = Scope::new(&mut memory, setup).unwrap();
    let mut puppet = Puppet::new(0);
    for tick in 0..64 {
        puppet.step(&Pull {
            delta: 1,
            ..Pull::default()
        });
        if tick == at {
            scope.trigger();
        }
        scope.take(&puppet.axis);
        assert_eq!(scope.recording().is_some(), scope.is_over());
    }
    let state = scope.state();
    scope.stop();
    let recording = scope.recording().unwrap();
    let ticks = recording.samples().map(|words| words[0].cast_unsigned());
    (state, ticks.collect(), recording.trigger_sample())
}

#[test]
fn it_is_as_long_as_asked_for_at_every_place_of_the_ring() {
    for pre in 0..SAMPLES {
        for at in 0..40 {
            let (state, found, trigger) = ticks(&setup(Trigger::Force, pre, 1), at);
            let before = pre.min(at);
            let expected: Vec<_> = (at - before..at - before + SAMPLES).collect();
            assert_eq!((state, found), (State::Complete, expected), "{pre} {at}");
            assert_eq!(trigger, Some(before));
        }
    }
}

#[test]
fn a_trigger_between_two_samples_is_that_of_the_next() {
    for at in 0..24 {
        let (state, found, trigger) = ticks(&setup(Trigger::Force, 3, 4), at);
        let sample = at.div_ceil(4);
        let before = sample.min(3);
        let first = sample - before;
        let expected: Vec<_> = (first..first + SAMPLES).map(|sample| sample * 4).collect();
        assert_eq!((state, found), (State::Complete, expected), "{at}");
        assert_eq!(trigger, Some(before));
    }
}

#[test]
fn stopped_without_a_trigger_it_has_the_newest_samples() {
    let (state, found, trigger) = ticks(&setup(Trigger::Force, 3, 1), u32::MAX);
    assert_eq!(state, State::Waiting);
    assert_eq!(found, (64 - SAMPLES..64).collect::<Vec<_>>());
    assert_eq!(trigger, None);
}

#[test]
fn stopped_behind_the_trigger_it_has_what_there_is() {
    let (state, found, trigger) = ticks(&setup(Trigger::Force, 3, 1), 62);
    assert_eq!(state, State::Triggered);
    assert_eq!(found, (59..64).collect::<Vec<_>>());
    assert_eq!(trigger, Some(3));
    // The trigger came behind the last sample.
    let (state, found, trigger) = ticks(&setup(Trigger::Force, 3, 7), 64 - 1 + 1);
    assert_eq!((state, trigger), (State::Waiting, None));
    assert_eq!(found.len(), SAMPLES as usize);
}

#[test]
fn a_trigger_whose_sample_did_not_come_is_told() {
    let mut memory = [0; 2 * SAMPLES as usize];
    let mut scope = Scope::new(&mut memory, &setup(Trigger::Force, 2, 4)).unwrap();
    let mut puppet = Puppet::new(0);
    for tick in 0..6 {
        puppet.step(&Pull::default());
        if tick == 5 {
            scope.trigger();
        }
        scope.take(&puppet.axis);
    }
    assert_eq!(scope.state(), State::Triggered);
    scope.stop();
    let recording = scope.recording().unwrap();
    assert_eq!(recording.trigger_tick(), Some(5));
    assert_eq!((recording.len(), recording.trigger_sample()), (2, Some(2)));
    assert_eq!(recording.first_tick(), 0);
}

#[test]
fn stopped_before_the_first_tick_it_is_empty() {
    let mut memory = [0; 2 * SAMPLES as usize];
    let mut scope = Scope::new(&mut memory, &setup(Trigger::Now, 2, 1)).unwrap();
    scope.miss(3);
    scope.stop();
    assert_eq!(scope.state(), State::Stopped);
    let recording = scope.recording().unwrap();
    assert!(recording.is_empty() && recording.sample(0).is_none());
    assert_eq!(recording.bases(), [0; 8]);
    assert_eq!(recording.interruptions().count(), 0);
}

#[test]
fn what_is_complete_stays_as_it_is() {
    let mut memory = [0; 2 * SAMPLES as usize];
    let mut scope = Scope::new(&mut memory, &setup(Trigger::Now, 0, 1)).unwrap();
    let mut puppet = Puppet::new(9);
    let mut told = None;
    for tick in 0..30 {
        puppet.step(&Pull {
            delta: 100,
            ..Pull::default()
        });
        scope.take(&puppet.axis);
        if let Some(recording) = scope.recording() {
            assert!(tick >= SAMPLES - 1);
            let now: Vec<_> = recording.samples().flatten().copied().collect();
            assert_eq!(told.get_or_insert_with(|| now.clone()), &now);
            assert_eq!(recording.first_tick(), 0);
        }
        if tick == 20 {
            scope.trigger();
            scope.stop();
            scope.miss(5);
        }
    }
    assert_eq!(scope.state(), State::Complete);
    assert_eq!(told.unwrap().len(), 14);
}
