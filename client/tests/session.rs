//! Sessions that end, leases that lapse, tools that are interrupted.

mod support;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use leadscrew::supervisor::State;
use leadscrew_client::{Axis, Error, Options};
use support::{Bench, BenchLine, seeded_options};

const MS: fn(u64) -> Duration = Duration::from_millis;

fn enabled(line: &BenchLine) -> Axis {
    let mut axis = line.open(Options::default());
    axis.enable().unwrap();
    axis
}

#[test]
fn an_axis_that_never_answers_is_lost_in_the_stated_time_of_the_line() {
    let line = BenchLine::new();
    line.is_cut.set(true);
    let Err(error) = Axis::open(line.clone(), Options::default()) else {
        panic!("opened");
    };
    assert!(
        matches!(&error, Error::Lost { after, .. } if (MS(10_000)..MS(10_005)).contains(after))
    );
    assert!(error.is_lost());
    let text = error.to_string();
    assert!(
        text.contains("bench") && text.contains("baud rate"),
        "{text}"
    );
    assert_eq!(line.bench.borrow().trace.len(), 10_000);
}

#[test]
fn a_cut_line_stops_the_axis_and_another_session_goes_on() {
    let line = BenchLine::new();
    let mut axis = enabled(&line);
    axis.move_to(300.0, 6000.0).unwrap();
    axis.wait(MS(500)).unwrap();
    line.is_cut.set(true);
    let at = line.bench.borrow().trace.len();
    let error = axis.wait_for_rest().unwrap_err();
    assert!(error.is_lost(), "{error}");
    {
        let bench = line.bench.borrow();
        // Known to be lost within a second of the last answer; stopped long before.
        assert!(bench.trace.len() - at <= 1050, "{}", bench.trace.len() - at);
        assert_eq!(bench.state(), State::Disabled);
        let moving = bench.trace[at..].windows(2);
        let last = moving
            .enumerate()
            .rfind(|(_, pair)| pair[0].1 && pair[0].0 != pair[1].0);
        let (stopped, _) = last.unwrap();
        assert!(stopped < 500, "{stopped}");
    }
    line.is_cut.set(false);
    axis.reconnect().unwrap();
    let error = axis.move_to(0.0, 1000.0).unwrap_err();
    assert!(matches!(error, Error::LeaseLapsed), "{error}");
    axis.enable().unwrap();
    axis.move_and_wait(50.0, 6000.0).unwrap();
}

#[test]
fn a_tool_that_slept_is_told_that_its_lease_has_lapsed() {
    let line = BenchLine::new();
    let mut axis = enabled(&line);
    line.run(2000);
    // Asking is no order.
    assert_eq!(axis.status().unwrap().state(), Some(State::Disabled));
    let error = axis.move_to(5.0, 1000.0).unwrap_err();
    assert!(matches!(error, Error::LeaseLapsed), "{error}");
    assert!(error.to_string().contains("enable"), "{error}");
    let error = axis.jog(100.0).unwrap_err();
    assert!(
        matches!(error, Error::LeaseLapsed),
        "told until it is enabled: {error}"
    );
    axis.enable().unwrap();
    axis.move_and_wait(5.0, 1000.0).unwrap();

    // While it waits too.
    axis.move_to(200.0, 1000.0).unwrap();
    line.run(150);
    let error = axis.wait_for_rest().unwrap_err();
    assert!(matches!(error, Error::LeaseLapsed), "{error}");
}

#[test]
fn work_is_done_while_the_lease_is_kept() {
    let line = BenchLine::new();
    let mut axis = enabled(&line);
    axis.jog(600.0).unwrap();
    let (done, ticks) = (AtomicBool::new(false), line.bench.borrow().trace.len());
    let sum = axis
        .keep_alive_while(|| {
            std::thread::sleep(MS(30));
            done.store(true, Ordering::Relaxed);
            (1..=100_u64).sum::<u64>()
        })
        .unwrap();
    assert_eq!((sum, done.load(Ordering::Relaxed)), (5050, true));
    assert!(line.bench.borrow().trace.len() > ticks);
    let status = axis.status().unwrap();
    assert!(status.is_leased_here && status.is_moving);
}

#[test]
fn an_axis_in_lockstep_waits_for_the_work() {
    let mut line = BenchLine::new();
    line.is_lockstep = true;
    let mut axis = enabled(&line);
    let ticks = line.bench.borrow().trace.len();
    let thread = std::thread::current().id();
    let same = axis.keep_alive_while(|| std::thread::current().id() == thread);
    assert!(same.unwrap());
    assert_eq!(line.bench.borrow().trace.len(), ticks);
    axis.move_and_wait(1.0, 600.0).unwrap();
}

#[test]
fn another_tool_takes_the_session_over() {
    let line = BenchLine::new();
    let mut first = enabled(&line);
    first.move_to(300.0, 6000.0).unwrap();
    first.wait(MS(300)).unwrap();
    let mut second = line.open(Options::default());
    let error = first.wait_for_rest().unwrap_err();
    assert!(matches!(error, Error::SessionTaken), "{error}");
    assert!(error.is_lost());
    // The lease of the one before lapses, which is waited for.
    second.enable().unwrap();
    assert!(second.status().unwrap().is_leased_here);
}

#[test]
fn an_axis_that_was_switched_off_and_on_is_told_of() {
    let line = BenchLine::new();
    let mut axis = enabled(&line);
    *line.bench.borrow_mut() = Bench::new();
    let error = axis.status().unwrap_err();
    assert!(matches!(error, Error::Restarted), "{error}");
    axis.reconnect().unwrap();
    axis.enable().unwrap();
}

#[test]
fn a_nonce_of_before_opens_a_new_session_all_the_same() {
    let line = BenchLine::new();
    for seed in [5, 6, 5, 5] {
        let mut axis = line.open(seeded_options(seed));
        axis.enable().unwrap();
        axis.disable().unwrap();
    }
}

#[test]
fn an_interruption_stops_the_axis_first() {
    let line = BenchLine::new();
    let flag = Arc::new(AtomicBool::new(false));
    let options = Options {
        interrupted: Some(Arc::clone(&flag)),
        ..Options::default()
    };
    let mut axis = line.open(options);
    axis.enable().unwrap();
    axis.move_to(300.0, 6000.0).unwrap();
    axis.wait(MS(400)).unwrap();
    assert!(axis.status().unwrap().is_moving);
    flag.store(true, Ordering::Relaxed);
    let error = axis.wait_for_rest().unwrap_err();
    assert!(
        matches!(error, Error::Interrupted { stands: true }),
        "{error}"
    );
    assert_eq!(line.bench.borrow().state(), State::Ready);
    assert!(!line.bench.borrow().outputs().moving);
    let (_, farthest) = line.bench.borrow().extent_mm();
    assert!(farthest < 80.0, "{farthest}");
    // No order comes after it, but the axis may be put out of control.
    let error = axis.move_to(0.0, 1000.0).unwrap_err();
    assert!(
        matches!(error, Error::Interrupted { stands: true }),
        "{error}"
    );
    flag.store(false, Ordering::Relaxed);
    axis.disable().unwrap();

    // Who has moved nothing stops nothing.
    axis.close().unwrap();
    let enables = line.bench.borrow().way.enables;
    let mut watcher = line.open(Options {
        interrupted: Some(Arc::clone(&flag)),
        ..Options::default()
    });
    flag.store(true, Ordering::Relaxed);
    let error = watcher.wait(MS(100)).unwrap_err();
    assert!(
        matches!(error, Error::Interrupted { stands: true }),
        "{error}"
    );
    let error = watcher.enable().unwrap_err();
    assert!(matches!(error, Error::Interrupted { .. }), "{error}");
    assert_eq!(line.bench.borrow().way.enables, enables);
}
