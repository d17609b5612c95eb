//! Passes of threads: what keeps their phase, and what ends them.

use leadscrew::axis::Outputs;
use leadscrew::setpoint::thread::{SpindleTrouble, SpindleWay, ThreadOrder, ThreadPhase};
use leadscrew::supervisor::Fault;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::spindle::SpindleParams;
use leadscrew_host::threads::{Lathe, ThreadError};

const COUNTS_PER_MM: f64 = 1000.0;

pub fn lathe(rpm: f64) -> Lathe<'static> {
    let machine = MachineParams::z_16k20f3().bare();
    let spindle = SpindleParams {
        rpm,
        ..SpindleParams::default()
    };
    Lathe::new(&machine, &spindle, EncoderModel::ideal(), 100.0, 1).unwrap()
}

/// A short thread of 2 mm.
pub fn order() -> ThreadOrder {
    ThreadOrder {
        lead_mm: 2.0,
        start_mm: 2.0,
        from_mm: 10.0,
        to_mm: 30.0,
        angle_deg: 30.0,
        starts: 1,
        start: 0,
        spindle: SpindleWay::Forward,
        retract_deg: 90.0,
    }
}

/// Runs until the pass is in `phase`, at most a minute.
fn run_to(lathe: &mut Lathe, phase: ThreadPhase) -> Outputs {
    for _ in 0..60_000 {
        let outputs = lathe.step();
        if lathe.axis.thread_phase() == phase {
            return outputs;
        }
    }
    panic!("never {phase:?}");
}

#[test]
fn every_start_and_both_hands_keep_their_phase_whatever_the_speed_does() {
    let hands = [
        (10.0, 30.0, SpindleWay::Forward),
        (30.0, 10.0, SpindleWay::Forward),
        (10.0, 30.0, SpindleWay::Backward),
    ];
    for (from_mm, to_mm, spindle) in hands {
        let mut phases = Vec::new();
        let away = if to_mm > from_mm { -8.0 } else { 8.0 };
        let way = if spindle == SpindleWay::Forward {
            1.0
        } else {
            -1.0
        };
        for (rpm, later) in [(300.0, 300.0), (800.0, 840.0), (800.0, 650.0)] {
            let mut lathe = lathe(rpm * way);
            lathe.run(500);
            for start in 0..3 {
                let order = ThreadOrder {
                    lead_mm: 3.0,
                    start_mm: from_mm + away,
                    from_mm,
                    to_mm,
                    starts: 3,
                    start,
                    spindle,
                    ..order()
                };
                lathe.spindle.set_rpm(rpm * way);
                lathe.run(500);
                lathe.axis.arm_thread(&order).unwrap();
                run_to(&mut lathe, ThreadPhase::RunIn);
                // Through the run-in and beyond.
                lathe.spindle.set_rpm(later * way);
                let pass = lathe.follow(&order, COUNTS_PER_MM, rpm).unwrap();
                phases.push(pass.phase_deg());
            }
        }
        let most = phases.iter().copied().fold(f64::MIN, f64::max);
        let least = phases.iter().copied().fold(f64::MAX, f64::min);
        assert!(most - least < 0.1, "{phases:?}");
        // The other flank of the index going backward is 3 d of 4 096 away.
        let flank = if way < 0.0 { 0.264 } else { 0.0 };
        assert!(most.abs().max(least.abs()) < flank + 0.1, "{phases:?}");
    }
}

#[test]
fn a_pass_comes_from_one_side_asks_for_retraction_and_rests_where_it_said() {
    // From either side of the start.
    for start_mm in [-3.0, 15.0] {
        let mut lathe = lathe(500.0);
        lathe.run(500);
        let order = ThreadOrder {
            start_mm,
            from_mm: start_mm + 8.0,
            to_mm: start_mm + 24.0,
            ..order()
        };
        let figures = lathe.axis.arm_thread(&order).unwrap();
        assert!((figures.rpm - 500.0).abs() < 6.0 && figures.run_in_mm < 8.0);
        let mut last = lathe.step();
        let mut last_motion = 0.0;
        let mut retracts = None;
        while lathe.axis.thread_phase() != ThreadPhase::Idle {
            let next = lathe.step();
            if lathe.axis.thread_phase() == ThreadPhase::Approaching {
                let velocity: f64 = next.setpoint.velocity.to_num();
                if velocity != 0.0 {
                    last_motion = velocity;
                }
            }
            let phase = lathe.axis.thread_phase();
            if next.retract && !last.retract {
                retracts = Some(next.setpoint.position.to_num::<f64>() / COUNTS_PER_MM);
            }
            assert!(next.moving || phase == ThreadPhase::Idle);
            assert_smooth(&last, &next);
            last = next;
        }
        assert!(last_motion > 0.0, "taken up the other way");
        // 90° of 2 mm before the end.
        let retracted = retracts.unwrap() - order.to_mm;
        assert!((-0.5..-0.48).contains(&retracted), "{retracted}");
        assert!(!last.retract);
        let rest = lathe.step().setpoint;
        let rest_mm = rest.position.to_num::<f64>() / COUNTS_PER_MM;
        assert!(
            (rest_mm - figures.rest_mm).abs() < 1e-5,
            "{rest_mm} {figures:?}"
        );
        assert_eq!(rest.velocity, 0);
    }
}

/// No jump of position, velocity or acceleration between two setpoints. Position and velocity are estimates of a spindle
/// whose acceleration steps when it is told another speed: for some ticks they differ by less than a tenth of a d.
fn assert_smooth(last: &Outputs, next: &Outputs) {
    let (from, to) = (&last.setpoint, &next.setpoint);
    let way = (to.position - from.position).to_num::<f64>();
    let mean = (to.velocity + from.velocity).to_num::<f64>() / 2.0;
    assert!((way - mean).abs() < 0.1, "{from:?} {to:?}");
    let jerk = (to.acceleration - from.acceleration).to_num::<f64>();
    assert!(jerk.abs() < 0.02, "{from:?} {to:?}");
}

#[test]
fn a_spindle_that_cannot_be_followed_ends_the_pass_in_a_controlled_stop() {
    type Harm = fn(&mut Lathe);
    let cases: [(Harm, SpindleTrouble, u32); 4] = [
        (|lathe| lathe.spindle.cut_cable(), SpindleTrouble::Jumped, 2),
        (
            |lathe| lathe.lines.master_lost = true,
            SpindleTrouble::NoSignal,
            2,
        ),
        (
            |lathe| lathe.spindle.set_rpm(-500.0),
            SpindleTrouble::TooSlow,
            200,
        ),
        (
            |lathe| lathe.spindle.set_rpm(900.0),
            SpindleTrouble::TooFast,
            200,
        ),
    ];
    for (harm, trouble, within) in cases {
        let mut lathe = lathe(500.0);
        lathe.run(500);
        lathe.axis.arm_thread(&order()).unwrap();
        run_to(&mut lathe, ThreadPhase::Cutting);
        lathe.run(200);
        harm(&mut lathe);
        let mut last = lathe.step();
        let mut ticks = 1;
        while last.fault.is_none() {
            let next = lathe.step();
            assert_smooth(&last, &next);
            last = next;
            ticks += 1;
            assert!(ticks <= within, "{trouble:?} not found");
        }
        assert_eq!(last.fault, Some(Fault::SpindleLost));
        assert_eq!(lathe.axis.spindle_trouble(), Some(trouble));
        assert_eq!(lathe.axis.thread_phase(), ThreadPhase::Idle);
        // It slows down at once, and stands within what jerk and acceleration allow.
        let speed = last.setpoint.velocity;
        let mut ticks = 0;
        while last.setpoint.velocity != 0 {
            let next = lathe.step();
            assert_smooth(&last, &next);
            // What the spindle still gained is taken back by the jerk limit first.
            let gained = next.setpoint.acceleration >= last.setpoint.acceleration;
            assert!(!(1..=2).contains(&ticks) || !gained, "{trouble:?}");
            assert!(ticks < 12 || next.setpoint.velocity < speed, "{trouble:?}");
            ticks += 1;
            assert!(ticks < 120, "{trouble:?} does not stop");
            last = next;
        }
    }
}

#[test]
fn a_pass_that_was_lost_says_so() {
    let mut lathe = lathe(500.0);
    lathe.run(500);
    lathe.axis.arm_thread(&order()).unwrap();
    run_to(&mut lathe, ThreadPhase::Armed);
    lathe.spindle.cut_cable();
    let lost = lathe.follow(&order(), COUNTS_PER_MM, 500.0).unwrap_err();
    assert!(
        matches!(lost, ThreadError::Ended(SpindleTrouble::Jumped)),
        "{lost}"
    );
}
