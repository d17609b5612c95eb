//! Enabling and stopping, with a drive that takes its time and a brake that holds a load.

use leadscrew::supervisor::State;
use leadscrew_hal_mock::board::Converter;

use crate::rig::{Plan, Rig};

/// A vertical axis: its load sinks at 5 m/s² where nothing holds it.
fn vertical() -> Rig {
    let mut plan = Plan::full();
    plan.board.brake.fitted = 1.0;
    plan.board.brake.load_m_s2 = -5.0;
    plan.board.drive_lines.ready_after_s = 0.2;
    plan.supervisor.hold_before_release_s = 0.1;
    plan.supervisor.brake_release_s = 0.06;
    plan.supervisor.brake_delay_s = 0.06;
    plan.rig()
}

#[test]
fn with_default_times_an_enable_is_under_control_in_its_tick() {
    let outputs = Plan::full().rig().step();
    assert_eq!(outputs.state, State::Ready);
    assert!(outputs.enabled && outputs.brake_released);
    assert_eq!(outputs.command.to_bits(), 0);
}

#[test]
fn enabling_waits_for_the_drive_then_holds_then_opens_the_brake() {
    let mut rig = vertical();
    rig.enable = false;
    rig.run(100);
    rig.enable = true;
    let mut seen = Vec::new();
    for tick in 1..=500 {
        let outputs = rig.step();
        let now = (outputs.state, outputs.enabled, outputs.brake_released);
        if seen.last().is_none_or(|&(_, last)| last != now) {
            seen.push((tick, now));
        }
    }
    let states: Vec<_> = seen.iter().map(|&(_, now)| now).collect();
    assert_eq!(
        states,
        [
            (State::Enabling, true, false),
            (State::Enabling, true, true),
            (State::Ready, true, true)
        ]
    );
    let [_, released, ready] = seen[..] else {
        panic!()
    };
    assert!(
        (300..=302).contains(&released.0),
        "brake opens at {released:?}"
    );
    assert_eq!(ready.0 - released.0, 60);
    assert!(rig.shaft().abs() < 5.0, "sank to {}", rig.shaft());
}

#[test]
fn a_load_does_not_sink_through_enable_move_stop_and_emergency() {
    let mut rig = vertical();
    rig.until(1000, |outputs| outputs.state == State::Ready);
    rig.go(20.0);
    rig.run(1000);
    let there = rig.shaft();
    rig.enable = false;
    let ticks = rig.until(200, |outputs| !outputs.enabled);
    assert!((60..=62).contains(&ticks), "enable off after {ticks} ticks");
    rig.run(500);
    assert!(
        (rig.shaft() - there).abs() < 60.0,
        "sank by {}",
        rig.shaft() - there
    );
    rig.enable = true;
    rig.until(1000, |outputs| outputs.state == State::Ready);
    let there = rig.shaft();
    rig.board.trouble.emergency_stop = true;
    rig.step();
    assert!(
        rig.axis.outputs().brake_released,
        "the drive carries it at first"
    );
    let ticks = rig.until(1000, |outputs| !outputs.enabled);
    assert_eq!(ticks, 560);
    rig.run(500);
    // At 0 V the drive turns by its offset: 0.8 d/tick at most, less what friction holds.
    assert!(
        (rig.shaft() - there).abs() < 450.0,
        "sank by {}",
        rig.shaft() - there
    );
}

#[test]
fn taking_enable_back_in_motion_is_a_controlled_stop() {
    let mut rig = Plan::full().rig();
    rig.at_full_speed();
    rig.enable = false;
    let outputs = rig.run(2);
    assert_eq!((outputs.state, outputs.fault), (State::Stopping, None));
    assert!(outputs.setpoint.acceleration.to_bits() < 0);
    let ticks = rig.until(300, |outputs| !outputs.enabled);
    assert!((250..=262).contains(&ticks), "{ticks}");
    assert_eq!(rig.axis.outputs().state, State::Disabled);
    rig.enable = true;
    assert_eq!(rig.run(600).state, State::Ready);
}

#[test]
fn a_stop_that_takes_too_long_ends_at_zero_volts_without_a_fault() {
    let mut plan = Plan::full();
    plan.supervisor.stop_timeout_s = 0.1;
    let mut rig = plan.rig();
    rig.at_full_speed();
    rig.enable = false;
    let ticks = rig.until(200, |outputs| outputs.command.to_bits() == 0);
    assert!((100..=102).contains(&ticks), "{ticks}");
    assert_eq!(rig.axis.outputs().state, State::Stopping);
    rig.until(600, |outputs| !outputs.enabled);
    assert_eq!(
        (rig.axis.outputs().state, rig.axis.outputs().fault),
        (State::Disabled, None)
    );
}

#[test]
fn enable_taken_back_before_the_drive_is_ready_is_no_fault() {
    let mut rig = vertical();
    assert_eq!(rig.run(100).state, State::Enabling);
    rig.enable = false;
    let outputs = rig.step();
    assert_eq!(
        (outputs.state, outputs.enabled, outputs.fault),
        (State::Disabled, false, None)
    );
}

#[test]
fn a_small_error_of_the_converter_is_tolerated() {
    let mut rig = Plan::full().rig();
    rig.board.trouble.converter = Converter::OffBy(leadscrew::units::Command::lit("0.005"));
    rig.run(1000);
    rig.go(20.0);
    assert_eq!(rig.run(1000).fault, None);
}
