//! The velocity drive: its response, its limits, and each of its imperfections alone.

use leadscrew::units::{AxisScale, Command};
use leadscrew_hal_mock::arc::Arc;
use leadscrew_hal_mock::drive::{Drive, DriveParams};

/// Full-command speed at 1 000 d/mm, d/s.
const FULL_PER_S: f64 = 160_000.0;

pub fn command(value: f64) -> Command {
    Command::from_num(value)
}

pub fn bare() -> DriveParams {
    DriveParams::default().bare()
}

pub fn drive(params: &DriveParams, tick_hz: f64) -> Drive {
    Drive::new(params, AxisScale::new(1000.0, tick_hz).unwrap(), 0.0).unwrap()
}

pub fn run(drive: &mut Drive, demand: f64, ticks: u32) -> Vec<Arc> {
    (0..ticks)
        .map(|_| drive.step(command(demand), true))
        .collect()
}

/// Extremes of the velocity over arcs: time in ticks and value, to within the arcs themselves, in
/// which the acceleration is linear.
fn extremes(arcs: &[Arc]) -> Vec<(f64, f64)> {
    let mut found = Vec::new();
    for (tick, arc) in arcs.iter().enumerate() {
        let (from, to) = (arc.start.acceleration, arc.end().acceleration);
        if from * to < 0.0 {
            let share = from / (from - to);
            found.push((tick as f64 + share, arc.at(share).velocity));
        }
    }
    found
}

#[test]
fn the_step_response_has_a_natural_period_of_90_ms_and_a_damping_of_one_half() {
    for tick_hz in [1000.0, 2500.0] {
        // A tenth of full command needs 0.61 m/s², well within the limit; a hundredth of that is above the resolution.
        let target = 0.1 * FULL_PER_S / tick_hz;
        let arcs = run(&mut drive(&bare(), tick_hz), 0.1, 600);
        let peaks = extremes(&arcs);
        let [(first, high), (second, low)] = peaks[..2] else {
            panic!("no oscillation: {peaks:?}")
        };
        // Successive overshoots of a second-order system fall by exp(−πζ/√(1−ζ²)), half a damped period apart.
        let decrement = ((high - target) / (target - low)).ln() / std::f64::consts::PI;
        let damping = decrement / decrement.hypot(1.0);
        let period = 2.0 * (second - first) / tick_hz * (1.0 - damping * damping).sqrt();
        assert!(
            (period / 0.09 - 1.0).abs() < 0.01,
            "{tick_hz} Hz: {period} s"
        );
        assert!(
            (damping / 0.5 - 1.0).abs() < 0.01,
            "{tick_hz} Hz: {damping}"
        );
        // 16.3 % of overshoot after half a damped period from the start.
        assert!(
            ((high - target) / target - 0.163).abs() < 0.00163,
            "{tick_hz} Hz: {high}"
        );
        assert!(
            (first / tick_hz / (0.045 / 0.75_f64.sqrt()) - 1.0).abs() < 0.01,
            "{tick_hz} Hz: {first}"
        );
        // After 30 time constants it has settled.
        let end = arcs.last().unwrap().end().velocity;
        let settled = (-0.5 * std::f64::consts::TAU / 0.09 * 600.0 / tick_hz).exp();
        assert!(
            (end - target).abs() <= 1.2 * settled * target + 1e-9,
            "{tick_hz} Hz: {end}"
        );
    }
}

#[test]
fn a_full_step_accelerates_at_the_limit_and_never_beyond() {
    for (tick_hz, limit) in [(1000.0, 2.1), (2500.0, 0.336)] {
        let mut drive = drive(&bare(), tick_hz);
        let arcs: Vec<_> = [1.0, -1.0]
            .map(|demand| run(&mut drive, demand, 500))
            .concat();
        let largest = arcs
            .iter()
            .map(|arc| arc.end().acceleration.abs())
            .fold(0.0, f64::max);
        // The jerk of the tick that reaches the limit is a difference, and adds up to it within rounding.
        assert!(
            (largest - limit).abs() < 1e-12,
            "{tick_hz} Hz: {largest} d/tick²"
        );
        let at_limit = arcs
            .iter()
            .filter(|arc| arc.end().acceleration.abs() > limit - 1e-9)
            .count();
        assert!(at_limit > 50, "for {at_limit} ticks");
    }
}

#[test]
fn motion_is_continuous_from_tick_to_tick() {
    let mut drive = drive(&DriveParams::default(), 1000.0);
    let arcs: Vec<_> = [0.3, -0.7, 0.02, 0.0]
        .map(|demand| run(&mut drive, demand, 300))
        .concat();
    for pair in arcs.windows(2) {
        let (before, after) = (pair[0].end(), pair[1].start);
        assert_eq!(
            (before.position, before.velocity),
            (after.position, after.velocity)
        );
    }
    assert_eq!(drive.shaft(), arcs.last().unwrap().end());
}

#[test]
fn it_answers_to_whole_steps_of_its_resolution() {
    let speed = |demand| {
        run(&mut drive(&bare(), 1000.0), demand, 2000)
            .last()
            .unwrap()
            .end()
            .velocity
    };
    for (demand, answered) in [
        (0.4e-4, 0.0),
        (0.6e-4, 1e-4),
        (-0.6e-4, -1e-4),
        (1.4e-4, 1e-4),
        (0.25004, 0.25),
    ] {
        assert!(
            (speed(demand) - answered * 160.0).abs() < 1e-9,
            "{demand}: {}",
            speed(demand)
        );
    }
    let fine = DriveParams {
        resolution: 0.0,
        ..bare()
    };
    let end = run(&mut drive(&fine, 1000.0), 0.4e-4, 2000)
        .last()
        .unwrap()
        .end()
        .velocity;
    // Without steps only that of the command itself is left.
    assert!(
        (end - 0.4e-4 * 160.0).abs() < 160.0 * Command::DELTA.to_num::<f64>(),
        "{end}"
    );
}

#[test]
fn its_offset_adds_to_the_command() {
    let params = DriveParams {
        offset: -0.005,
        ..bare()
    };
    for demand in [0.0, 0.1] {
        let end = run(&mut drive(&params, 1000.0), demand, 2000)
            .last()
            .unwrap()
            .end()
            .velocity;
        assert!((end - (demand - 0.005) * 160.0).abs() < 1e-9, "{end}");
    }
}

#[test]
fn a_command_acts_after_the_transport_delay() {
    for (tick_hz, delay) in [(1000.0, 2), (2500.0, 5), (35_000.0, 70)] {
        let params = DriveParams {
            delay_s: 0.002,
            ..bare()
        };
        let late = run(&mut drive(&params, tick_hz), 0.1, delay + 100);
        let at_once = run(&mut drive(&bare(), tick_hz), 0.1, 100);
        let delay = delay as usize;
        assert!(
            late[..delay].iter().all(|arc| *arc == Arc::default()),
            "{tick_hz} Hz"
        );
        assert_eq!(late[delay..], at_once[..], "{tick_hz} Hz");
    }
}

#[test]
fn each_reversal_of_the_command_costs_the_dead_time() {
    for (tick_hz, dead) in [(1000.0, 5), (2500.0, 13)] {
        let params = DriveParams {
            dead_time_s: 0.005,
            ..bare()
        };
        let (mut with, mut without) = (drive(&params, tick_hz), drive(&bare(), tick_hz));
        for demand in [0.1, -0.1, 0.2] {
            // The same motion as that of a drive which is told zero for so long; the first start is no reversal.
            let told_zero = if demand == 0.1 { 0 } else { dead };
            let seen = run(&mut with, demand, 200);
            let expected = [
                run(&mut without, 0.0, told_zero),
                run(&mut without, demand, 200 - told_zero),
            ]
            .concat();
            assert_eq!(seen, expected, "{tick_hz} Hz, to {demand}");
        }
    }
}

#[test]
fn zero_between_two_commands_of_one_direction_is_no_reversal() {
    let params = DriveParams {
        dead_time_s: 0.005,
        ..bare()
    };
    let (mut with, mut without) = (drive(&params, 1000.0), drive(&bare(), 1000.0));
    for demand in [0.1, 0.0, 0.1] {
        assert_eq!(run(&mut with, demand, 100), run(&mut without, demand, 100));
    }
}

#[test]
fn disabled_it_brakes_to_a_stop_whatever_the_command() {
    for params in [bare(), DriveParams::default()] {
        let mut drive = drive(&params, 1000.0);
        run(&mut drive, 0.5, 1000);
        for _ in 0..3000 {
            drive.step(command(0.5), false);
        }
        assert!(drive.shaft().velocity.abs() < 1e-9, "{:?}", drive.shaft());
    }
}

#[test]
fn the_ripple_has_its_amplitude_and_frequency() {
    let params = DriveParams {
        ripple: 0.001,
        ripple_hz: 300.0,
        ..bare()
    };
    let mut drive = drive(&params, 25_000.0);
    let seen: Vec<f64> = (0..25_000)
        .map(|_| {
            drive.step(Command::ZERO, true);
            drive.ripple()
        })
        .collect();
    // 83.3 samples a period: the crest lies within 1/83 of a turn of one, and the sine is right to 2e-7.
    let crest = seen
        .iter()
        .fold(0.0_f64, |crest, value| crest.max(value.abs()));
    assert!((crest / 0.001 - 1.0).abs() < 0.003, "{crest}");
    assert!((super::statistics::amplitude(&seen, 300) / 0.001 - 1.0).abs() < 1e-3);
}

#[test]
fn the_ripple_shakes_the_shaft_by_its_share_of_the_speed_at_most() {
    let params = DriveParams {
        ripple: 0.001,
        ripple_hz: 300.0,
        ..bare()
    };
    let mut drive = drive(&params, 1000.0);
    run(&mut drive, 0.5, 2000);
    let speeds: Vec<f64> = run(&mut drive, 0.5, 1000)
        .iter()
        .map(|arc| arc.end().velocity)
        .collect();
    let (mean, sigma) = super::statistics::mean_and_sigma(&speeds);
    assert!(
        (mean - 80.0).abs() < 0.01 && sigma > 0.0 && sigma < 0.08,
        "{mean} ± {sigma}"
    );
}

#[test]
fn parameters_out_of_range_are_refused() {
    let scale = AxisScale::new(1000.0, 1000.0).unwrap();
    let error = Drive::new(
        &DriveParams {
            damping: -0.5,
            ..bare()
        },
        scale,
        0.0,
    )
    .unwrap_err();
    assert_eq!(
        error.to_string(),
        "damping = -0.5 is out of range: allowed 0.01 to 10"
    );
}
