//! The scope on the simulated machine.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::scope::{Scope, Setup, Signal, Signals, Slope, State, Trigger, Unwrap};
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::{MoveAndBack, Simulation};

use crate::puppet::Row;

const SIGNALS: [Signal; 8] = [
    Signal::FollowingError,
    Signal::Velocity,
    Signal::SetpointVelocity,
    Signal::SetpointAcceleration,
    Signal::Command,
    Signal::Position,
    Signal::SetpointPosition,
    Signal::Flags,
];

/// A scope over the standard move there and back, and all that the axis gave.
fn record<'m>(memory: &'m mut [i32], setup: &Setup) -> (Scope<'m>, Vec<Row>) {
    let scenario = MoveAndBack::standard(1000.0);
    let machine = MachineParams::z_16k20f3();
    let estimator = EstimatorConfig::by_name("exponential").unwrap().unwrap();
    let mut simulation = Simulation::prepare(&scenario, &machine, estimator, 1).unwrap();
    let mut scope = Scope::new(memory, setup).unwrap();
    let mut rows = Vec::new();
    while simulation.step().unwrap().is_some() {
        scope.take(&simulation.axis);
        rows.push(Row::of(&simulation.axis));
    }
    (scope, rows)
}

/// Whole values of all samples are those of the ticks that the recording says.
fn assert_traces(scope: &Scope<'_>, rows: &[Row]) {
    let recording = scope.recording().unwrap();
    assert_eq!(recording.interruptions().count(), 0);
    let bases = SIGNALS.iter().zip(recording.bases());
    let mut whole: Vec<_> = bases.map(|(s, base)| Unwrap::new(*s, base)).collect();
    let every = usize::from(recording.setup().every);
    let ticks = (recording.first_tick() as usize..).step_by(every);
    for (words, tick) in recording.samples().zip(ticks) {
        for ((signal, word), whole) in SIGNALS.iter().zip(words).zip(&mut whole) {
            assert_eq!(whole.take(*word), rows[tick].value(*signal), "{signal}");
        }
    }
}

#[test]
fn a_move_is_recorded_from_before_its_first_tick() {
    let setup = Setup {
        signals: Signals::new(&SIGNALS).unwrap(),
        every: 1,
        trigger: Trigger::Command,
        pre: 50,
        samples: 1250,
    };
    let mut memory = vec![0; 10_000];
    let (scope, rows) = record(&mut memory, &setup);
    assert_eq!(scope.state(), State::Complete);
    let begun = rows.iter().position(|row| row.outputs.moving).unwrap();
    let recording = scope.recording().unwrap();
    assert_eq!(recording.trigger_tick(), Some(begun as u32));
    assert_eq!(recording.first_tick() as usize, begun - 50);
    assert_traces(&scope, &rows);
    let peak = |errors: &mut dyn Iterator<Item = i64>| errors.map(i64::abs).max();
    let of_scope = peak(&mut recording.samples().map(|words| words[0].into()));
    let first = begun - 50;
    let of_axis = rows[first..first + 1250].iter();
    let of_axis = peak(&mut of_axis.map(|row| row.value(Signal::FollowingError)));
    assert_eq!(of_scope, of_axis);
    assert!(of_axis > Some(1 << 16), "it moves: {of_axis:?}");
}

#[test]
fn the_whole_run_is_recorded_every_fifth_tick_across_the_wrap_of_positions() {
    let setup = Setup {
        signals: Signals::new(&SIGNALS).unwrap(),
        every: 5,
        trigger: Trigger::Edge {
            signal: Signal::Position,
            level: 200_000 << 16,
            slope: Slope::Falling,
        },
        pre: 800,
        samples: 1000,
    };
    let mut memory = vec![0; 8000];
    let (mut scope, rows) = record(&mut memory, &setup);
    scope.stop();
    let recording = scope.recording().unwrap();
    let passed = recording.trigger_tick().unwrap() as usize;
    let position = |tick: usize| rows[tick].value(Signal::Position);
    assert!(position(passed - 1) >= 200_000 << 16 && position(passed) < 200_000 << 16);
    let travel = (recording.first_tick() as usize..passed)
        .map(position)
        .max();
    assert!(travel > Some(290_000 << 16), "four wraps of a low word");
    assert_traces(&scope, &rows);
}
