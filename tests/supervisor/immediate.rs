//! Faults that are answered by 0 V or by enable off, in the tick that detects them.

use leadscrew::supervisor::{Fault, State};
use leadscrew::units::Command;
use leadscrew_hal_mock::board::{Converter, DriveHealth};
use leadscrew_hal_mock::faults::Fault as EncoderFault;

use crate::rig::{Plan, Rig};

/// The way in which the drive brakes from full speed at 2.1 d/tick², with its lag, mm.
const BRAKING_MM: f64 = 8.0;

fn at_full_speed() -> Rig {
    let mut rig = Plan::full().rig();
    rig.at_full_speed();
    rig
}

#[test]
fn a_drive_too_weak_trips_in_the_tick_in_which_the_error_passes_its_limit() {
    let mut plan = Plan::full();
    plan.machine.drive.full_command_feed_mm_per_min *= 0.5;
    let mut rig = plan.rig();
    rig.run(100);
    rig.go(300.0);
    let limit = |velocity: f64| 1000.0 + 10.0 * velocity;
    let mut warned = false;
    loop {
        let outputs = rig.step();
        let error: f64 = outputs.following_error.to_num();
        let limit = limit(outputs.setpoint.velocity.to_num());
        assert_eq!(
            error > limit,
            outputs.fault.is_some(),
            "{error} of {limit} d"
        );
        warned |= !outputs.warnings.is_empty();
        assert_eq!(warned, outputs.warnings.contains(Fault::FollowingError));
        if warned && outputs.fault.is_none() {
            assert!(rig.axis.supervisor().following_error_peak() > 500 << 16);
        }
        if outputs.fault.is_some() {
            break;
        }
    }
    assert!(warned);
    let first = rig.first();
    assert!(first.trip.value > first.trip.limit);
    assert_eq!(first.state, State::Moving);
    assert!(first.context.command > Command::lit("0.1"));
    assert_eq!(
        first.context.following_error.to_num::<f64>(),
        first.trip.value.to_num::<f64>()
    );
    rig.assert_zero_volts(Fault::FollowingError, BRAKING_MM);
}

/// From rest the loop runs away; the way until it is stopped is what is bounded.
#[test]
fn a_wrong_polarity_is_stopped_within_a_few_millimetres() {
    for (drive_reversed, encoder_reversed) in [(true, false), (false, true)] {
        for distance in [50.0, -50.0] {
            let mut rig = Plan::full().rig();
            rig.board.trouble.drive_reversed = drive_reversed;
            rig.board.trouble.encoder_reversed = encoder_reversed;
            rig.run(1);
            rig.go(distance);
            let start = rig.shaft();
            rig.until(3000, |outputs| outputs.fault.is_some());
            let detected = (rig.shaft() - start).abs();
            assert!(detected < 1300.0, "detected after {detected} d");
            rig.assert_off(Fault::MotionAgainstCommand);
            let way = (rig.shaft() - start).abs();
            assert!(way < 4000.0, "stopped after {way} d");
        }
    }
}

#[test]
fn both_wrong_polarities_together_are_a_mirrored_axis_that_works() {
    let mut rig = Plan::full().rig();
    rig.board.trouble.drive_reversed = true;
    rig.board.trouble.encoder_reversed = true;
    rig.run(100);
    rig.go(20.0);
    rig.run(1500);
    assert_eq!(rig.axis.outputs().fault, None);
    assert!((rig.shaft() + 20_000.0).abs() < 100.0, "{}", rig.shaft());
}

#[test]
fn a_lost_signal_is_answered_in_its_tick() {
    let mut rig = at_full_speed();
    rig.board
        .break_encoder(EncoderFault::LineLoss, 0..100_000)
        .unwrap();
    rig.board.trouble.encoder_lost = true;
    rig.step();
    rig.assert_zero_volts(Fault::SignalLoss, BRAKING_MM);
}

#[test]
fn a_broken_coupling_is_found_from_rest_by_the_command_that_moves_nothing() {
    let mut plan = Plan::full();
    plan.machine.mount.coupling_slip = 1.0;
    let mut rig = plan.rig();
    rig.run(100);
    rig.go(100.0);
    let (ticks, way) = ticks_and_way_to_encoder_loss(&mut rig);
    assert_eq!(ticks, 51, "and {way} d");
    assert!((500.0..8_200.0).contains(&way), "{way}");
    rig.assert_zero_volts(Fault::EncoderLoss, BRAKING_MM);
}

/// A command that barely counts takes the way, and with it longer.
#[test]
fn a_broken_coupling_is_found_by_the_commanded_way_where_the_axis_is_slow() {
    let mut plan = Plan::full();
    plan.machine.mount.coupling_slip = 1.0;
    plan.output_limit = 0.052;
    let mut rig = plan.rig();
    rig.run(100);
    rig.go(100.0);
    let (ticks, way) = ticks_and_way_to_encoder_loss(&mut rig);
    // 0.5 mm at 5.2 % of 9 600 mm/min are 60.1 ticks.
    assert_eq!(ticks, 61, "and {way} d");
    assert!((500.0..508.4).contains(&way), "{way}");
    rig.assert_zero_volts(Fault::EncoderLoss, BRAKING_MM);
}

/// Until encoder loss trips, which it has to in the very tick: ticks and commanded way (d) of the commands above 5 %.
#[track_caller]
fn ticks_and_way_to_encoder_loss(rig: &mut Rig) -> (u32, f64) {
    let (mut ticks, mut way) = (0, 0.0);
    loop {
        let told: f64 = rig.axis.outputs().command.to_num();
        let is_lost = rig.step().fault == Some(Fault::EncoderLoss);
        if told > 0.05 {
            ticks += 1;
            way += told * 160.0;
        }
        assert_eq!(is_lost, ticks > 50 && way > 500.0, "{ticks} ticks, {way} d");
        if is_lost {
            return (ticks, way);
        }
    }
}

/// In motion the following error is faster than the standing encoder, with the same reaction.
#[test]
fn a_coupling_that_breaks_in_motion_is_found_within_the_following_error() {
    let mut plan = Plan::full();
    plan.machine.mount.coupling_slip = 1.0;
    plan.machine.mount.slip_from_s = 0.8;
    let mut rig = plan.rig();
    rig.at_full_speed();
    rig.run(100);
    let start = rig.shaft();
    rig.until(25, |outputs| outputs.fault.is_some());
    assert_eq!(rig.shaft(), start, "the encoder stands");
    rig.assert_zero_volts(Fault::FollowingError, BRAKING_MM);
}

#[test]
fn a_dead_channel_is_found_in_motion() {
    let mut rig = at_full_speed();
    let dead = EncoderFault::DeadChannel(leadscrew_hal_mock::faults::Channel::A);
    rig.board.break_encoder(dead, 0..100_000).unwrap();
    rig.until(25, |outputs| outputs.fault.is_some());
    rig.assert_zero_volts(Fault::FollowingError, BRAKING_MM);
}

#[test]
fn a_drive_with_a_fault_is_off_in_its_tick() {
    let mut rig = at_full_speed();
    rig.board.trouble.drive = DriveHealth::Faulty;
    rig.step();
    rig.assert_off(Fault::DriveFault);
    assert!(rig.first().later.contains(Fault::DriveNotReady));
}

#[test]
fn a_drive_that_ceases_to_be_ready_is_off_in_its_tick() {
    let mut rig = at_full_speed();
    rig.board.trouble.drive = DriveHealth::NeverReady;
    rig.step();
    rig.assert_off(Fault::DriveNotReady);
}

#[test]
fn a_drive_that_never_gets_ready_is_given_up_after_its_timeout() {
    let mut rig = Plan::full().rig();
    rig.board.trouble.drive = DriveHealth::NeverReady;
    let waited = rig.until(2000, |outputs| {
        assert!(!outputs.brake_released);
        outputs.state != State::Enabling
    });
    assert_eq!(waited, 1001);
    rig.assert_off(Fault::DriveNotReady);
}

#[test]
fn a_converter_that_does_not_obey_is_found_in_two_ticks() {
    for converter in [
        Converter::Stuck(Command::lit("0.1")),
        Converter::Stuck(Command::ZERO),
        Converter::OffBy(Command::lit("-0.05")),
    ] {
        let mut rig = at_full_speed();
        rig.board.trouble.converter = converter;
        assert_eq!(rig.step().fault, None);
        rig.step();
        rig.assert_off(Fault::OutputMismatch);
    }
}

#[test]
fn a_limit_switch_stops_motion_toward_it_only() {
    let mut plan = Plan::full();
    plan.board.switches.limit_high_mm = 60.0;
    let mut rig = plan.rig();
    rig.run(100);
    rig.go(300.0);
    rig.until(2000, |outputs| outputs.fault.is_some());
    let way = rig.board.machine.truth().carriage.position - 60_000.0;
    assert!(
        (0.0..=151.0).contains(&way),
        "detected {way} d behind the switch"
    );
    rig.assert_zero_volts(Fault::HardLimit, BRAKING_MM);

    rig.enable = false;
    rig.run(2);
    rig.clear().unwrap();
    rig.enable = true;
    let outputs = rig.run(100);
    assert_eq!(
        (outputs.state, outputs.fault),
        (State::Ready, None),
        "stands on the switch"
    );
    rig.go(1.0);
    rig.until(5, |outputs| outputs.fault == Some(Fault::HardLimit));
    rig.run(600);
    rig.enable = false;
    rig.run(2);
    rig.clear().unwrap();
    rig.enable = true;
    rig.run(100);
    rig.go(-30.0);
    assert_eq!(rig.run(1500).fault, None, "the way out is free");
    assert!(!rig.board.lines().limit_high);
}

#[test]
fn an_emergency_stop_is_answered_in_its_tick() {
    let mut rig = at_full_speed();
    rig.board.trouble.emergency_stop = true;
    rig.step();
    let first = rig.first();
    assert_eq!(first.state, State::Moving);
    assert!(
        first.context.setpoint_velocity.to_num::<f64>() > 149.0,
        "as it was before"
    );
    rig.assert_zero_volts(Fault::EmergencyStop, BRAKING_MM);
}
