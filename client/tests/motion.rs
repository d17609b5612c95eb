//! Connect, enable, move, read: an axis through its client.

mod support;

use std::time::Duration;

use leadscrew::protocol::refusal::Refusal;
use leadscrew::supervisor::{Fault, State};
use leadscrew_client::{Axis, Error, Options};
use support::{BenchLine, seeded_options};

fn connected() -> (BenchLine, Axis) {
    let line = BenchLine::new();
    let axis = line.open(Options::default());
    (line, axis)
}

fn near(value: f64, expected: f64, within: f64) {
    assert!(
        (value - expected).abs() <= within,
        "{value}, not {expected}"
    );
}

#[test]
fn an_axis_is_enabled_moved_and_read() {
    let (line, mut axis) = connected();
    assert_eq!(axis.identity().board, "simulated");
    assert_eq!(
        (axis.identity().tick_hz, axis.identity().lease_ticks),
        (1000, 100)
    );
    assert!(axis.identity().can_home() && !axis.identity().can_record());
    assert_eq!(axis.status().unwrap().state(), Some(State::Disabled));

    let status = axis.enable().unwrap();
    assert!(status.is_enabled && status.is_leased_here && status.is_planned);
    let status = axis.move_and_wait(25.5, 6000.0).unwrap();
    near(status.setpoint_mm, 25.5, 1e-6);
    near(status.position_mm, 25.5, 0.05);
    near(
        status.following_error_mm,
        status.setpoint_mm - status.position_mm,
        1e-6,
    );

    axis.move_to(-10.0, 3000.0).unwrap();
    axis.wait(Duration::from_millis(300)).unwrap();
    let status = axis.status().unwrap();
    assert!(status.is_moving, "{status:?}");
    near(status.velocity_mm_per_min, -3000.0, 150.0);
    near(axis.wait_for_rest().unwrap().setpoint_mm, -10.0, 1e-6);
    // At once after the order, which begins a few ticks later.
    axis.move_to(0.0, 3000.0).unwrap();
    near(axis.wait_for_rest().unwrap().setpoint_mm, 0.0, 1e-6);
    let status = axis.disable().unwrap();
    assert!(!status.is_enabled);
    axis.close().unwrap();
    let statistics = line.open(Options::default()).link_statistics().unwrap();
    assert_eq!(statistics.axis, Default::default());
    let (low, high) = line.bench.borrow().extent_mm();
    near(low, -10.0, 1e-3);
    near(high, 25.5, 1e-3);
}

#[test]
fn hold_and_resume_override_jog_and_stop() {
    let (_line, mut axis) = connected();
    axis.enable().unwrap();
    axis.move_to(40.0, 3000.0).unwrap();
    axis.wait(Duration::from_millis(200)).unwrap();
    axis.hold().unwrap();
    let held = axis.wait_for_rest().unwrap();
    assert!(
        held.is_held && held.setpoint_mm > 1.0 && held.setpoint_mm < 30.0,
        "{held:?}"
    );
    // Longer than any lease: it is kept.
    axis.wait(Duration::from_millis(500)).unwrap();
    axis.set_override(50).unwrap();
    axis.resume().unwrap();
    axis.wait(Duration::from_millis(200)).unwrap();
    let status = axis.status().unwrap();
    assert_eq!((status.override_percent, status.is_held), (50, false));
    near(status.velocity_mm_per_min, 1500.0, 100.0);
    near(axis.wait_for_rest().unwrap().setpoint_mm, 40.0, 1e-6);

    axis.set_override(100).unwrap();
    axis.jog(-1200.0).unwrap();
    axis.wait(Duration::from_millis(400)).unwrap();
    near(axis.status().unwrap().velocity_mm_per_min, -1200.0, 100.0);
    let stopped = axis.stop().unwrap();
    assert!(
        stopped.setpoint_mm < 39.0 && stopped.state() == Some(State::Ready),
        "{stopped:?}"
    );
}

#[test]
fn what_is_refused_says_what_the_limits_are() {
    let (_line, mut axis) = connected();
    let error = axis.move_to(1.0, 100.0).unwrap_err();
    assert_eq!(error.refusal(), Some(Refusal::NotEnabled));
    axis.enable().unwrap();
    let error = axis.move_to(1.0, 50_000.0).unwrap_err();
    let text = error.to_string();
    assert!(
        text.starts_with("A move to 1 mm with 50000 mm/min was refused: ")
            && text.ends_with("Here motion.max_feed_mm_per_min is 9000 mm/min."),
        "{text}"
    );
    for (target, feed) in [
        (f64::NAN, 1.0),
        (1.0, f64::INFINITY),
        (1e300, 1.0),
        (1.0, -5.0),
    ] {
        let error = axis.move_to(target, feed).unwrap_err();
        assert!(matches!(error, Error::NoNumber { .. }), "{error}");
    }
    assert!(!axis.status().unwrap().is_moving);
}

#[test]
fn a_fault_ends_whatever_waits() {
    let (line, mut axis) = connected();
    axis.enable().unwrap();
    axis.move_to(20.0, 1200.0).unwrap();
    line.bench.borrow_mut().emergency_stop = true;
    let error = axis.wait_for_rest().unwrap_err();
    let text = error.to_string();
    assert!(matches!(error, Error::Faulted(number) if number == Fault::EmergencyStop as u8));
    assert!(
        text.contains("EmergencyStop") && text.contains("clear"),
        "{text}"
    );
    let error = axis.enable().unwrap_err();
    assert_eq!(error.refusal(), Some(Refusal::FaultLatched));

    line.bench.borrow_mut().emergency_stop = false;
    axis.disable().unwrap();
    axis.clear_fault().unwrap();
    axis.enable().unwrap();
    near(
        axis.move_and_wait(5.0, 1200.0).unwrap().setpoint_mm,
        5.0,
        1e-6,
    );
}

#[test]
fn an_enabled_axis_is_given_back_and_taken_over() {
    let (line, mut axis) = connected();
    axis.enable().unwrap();
    drop(axis);
    line.run(1000);
    assert_eq!(line.bench.borrow().state(), State::Ready);
    let mut axis = line.open(Options::default());
    assert!(!axis.status().unwrap().is_leased);
    near(
        axis.move_and_wait(3.0, 1200.0).unwrap().setpoint_mm,
        3.0,
        1e-6,
    );

    // One that is dropped on its way stops by itself.
    axis.move_to(200.0, 6000.0).unwrap();
    drop(axis);
    line.run(1500);
    let bench = line.bench.borrow();
    assert_eq!(bench.state(), State::Disabled);
    assert!(bench.extent_mm().1 < 40.0);
}

#[test]
fn the_same_seed_gives_the_same_run() {
    let run = || {
        let line = BenchLine::new();
        let mut axis = line.open(seeded_options(7));
        axis.enable().unwrap();
        axis.move_and_wait(4.0, 2400.0).unwrap();
        drop(axis);
        let bench = line.bench.borrow();
        (bench.trace.len(), bench.outputs().estimate)
    };
    assert_eq!(run(), run());
}

#[test]
fn the_origin_is_found_and_kept() {
    let (_line, mut axis) = connected();
    axis.enable().unwrap();
    // Without a switch: it is told how that ended, once it stands.
    let error = axis.home().unwrap_err();
    assert!(
        matches!(error, Error::Faulted(number) if number == Fault::HomingFailed as u8),
        "{error}"
    );
    drop(axis);

    let line = BenchLine::with_home_switch(-34.0);
    let mut axis = line.open(Options::default());
    axis.set_parameter("homing.search_direction", -1.0).unwrap();
    axis.enable().unwrap();
    axis.move_and_wait(-20.0, 6000.0).unwrap();
    let status = axis.home().unwrap();
    assert!(status.is_homed && status.is_planned, "{status:?}");
    let origin = line.bench.borrow().way.axis.homing().origin().unwrap();
    axis.move_and_wait(2.0, 1200.0).unwrap();
    let at: f64 = line.bench.borrow().outputs().setpoint.position.to_num();
    let origin: f64 = origin.to_num();
    let mm = (at - origin) / line.bench.borrow().counts_per_mm;
    near(mm, 2.0, 1e-3);
    // Again, from where it is.
    assert!(axis.home().unwrap().is_homed);
    axis.disable().unwrap();
    let error = axis.home().unwrap_err();
    assert_eq!(error.refusal(), Some(Refusal::NotReady));
}
