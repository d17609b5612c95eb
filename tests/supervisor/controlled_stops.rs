//! Faults that are answered by a controlled stop.

use leadscrew::supervisor::{Fault, State};
use leadscrew_hal_mock::faults::{Bursts, Fault as EncoderFault};

use crate::rig::Plan;

#[test]
fn what_sources_and_homing_find_stops_the_axis_within_plan() {
    for fault in [
        Fault::SoftLimit,
        Fault::SetpointLost,
        Fault::SpindleLost,
        Fault::HomingFailed,
    ] {
        let mut rig = Plan::full().rig();
        rig.at_full_speed();
        rig.axis.supervisor_mut().report(fault);
        rig.step();
        rig.assert_controlled_stop(fault);
    }
}

#[test]
fn interference_on_both_channels_stops_the_axis_at_the_transition_that_is_too_many() {
    let mut rig = Plan::full().rig();
    rig.at_full_speed();
    let bursts = Bursts::at(300.0, 84e6);
    rig.board
        .break_encoder(EncoderFault::IllegalTransitions(bursts), 0..100_000)
        .unwrap();
    // Six transitions a burst, a burst every 3.3 ticks: the eleventh is in the second burst.
    let ticks = rig.until(10, |outputs| outputs.fault.is_some());
    assert!((4..=6).contains(&ticks), "after {ticks} ticks");
    assert!(rig.axis.capture_health().illegal >= 11);
    rig.assert_controlled_stop(Fault::IllegalTransitions);
}

#[test]
fn lost_and_doubled_edges_are_found_within_a_revolution() {
    for fault in [
        EncoderFault::LostEdges { every: 1000 },
        EncoderFault::DoubledEdges { every: 1000 },
    ] {
        let mut rig = Plan::full().rig();
        rig.at_full_speed();
        let start = rig.shaft();
        rig.board.break_encoder(fault, 0..100_000).unwrap();
        rig.until(300, |outputs| outputs.fault.is_some());
        let way = rig.shaft() - start;
        assert!(way < 10_200.0, "found after {way} d");
        assert!((rig.first().trip.value.to_num::<f64>().abs() - 10.0).abs() <= 9.0);
        rig.assert_controlled_stop(Fault::IndexInconsistent);
    }
}

#[test]
fn a_missing_index_is_found_after_a_revolution_and_a_quarter() {
    let mut plan = Plan::full();
    // The encoder has one in 10 000.
    plan.counts_per_revolution = 4000.0;
    let mut rig = plan.rig();
    rig.run(100);
    rig.go(300.0);
    rig.until(2000, |outputs| outputs.fault.is_some());
    let first = rig.first();
    assert_eq!(first.trip.limit.to_num::<f64>(), 5_000.0);
    let way: f64 = first.trip.value.to_num();
    assert!((5_000.0..5_200.0).contains(&way), "{way} d");
    assert_eq!(rig.axis.outputs().fault, Some(Fault::IndexNotFound));
}

#[test]
fn an_output_at_its_limit_for_a_second_stops_the_axis() {
    let mut plan = Plan::full();
    plan.output_limit = 0.3;
    plan.supervisor.following_error_mm = 1000.0;
    plan.supervisor.standstill_mm = 1000.0;
    let mut rig = plan.rig();
    rig.run(100);
    rig.go(300.0);
    let mut ticks = 0;
    while rig.axis.outputs().fault.is_none() {
        let limits = rig.step().limits;
        ticks = if limits.high && !limits.slew {
            ticks + 1
        } else {
            0
        };
    }
    assert!((1000..=1002).contains(&ticks), "after {ticks} ticks");
    rig.assert_controlled_stop(Fault::OutputSaturated);
}

#[test]
fn missed_ticks_stop_the_axis_when_they_are_too_many_at_once() {
    let mut rig = Plan::full().rig();
    rig.at_full_speed();
    for _ in 0..3 {
        rig.board.miss(1);
        rig.run(10);
        assert_eq!(rig.axis.outputs().state, State::Moving);
    }
    rig.board.miss(1);
    rig.step();
    rig.assert_controlled_stop(Fault::LateTick);
}

#[test]
fn a_stronger_reaction_acts_within_a_controlled_stop_and_the_first_fault_stays() {
    let mut rig = Plan::full().rig();
    rig.at_full_speed();
    rig.axis.supervisor_mut().report(Fault::SetpointLost);
    rig.run(50);
    assert_eq!(rig.axis.outputs().state, State::Stopping);
    let first = rig.first();
    rig.board.trouble.emergency_stop = true;
    let outputs = rig.step();
    assert_eq!(
        (outputs.state, outputs.fault),
        (State::Fault, Some(Fault::SetpointLost))
    );
    assert_eq!(outputs.command.to_bits(), 0);
    let now = rig.first();
    assert_eq!(
        (now.tick, now.trip, now.context),
        (first.tick, first.trip, first.context)
    );
    assert!(now.later.contains(Fault::EmergencyStop));
    rig.assert_zero_volts(Fault::SetpointLost, 8.0);
}

#[test]
fn an_encoder_lost_within_a_controlled_stop_cuts_to_zero_volts() {
    let mut plan = Plan::full();
    plan.machine.mount.coupling_slip = 1.0;
    plan.machine.mount.slip_from_s = 0.72;
    let mut rig = plan.rig();
    rig.at_full_speed();
    rig.axis.supervisor_mut().report(Fault::SetpointLost);
    rig.until(60, |outputs| outputs.state == State::Fault);
    assert!(rig.first().later.contains(Fault::FollowingError));
    rig.assert_zero_volts(Fault::SetpointLost, 8.0);
}
