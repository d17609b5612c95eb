//! Homing that cannot be done ends, at rest or on the way there, and says why.

use leadscrew::homing::{HomeRefused, HomingFailure, HomingParams};
use leadscrew::supervisor::Fault;

use crate::rig::{Rig, Switches, axis_params, real};

/// Runs until homing ends; its failure, the fault, and the ticks it took.
fn fails(homing: HomingParams, switches: Switches) -> (HomingFailure, Fault, usize) {
    failure_of(Rig::new(&real(), homing, switches, 1))
}

fn failure_of(mut rig: Rig) -> (HomingFailure, Fault, usize) {
    rig.run(200);
    rig.axis.home().unwrap();
    let mut trouble = None;
    for tick in 0..400_000 {
        let moving = rig.step().moving;
        trouble = trouble.or(rig.axis.homing().trouble());
        if !moving {
            assert_eq!(rig.origin(), None);
            rig.run(1000);
            let failure = rig.axis.homing().failure().unwrap();
            return (failure, trouble.unwrap(), tick);
        }
    }
    panic!("homing does not end");
}

#[test]
fn a_switch_that_never_comes_is_searched_for_so_far_and_no_farther() {
    let homing = HomingParams {
        max_search_mm: 50.0,
        ..HomingParams::default()
    };
    let (failure, fault, ticks) = fails(homing, Switches::at(1e9));
    assert_eq!(
        (failure, fault),
        (HomingFailure::SwitchNotFound, Fault::HomingFailed)
    );
    // 50 mm at 1 000 mm/min are 3 s.
    assert!((3000..3600).contains(&ticks), "{ticks}");
}

#[test]
fn between_two_limit_switches_without_a_home_switch_it_turns_round_once() {
    let switches = Switches {
        limits: (-40_000.0, 20_000.0),
        ..Switches::at(1e9)
    };
    let (failure, fault, _) = fails(HomingParams::default(), switches);
    assert_eq!(
        (failure, fault),
        (HomingFailure::SwitchNotFound, Fault::HomingFailed)
    );
}

#[test]
fn a_switch_that_stays_actuated_is_left_for_so_far_and_no_farther() {
    let homing = HomingParams {
        max_search_mm: 30.0,
        ..HomingParams::default()
    };
    let switches = Switches {
        home: (-1e9, 1e9),
        ..Switches::at(0.0)
    };
    let (failure, fault, _) = fails(homing, switches);
    assert_eq!(
        (failure, fault),
        (HomingFailure::SwitchStuck, Fault::HomingFailed)
    );
}

#[test]
fn an_axis_that_is_too_slow_runs_out_of_time() {
    let homing = HomingParams {
        max_time_s: 2.0,
        ..HomingParams::default()
    };
    let (failure, fault, ticks) = fails(homing, Switches::at(100_000.0));
    assert_eq!(
        (failure, fault),
        (HomingFailure::TimeOut, Fault::HomingFailed)
    );
    assert!((1999..2400).contains(&ticks), "{ticks}");
}

#[test]
fn an_encoder_without_index_is_searched_for_1_1_revolutions() {
    let mut params = axis_params(&real(), HomingParams::default());
    // Else the supervisor misses the index on the way to the switch.
    params.supervisor.index_within_revolutions = 10.0;
    let mut rig = Rig::with_axis(&real(), &params, Switches::at(33_000.0), 1);
    rig.has_index = false;
    let (failure, fault, _) = failure_of(rig);
    assert_eq!(
        (failure, fault),
        (HomingFailure::IndexNotFound, Fault::IndexNotFound)
    );
    assert!(failure.to_string().contains("index line"), "{failure}");
}

#[test]
fn an_index_too_near_to_the_switch_is_a_fault_that_says_how_to_mend_it() {
    for (switch, expected) in [
        (39_100.0, 900),
        (30_900.0, 9100),
        (39_999.9, 1),
        (40_000.5, 10_000),
    ] {
        let (failure, fault, _) = fails(HomingParams::default(), Switches::at(switch));
        let HomingFailure::IndexTooNear {
            distance,
            revolution: 10_000,
        } = failure
        else {
            panic!("{failure:?} at {switch}");
        };
        assert!((distance - expected).abs() <= 1, "{distance} at {switch}");
        assert_eq!(fault, Fault::HomingFailed);
        let text = failure.to_string();
        assert!(
            text.contains("turn the encoder's coupling") && text.contains("10 to 90 %"),
            "{text}"
        );
    }
    for switch in [38_900.0, 31_100.0] {
        let mut rig = Rig::new(&real(), HomingParams::default(), Switches::at(switch), 1);
        rig.home();
        assert!(rig.origin().is_some());
    }
}

#[test]
fn homing_is_refused_unless_the_axis_is_ready_at_rest() {
    let mut rig = Rig::new(&real(), HomingParams::default(), Switches::at(33_000.0), 1);
    assert_eq!(rig.axis.home(), Err(HomeRefused::NotReady));
    rig.run(200);
    rig.axis.home().unwrap();
    rig.step();
    assert_eq!(rig.axis.home(), Err(HomeRefused::NotReady));
}

#[test]
fn an_encoder_said_to_have_no_index_is_not_homed() {
    let mut params = axis_params(&real(), HomingParams::default());
    params.motion.counts_per_revolution = 0.0;
    let mut rig = Rig::with_axis(&real(), &params, Switches::at(33_000.0), 1);
    rig.run(200);
    assert_eq!(rig.axis.home(), Err(HomeRefused::NoIndex));
}
