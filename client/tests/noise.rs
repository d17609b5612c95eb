//! What a bad line does to an axis that is moved over it: no motion that was not asked, and an end that is told.

mod support;

use std::time::Duration;

use leadscrew::supervisor::State;
use leadscrew_client::noisy::{Done, Faults, Noisy};
use leadscrew_client::{Axis, Error, Options};
use support::BenchLine;

const MS: fn(u64) -> Duration = Duration::from_millis;

/// How a run over a bad line went.
#[derive(Debug, Default)]
struct Run {
    /// Moves that arrived.
    arrived: u32,
    /// Times that the axis was lost, or its lease lapsed, and it was connected to anew.
    ended: u32,
    done: Done,
    /// Moves that the axis took.
    taken: u32,
    /// Setpoints that the axis came to, mm.
    extent: (f64, f64),
}

const FARTHEST_MM: f64 = 30.0;

/// Twenty moves to and fro over a line with `faults`; each order that fails is told, and the tool begins anew.
fn run(faults: Faults, seed: u64) -> Run {
    let line = BenchLine::new();
    let noisy = Noisy::new(line.clone(), faults, seed);
    let done = noisy.done();
    let mut axis = connect(noisy);
    let mut run = Run::default();
    let mut targets = [10.0, -20.0, FARTHEST_MM, 0.0].into_iter().cycle().take(20);
    let mut target = targets.next();
    while let Some(target_mm) = target {
        assert!(run.ended < 400, "{run:?}");
        let moved = axis
            .enable()
            .and_then(|_| axis.move_and_wait(target_mm, 4000.0));
        match moved {
            Ok(status) => {
                assert!((status.setpoint_mm - target_mm).abs() < 1e-3, "{status:?}");
                run.arrived += 1;
                target = targets.next();
            }
            Err(Error::LeaseLapsed | Error::DisabledMeanwhile { .. }) => run.ended += 1,
            Err(error) if error.is_lost() => {
                run.ended += 1;
                reconnect(&mut axis);
            }
            Err(error) => panic!("{error}: {run:?}"),
        }
    }
    assert!(matches!(line.bench.borrow().state(), State::Ready));
    run.taken = line.bench.borrow().way.motions;
    run.extent = line.bench.borrow().extent_mm();
    run.done = done.get();
    run
}

/// A line that is bad loses hellos as well.
fn connect(line: Noisy<BenchLine>) -> Axis {
    Axis::open(line, Options::default()).unwrap()
}

fn reconnect(axis: &mut Axis) {
    let connected = (0..20).any(|_| axis.reconnect().is_ok());
    assert!(connected);
}

fn moved_nowhere_else(run: &Run) {
    let (low, high) = run.extent;
    // An axis that was disabled on its way coasts a little, and goes on from where it stands.
    assert!(low >= -20.05 && high <= FARTHEST_MM + 0.05, "{run:?}");
    assert_eq!(run.arrived, 20, "{run:?}");
    // Each was ordered once; some that were lost on the way are among those that ended.
    assert!(
        run.taken >= 20 && run.taken <= run.arrived + run.ended,
        "{run:?}"
    );
}

#[test]
fn a_good_line_takes_nothing_away() {
    let run = run(Faults::default(), 1);
    moved_nowhere_else(&run);
    assert_eq!(run.ended, 0);
}

#[test]
fn lost_frames_are_repeated() {
    let faults = Faults {
        drops: 0.05,
        ..Faults::default()
    };
    let run = run(faults, 2);
    moved_nowhere_else(&run);
    assert!(run.done.dropped > 20, "{run:?}");
    assert_eq!(run.ended, 0, "{run:?}");
}

#[test]
fn flipped_bits_do_nothing() {
    let faults = Faults {
        flips: 0.05,
        ..Faults::default()
    };
    let run = run(faults, 3);
    moved_nowhere_else(&run);
    assert!(run.done.flipped > 20, "{run:?}");
}

#[test]
fn doubled_and_delayed_frames_do_nothing_twice() {
    let faults = Faults {
        doubles: 0.1,
        delays: 0.05,
        delay: MS(30),
        ..Faults::default()
    };
    let run = run(faults, 4);
    moved_nowhere_else(&run);
    assert!(run.done.doubled > 20 && run.done.delayed > 20, "{run:?}");
}

#[test]
fn a_line_that_is_very_bad_stops_the_axis_and_is_told_of() {
    let faults = Faults {
        drops: 0.3,
        flips: 0.1,
        doubles: 0.1,
        delays: 0.1,
        delay: MS(60),
        ..Faults::default()
    };
    let run = run(faults, 5);
    moved_nowhere_else(&run);
    assert!(run.ended > 0, "the line was not bad enough: {run:?}");
}

#[test]
fn delays_longer_than_the_lease_hold_none() {
    let line = BenchLine::new();
    let faults = Faults {
        delays: 1.0,
        delay: MS(150),
        ..Faults::default()
    };
    let mut axis = connect(Noisy::new(line.clone(), faults, 6));
    let error = axis
        .enable()
        .and_then(|_| axis.move_and_wait(FARTHEST_MM, 1000.0))
        .unwrap_err();
    assert!(
        matches!(error, Error::LeaseLapsed | Error::DisabledMeanwhile { .. }),
        "{error}"
    );
    let (low, high) = line.bench.borrow().extent_mm();
    assert!(low > -0.1 && high < 0.5 * FARTHEST_MM, "{low} {high}");
}
