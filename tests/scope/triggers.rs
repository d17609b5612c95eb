//! Triggers at the ends of what they are for; `any` compares all of them with the model.

use leadscrew::scope::{Scope, Setup, Side, Signal, Signals, Slope, State, Trigger};
use leadscrew::supervisor::Fault;

use crate::puppet::{Pull, Puppet};

/// The tick of the trigger, of the ticks that `pulls` make.
fn tick_of(trigger: Trigger, pulls: &[Pull]) -> Option<u32> {
    let setup = Setup {
        signals: Signals::new(&[Signal::Count]).unwrap(),
        every: 1000,
        trigger,
        pre: 0,
        samples: 4,
    };
    let mut memory = [0; 4];
    let mut scope = Scope::new(&mut memory, &setup).unwrap();
    let mut puppet = Puppet::new(0);
    for pull in pulls {
        puppet.step(pull);
        scope.take(&puppet.axis);
        if scope.state() == State::Triggered {
            return Some(puppet.axis.outputs().tick);
        }
    }
    None
}

fn moved(delta: i32) -> Pull {
    Pull {
        delta,
        ..Pull::default()
    }
}

fn edge(slope: Slope, level: i64) -> Trigger {
    Trigger::Edge {
        signal: Signal::Position,
        level,
        slope,
    }
}

#[test]
fn an_edge_of_a_position_is_not_seen_where_only_its_low_word_wraps() {
    // Up over 32 768 d and 65 536 d, where low words change their sign and begin anew, and back.
    let mut pulls = vec![moved(1000); 100];
    pulls.extend([moved(-1000); 120]);
    let at = |d: i64| d << 16;
    assert_eq!(tick_of(edge(Slope::Falling, at(-5000)), &pulls), Some(205));
    assert_eq!(tick_of(edge(Slope::Rising, at(70_000)), &pulls), Some(69));
    assert_eq!(tick_of(edge(Slope::Falling, at(70_000)), &pulls), Some(130));
    assert_eq!(tick_of(edge(Slope::Either, at(110_000)), &pulls), None);
}

#[test]
fn an_edge_needs_a_tick_before_it_and_a_level_does_not() {
    let pulls = [moved(0), moved(500), moved(500)];
    let level = |side, level| Trigger::Level {
        signal: Signal::Position,
        level,
        side,
    };
    assert_eq!(tick_of(edge(Slope::Either, -1), &pulls), None);
    assert_eq!(tick_of(level(Side::Above, -1), &pulls), Some(0));
    assert_eq!(tick_of(level(Side::Below, -1), &pulls), None);
    assert_eq!(tick_of(level(Side::Above, 600 << 16), &pulls), Some(2));
    assert_eq!(tick_of(Trigger::Now, &pulls), Some(0));
}

#[test]
fn a_fault_triggers_in_its_tick_and_one_that_stands_does_not() {
    let on = Pull {
        enable: true,
        ..Pull::default()
    };
    let faulty = Pull {
        drive_fault: true,
        ..on
    };
    let pulls = [&[on; 100][..], &[faulty; 5]].concat();
    let drive = Trigger::Fault(Some(Fault::DriveFault));
    assert_eq!(tick_of(Trigger::Fault(None), &pulls), Some(100));
    assert_eq!(tick_of(drive, &pulls), Some(100));
    let other = Trigger::Fault(Some(Fault::EncoderLoss));
    assert_eq!(tick_of(other, &pulls), None);

    let mut puppet = Puppet::new(0);
    pulls.iter().for_each(|pull| _ = puppet.step(pull));
    let setup = Setup {
        signals: Signals::new(&[Signal::Fault]).unwrap(),
        every: 1,
        trigger: Trigger::Fault(None),
        pre: 0,
        samples: 4,
    };
    let mut memory = [0; 4];
    let mut scope = Scope::new(&mut memory, &setup).unwrap();
    for _ in 0..20 {
        puppet.step(&faulty);
        scope.take(&puppet.axis);
    }
    assert_eq!(scope.state(), State::Waiting);
}
