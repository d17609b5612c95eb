//! The way out of Fault.

use leadscrew::supervisor::{ClearError, Fault, State};
use leadscrew_hal_mock::board::DriveHealth;

use crate::rig::Plan;

#[test]
fn a_fault_is_cleared_only_at_rest_without_enable_and_without_its_cause() {
    let mut rig = Plan::full().rig();
    rig.at_full_speed();
    rig.board.trouble.emergency_stop = true;
    rig.run(2);
    assert_eq!(rig.clear(), Err(ClearError::EnableRequested));
    rig.enable = false;
    rig.run(2);
    assert_eq!(rig.clear(), Err(ClearError::Stopping));
    rig.run(600);
    assert_eq!(
        rig.clear(),
        Err(ClearError::CausePersists(Fault::EmergencyStop))
    );
    rig.board.trouble.emergency_stop = false;
    assert_eq!(
        rig.run(10).fault,
        Some(Fault::EmergencyStop),
        "it does not clear itself"
    );
    rig.clear().unwrap();
    let outputs = rig.step();
    assert_eq!((outputs.state, outputs.fault), (State::Disabled, None));
    rig.enable = true;
    assert_eq!(rig.step().state, State::Ready);
}

#[test]
fn a_fault_is_not_cleared_while_the_axis_runs_out() {
    let mut rig = Plan::full().rig();
    rig.at_full_speed();
    rig.board.trouble.drive = DriveHealth::Faulty;
    rig.step();
    rig.board.trouble.drive = DriveHealth::Good;
    rig.enable = false;
    rig.run(2);
    assert_eq!(rig.clear(), Err(ClearError::Moving));
    rig.run(400);
    rig.clear().unwrap();
}

#[test]
fn an_enable_in_fault_is_refused_and_told() {
    let mut rig = Plan::full().rig();
    rig.run(10);
    rig.board.trouble.drive = DriveHealth::Faulty;
    assert!(!rig.run(3).refused, "the enable was there before the fault");
    rig.board.trouble.drive = DriveHealth::Good;
    rig.enable = false;
    assert!(!rig.step().refused);
    rig.enable = true;
    let outputs = rig.run(5);
    assert!(outputs.refused && !outputs.enabled);
    assert_eq!(outputs.state, State::Fault);
}

#[test]
fn an_axis_whose_cause_is_there_at_enable_is_refused_before_the_drive_is_on() {
    let mut rig = Plan::full().rig();
    rig.enable = false;
    rig.board.trouble.emergency_stop = true;
    assert_eq!(rig.run(100).fault, None, "off, an open chain is no fault");
    rig.enable = true;
    let outputs = rig.step();
    assert_eq!(outputs.fault, Some(Fault::EmergencyStop));
    assert!(!outputs.enabled && outputs.refused);
}

#[test]
fn a_corrupt_store_refuses_enable_until_it_is_written_anew() {
    let mut rig = Plan::full().rig();
    rig.axis.supervisor_mut().set_store_corrupt(true);
    let outputs = rig.step();
    assert_eq!(
        (outputs.fault, outputs.enabled),
        (Some(Fault::StoreCorrupt), false)
    );
    rig.enable = false;
    rig.run(2);
    assert_eq!(
        rig.clear(),
        Err(ClearError::CausePersists(Fault::StoreCorrupt))
    );
    rig.axis.supervisor_mut().set_store_corrupt(false);
    rig.clear().unwrap();
    rig.enable = true;
    assert_eq!(rig.step().state, State::Ready);
}

#[test]
fn a_new_configuration_keeps_the_latched_fault() {
    let mut rig = Plan::full().rig();
    rig.at_full_speed();
    rig.board.trouble.drive = DriveHealth::Faulty;
    rig.step();
    let first = rig.first();
    let config = *rig.axis.config();
    rig.axis.reconfigure(&config).unwrap();
    rig.step();
    assert_eq!(
        (rig.first().trip, rig.first().tick),
        (first.trip, first.tick)
    );
    assert_eq!(rig.axis.outputs().state, State::Fault);
}

#[test]
fn the_peak_of_the_following_error_is_held_until_it_is_reset() {
    let mut rig = Plan::full().rig();
    rig.at_full_speed();
    rig.run(3000);
    let peak = rig.axis.supervisor().following_error_peak();
    assert!(peak > 50 << 16);
    rig.axis.supervisor_mut().reset_following_error_peak();
    rig.run(10);
    assert!(rig.axis.supervisor().following_error_peak() < peak);
}
