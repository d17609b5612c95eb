//! Identified figures against those of the machine.

use leadscrew::identification::{Figure, Identified, LargestAcceleration};
use leadscrew::tuning::DriveModel;
use leadscrew_hal_mock::machine::MachineParams;

use crate::support::Bench;

/// Every figure within `share` of the truth, or of what it is a part of.
#[track_caller]
fn assert_close(bench: &Bench, found: &Identified, share: f64) {
    let drive = &bench.machine.drive;
    let scale = bench.scale();
    let gain = scale
        .velocity_from_feed(drive.full_command_feed_mm_per_min)
        .unwrap();
    let friction = scale.velocity_from_feed(drive.friction_mm_per_min).unwrap();
    let period = drive.natural_period_s;
    let near = |name: &str, figure: Figure, truth: f64, within: f64| {
        let off = (figure.value - truth).abs();
        assert!(off <= within, "{name}: {figure:?}, true {truth}");
    };
    near("gain", found.gain, gain, share * gain);
    near("offset", found.offset, drive.offset, 0.1 * share);
    near("friction", found.friction, friction, 0.1 * share * gain);
    near("period", found.natural_period_s, period, share * period);
    near(
        "damping",
        found.damping,
        drive.damping,
        share * drive.damping,
    );
    near("delay", found.delay_s, drive.delay_s, 0.2 * share * period);
    // The simulated drive counts both in whole ticks.
    let whole = |time_s: f64| (time_s * bench.tick_hz).round() / bench.tick_hz;
    near(
        "dead time",
        found.dead_time_s,
        whole(drive.dead_time_s),
        0.2 * share * period,
    );
}

#[test]
fn the_bare_and_the_full_machine_are_found() {
    for bench in [Bench::bare(), Bench::full()] {
        let found = bench.identified();
        assert_close(&bench, &found, 0.01);
        let LargestAcceleration::Reached(limit) = found.largest_acceleration else {
            panic!("{:?}", found.largest_acceleration);
        };
        assert!((limit.value - 2.1).abs() < 0.02, "{limit:?}");
    }
}

#[test]
fn other_drives_are_found() {
    let drives = [
        (0.03, 0.3, 0.0),
        (0.03, 1.0, 0.005),
        (0.07, 0.7, 0.001),
        (0.117, 0.5, 0.002),
        (0.0675, 0.5, 0.002),
        (0.3, 0.3, 0.005),
        (0.3, 1.0, 0.0),
    ];
    for (natural_period_s, damping, delay_s) in drives {
        let mut bench = Bench::full();
        bench.machine.drive.natural_period_s = natural_period_s;
        bench.machine.drive.damping = damping;
        bench.machine.drive.delay_s = delay_s;
        // A slow drive needs room to settle.
        bench.params.window_mm = if natural_period_s > 0.2 { 60.0 } else { 20.0 };
        let found = bench.identified();
        assert_close(&bench, &found, 0.03);
    }
}

/// A drive of seven records a quarter of its period: with some encoders the fit came to rest beside the right one, 7 % off.
#[test]
fn a_fast_drive_is_found_whatever_the_encoder_adds() {
    for seed in 1..=6 {
        let mut bench = Bench::full();
        bench.seed = seed;
        bench.machine.drive.natural_period_s = 0.03;
        bench.machine.drive.damping = 0.3;
        bench.machine.drive.delay_s = 0.0;
        let found = bench.identified();
        assert_close(&bench, &found, 0.03);
    }
}

#[test]
fn the_model_is_the_machine() {
    let machine = MachineParams::z_16k20f3();
    let model: DriveModel = Bench::of(machine).identified().model();
    let drive = machine.drive;
    for (found, truth) in [
        (
            model.full_command_feed_mm_per_min,
            drive.full_command_feed_mm_per_min,
        ),
        (model.natural_period_s, drive.natural_period_s),
        (model.damping, drive.damping),
        (model.max_acceleration_m_s2, drive.max_acceleration_m_s2),
        (model.friction_forward_mm_per_min, drive.friction_mm_per_min),
        (
            model.friction_backward_mm_per_min,
            drive.friction_mm_per_min,
        ),
        (
            model.breakaway_forward_mm_per_min,
            drive.stiction_ratio * drive.friction_mm_per_min,
        ),
        (
            model.breakaway_backward_mm_per_min,
            drive.stiction_ratio * drive.friction_mm_per_min,
        ),
    ] {
        assert!((found / truth - 1.0).abs() < 0.03, "{found} for {truth}");
    }
}

#[test]
fn a_coarser_encoder_and_other_tick_rates_do() {
    for (tick_hz, counts_per_mm) in [(1000.0, 200.0), (2500.0, 1000.0), (500.0, 1000.0)] {
        let mut bench = Bench::full();
        bench.machine.mount.counts_per_mm = counts_per_mm;
        bench.tick_hz = tick_hz;
        let found = bench.identified();
        assert_close(&bench, &found, 0.04);
    }
}
