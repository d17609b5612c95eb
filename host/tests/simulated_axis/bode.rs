//! Frequency responses of the simulated drive, whose own are known.

use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_host::axis::bode::{Chirp, DriveCurve, closed_loop, drive};

use crate::support::Shared;

const CHIRP: Chirp = Chirp {
    hz: (1.0, 40.0),
    seconds: 6.0,
    amplitude: 0.03,
    centre: 0.06,
    points: 20,
};

#[test]
fn the_drive_s_response_is_the_machine_s() {
    let machine = MachineParams::z_16k20f3().drive;
    let mut tool = Shared::new(1000.0).ready();
    let full_feed = machine.full_command_feed_mm_per_min;
    let points = drive(&mut tool, &CHIRP, full_feed).unwrap();
    let truth = DriveCurve {
        natural_period_s: machine.natural_period_s,
        damping: machine.damping,
        delay_s: machine.delay_s,
        gain: 1.0,
    };
    let mut worst = (0.0_f64, 0.0_f64);
    for point in &points {
        let model = truth.at(point.hz);
        let gain = (point.gain_db() - model.gain_db()).abs();
        let phase = (point.phase_deg - model.phase_deg).abs();
        println!(
            "{:6.2} Hz {:7.2} dB ({:7.2}) {:7.1}° ({:7.1}) {:.3}",
            point.hz,
            point.gain_db(),
            model.gain_db(),
            point.phase_deg,
            model.phase_deg,
            point.coherence
        );
        worst = (worst.0.max(gain), worst.1.max(phase));
    }
    assert!(worst.0 < 0.5 && worst.1 < 4.0, "{worst:?}");
}

#[test]
fn the_closed_loop_takes_back_what_is_slow_and_not_what_is_fast() {
    let mut tool = Shared::new(1000.0).ready();
    let chirp = Chirp {
        amplitude: 0.1,
        centre: 0.2,
        ..CHIRP
    };
    let points = closed_loop(&mut tool, &chirp, 9600.0).unwrap();
    for point in &points {
        println!(
            "{:6.2} Hz {:7.2} dB {:7.1}° {:.3}",
            point.hz,
            point.gain_db(),
            point.phase_deg,
            point.coherence
        );
    }
    assert!(points[0].gain_db().abs() < 3.0, "{:?}", points[0]);
    let fast = points.last().unwrap();
    assert!(fast.gain_db() < -10.0, "{fast:?}");
    // It is given back to its loop, and goes on.
    tool.move_and_wait(10.0, 3000.0).unwrap();
}

#[test]
fn what_cannot_be_is_refused_before_anything_moves() {
    let check = |chirp: Chirp| chirp.check_drive(1000.0).unwrap_err().to_string();
    let turns = Chirp {
        centre: 0.02,
        ..CHIRP
    };
    assert!(check(turns).contains("--centre"));
    let fast = Chirp {
        hz: (1.0, 400.0),
        ..CHIRP
    };
    assert!(check(fast).contains("250"));
    let short = Chirp {
        seconds: 1.0,
        ..CHIRP
    };
    assert!(check(short).contains("take 2 at least"));
}
