//! Ticks that were missed and values that jumped are told, and those that left the ring are not.

use leadscrew::scope::{
    Interrupted, Interruption, MOST_INTERRUPTIONS, Scope, Setup, Signal, Signals, Trigger,
};

use crate::puppet::{Pull, Puppet};

fn setup(samples: u32) -> Setup {
    Setup {
        signals: Signals::new(&[Signal::Velocity, Signal::ReportedPosition]).unwrap(),
        every: 1,
        trigger: Trigger::Force,
        pre: samples - 1,
        samples,
    }
}

/// Interruptions of a scope of 20 samples in 100 ticks, told as missed before the ticks `at`.
fn missed_at(at: &[u32]) -> (Vec<Interrupted>, bool) {
    let mut memory = [0; 40];
    let mut scope = Scope::new(&mut memory, &setup(20)).unwrap();
    let mut puppet = Puppet::new(0);
    for tick in 0..100 {
        puppet.step(&Pull::default());
        if at.contains(&tick) {
            scope.miss(tick);
        }
        scope.take(&puppet.axis);
    }
    scope.stop();
    let recording = scope.recording().unwrap();
    assert_eq!(recording.first_tick(), 80);
    (recording.interruptions().collect(), recording.is_torn())
}

fn missed(sample: u32, ticks: u32) -> Interrupted {
    Interrupted {
        sample,
        what: Interruption::Missed { ticks },
    }
}

#[test]
fn those_that_left_the_ring_make_room_for_later_ones() {
    let (found, is_torn) = missed_at(&[3, 7, 12, 30, 31, 32, 60, 79, 80, 81, 99]);
    // The first sample is that of tick 80: what came before it does not count.
    assert_eq!(found, [missed(1, 81), missed(19, 99)]);
    assert!(!is_torn);
}

#[test]
fn more_than_can_be_kept_are_told_as_such() {
    let at: Vec<_> = (81..=80 + MOST_INTERRUPTIONS as u32).collect();
    let (found, is_torn) = missed_at(&at);
    assert_eq!((found.len(), is_torn), (MOST_INTERRUPTIONS, false));
    let (found, is_torn) = missed_at(&[&at[..], &[95]].concat());
    assert_eq!((found.len(), is_torn), (MOST_INTERRUPTIONS, true));
    let (_, is_torn) = missed_at(&[1, 2, 3, 4, 5, 6, 7, 8]);
    assert!(!is_torn, "they have left the ring");
}

#[test]
fn one_before_the_first_sample_of_the_ring_has_left_it() {
    let is_torn = |at: [u32; 5]| {
        let mut memory = [0; 40];
        let mut scope = Scope::new(&mut memory, &setup(20)).unwrap();
        let mut puppet = Puppet::new(0);
        for tick in 0..=20 {
            puppet.step(&Pull::default());
            scope.miss(at.into_iter().filter(|at| *at == tick).count() as u32);
            scope.take(&puppet.axis);
        }
        scope.stop();
        scope.recording().unwrap().is_torn()
    };
    // The ring then has the samples 1 to 20.
    assert!(!is_torn([1, 5, 6, 7, 20]));
    assert!(is_torn([2, 5, 6, 7, 20]));
}

#[test]
fn an_origin_that_is_set_is_a_jump_and_the_values_around_it_are_exact() {
    let mut memory = [0; 24];
    let mut scope = Scope::new(&mut memory, &setup(12)).unwrap();
    let mut puppet = Puppet::new(0);
    let mut given = Vec::new();
    for tick in 0..12 {
        let row = puppet.step(&Pull {
            delta: 1000,
            // 40 000 d: more than half of what a low word of a position holds.
            origin: (tick == 6).then_some(40_000),
            ..Pull::default()
        });
        given.push(row.value(Signal::ReportedPosition));
        scope.take(&puppet.axis);
    }
    scope.stop();
    let recording = scope.recording().unwrap();
    let jump = Interrupted {
        sample: 6,
        what: Interruption::Jump {
            signal: 1,
            from: given[5],
            to: given[6],
        },
    };
    assert_eq!(recording.interruptions().collect::<Vec<_>>(), [jump]);
    assert!(given[6] - given[5] < -(1 << 31));
    assert_eq!(recording.bases()[..2], [0, given[0]]);
}

#[test]
fn a_tick_that_was_not_taken_shows() {
    let mut memory = [0; 20];
    let mut scope = Scope::new(&mut memory, &setup(10)).unwrap();
    let mut puppet = Puppet::new(0);
    for tick in 0..8 {
        puppet.step(&Pull::default());
        if tick != 3 && tick != 4 {
            scope.take(&puppet.axis);
        }
    }
    scope.stop();
    let recording = scope.recording().unwrap();
    assert_eq!(
        recording.interruptions().collect::<Vec<_>>(),
        [missed(3, 2)]
    );
    assert_eq!((recording.len(), recording.first_tick()), (6, 0));
}
