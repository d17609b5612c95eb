//! The tachogenerator behind its oscilloscope.

use leadscrew::units::{AxisScale, Command};
use leadscrew_hal_mock::arc::{Arc, State};
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::tachogenerator::Tachogenerator;

fn tachogenerator(tick_hz: f64) -> Tachogenerator {
    Tachogenerator::new(AxisScale::new(1000.0, tick_hz).unwrap())
}

fn at_speed(velocity: f64) -> Arc {
    Arc {
        start: State {
            velocity,
            ..State::default()
        },
        jerk: 0.0,
    }
}

#[test]
fn a_step_of_the_oscilloscope_is_0_233_d_a_tick_at_1_khz() {
    assert!((tachogenerator(1000.0).resolution() - 0.233).abs() < 1e-12);
    assert!((tachogenerator(2500.0).resolution() - 0.0932).abs() < 1e-12);
    // 10 V in steps of 15.63 mV are about 150 d/tick: the reading of the paper that this model rests on.
    let full: f64 = 10.0 / 0.015_63 * 0.233;
    assert!((full / 150.0 - 1.0).abs() < 0.01, "{full}");
}

#[test]
fn it_reads_a_constant_speed_to_the_nearest_step() {
    for tick_hz in [1000.0, 2500.0, 35_000.0] {
        let mut tachogenerator = tachogenerator(tick_hz);
        for velocity in [0.0, 0.11, 0.12, 7.7, 149.9, -0.12, -42.0] {
            (0..20).for_each(|_| tachogenerator.step(&at_speed(velocity), 0.0));
            let step = tachogenerator.resolution();
            let expected = (velocity / step).round() * step;
            assert!(
                (tachogenerator.velocity() - expected).abs() < 1e-9,
                "{velocity} at {tick_hz} Hz"
            );
        }
    }
}

#[test]
fn the_ripple_is_a_share_of_the_speed() {
    let mut tachogenerator = tachogenerator(1000.0);
    tachogenerator.step(&at_speed(100.0), 0.01);
    assert!((tachogenerator.velocity() - 101.0).abs() <= 0.5 * 0.233);
}

#[test]
fn it_reads_the_mean_of_eight_samples_a_millisecond() {
    // 8 d/tick² from 10 d/tick: samples at eighths of the tick, 10 to 17 d/tick, each within half a step.
    let mut tachogenerator = tachogenerator(1000.0);
    let arc = Arc {
        start: State {
            velocity: 10.0,
            acceleration: 8.0,
            ..State::default()
        },
        jerk: 0.0,
    };
    tachogenerator.step(&arc, 0.0);
    let nearest = |velocity: f64| (velocity / 0.233).round() * 0.233;
    let expected = (0..8)
        .map(|sample| nearest(10.0 + f64::from(sample)))
        .sum::<f64>()
        / 8.0;
    assert!(
        (tachogenerator.velocity() - expected).abs() < 1e-9,
        "{}",
        tachogenerator.velocity()
    );
}

#[test]
fn above_8_khz_it_holds_its_reading_between_samples() {
    let mut tachogenerator = tachogenerator(32_000.0);
    let readings: Vec<f64> = (0..12)
        .map(|tick| {
            tachogenerator.step(&at_speed(f64::from(tick)), 0.0);
            tachogenerator.velocity()
        })
        .collect();
    for (tick, reading) in readings.iter().enumerate() {
        let sampled = (tick / 4 * 4) as f64;
        assert!(
            (reading - sampled).abs() <= 0.5 * tachogenerator.resolution(),
            "tick {tick}: {reading}"
        );
    }
}

#[test]
fn on_the_machine_it_follows_the_shaft_and_not_the_encoder() {
    let mut machine = Machine::new(&MachineParams::z_16k20f3().bare(), 1000.0, 1).unwrap();
    for _ in 0..1000 {
        machine.step(Command::lit("0.5"), true);
        let reading = machine.read_tachogenerator();
        let truth = machine.truth().shaft;
        // The mean over the tick lies at most an acceleration before its end; each sample within half a step.
        assert!(
            (reading - truth.velocity).abs() <= truth.acceleration.abs() + 0.5 * 0.233 + 0.2,
            "{reading}"
        );
    }
}
