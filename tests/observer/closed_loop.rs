//! Figures in the loop, over the ticks in which a move runs, against the shaft of the simulator.
//!
//! The encoder is what a learned map leaves of "real". Every lag is declared zero, so errors are those at the
//! sampling instant, S-curves included.

use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::MoveAndBack;

use crate::runs::{Loop, Tick, bare, detuned, mapped, rms};

const SEEDS: std::ops::RangeInclusive<u64> = 1..=5;

fn moving(ticks: &[Tick]) -> impl Iterator<Item = &Tick> {
    ticks.iter().filter(|tick| tick.outputs.moving)
}

fn acceleration_rms(ticks: &[Tick]) -> f64 {
    rms(moving(ticks).map(Tick::acceleration_error))
}

fn velocity_rms(ticks: &[Tick]) -> f64 {
    rms(moving(ticks).map(Tick::velocity_error))
}

fn following_peak(ticks: &[Tick]) -> f64 {
    let errors = ticks
        .iter()
        .map(|tick| tick.outputs.following_error.to_num::<f64>().abs());
    errors.fold(0.0, f64::max)
}

fn nominal() -> Loop {
    Loop::nominal(bare())
}

/// Drive −20 % in gain, +30 % in period, which a move at 6 000 mm/min leaves room for; and +20 %, −25 %.
fn off_nominal() -> [Loop; 2] {
    let slow = MoveAndBack {
        feed_mm_per_min: 6000.0,
        ..MoveAndBack::standard(1000.0)
    };
    [
        Loop {
            actual: detuned(bare(), -0.2, 0.3),
            scenario: slow,
            ..nominal()
        },
        Loop {
            actual: detuned(bare(), 0.2, -0.25),
            ..nominal()
        },
    ]
}

#[test]
fn on_the_nominal_machine_the_acceleration_is_right_to_a_few_thousandths() {
    for seed in SEEDS {
        let ticks = Loop { seed, ..nominal() }.run();
        let (a, v) = (acceleration_rms(&ticks), velocity_rms(&ticks));
        assert!((0.0005..0.004).contains(&a), "seed {seed}: {a} d/tick²");
        assert!((0.0005..0.010).contains(&v), "seed {seed}: {v} d/tick");
    }
}

#[test]
fn off_nominal_it_is_right_to_a_few_hundredths() {
    for run in off_nominal() {
        for seed in SEEDS {
            let ticks = Loop { seed, ..run }.run();
            let (a, v) = (acceleration_rms(&ticks), velocity_rms(&ticks));
            assert!(a < 0.010, "seed {seed}: {a} d/tick²");
            assert!(v < 0.02, "seed {seed}: {v} d/tick");
        }
    }
}

#[test]
fn it_lets_the_loop_be_placed_two_to_three_times_as_fast() {
    let fast = |run: Loop, bandwidth_rad_per_s| Loop {
        bandwidth_rad_per_s,
        ..run
    };
    let ticks = fast(nominal(), 100.0).run();
    // The peak is that of a step within a discrete at rest, where the loop is fed the middle of the count.
    assert!(following_peak(&ticks) <= 2.5, "{}", following_peak(&ticks));
    assert!(acceleration_rms(&ticks) < 0.004);
    // A drive that is a third faster than the loop counts on comes near to its limit at 100 rad/s.
    let [slow, quick] = off_nominal();
    for (run, bound) in [(fast(slow, 100.0), 15.0), (fast(quick, 80.0), 20.0)] {
        let ticks = run.run();
        let (peak, a) = (following_peak(&ticks), acceleration_rms(&ticks));
        assert!(peak < bound, "{peak} d of {bound}");
        assert!(a < 0.05, "{a} d/tick²");
    }
}

#[test]
fn the_full_machine_follows_within_a_few_discretes_more() {
    for (bandwidth_rad_per_s, follow, bound) in [(35.0, 150.0, 0.02), (100.0, 20.0, 0.01)] {
        let run = Loop {
            bandwidth_rad_per_s,
            ..Loop::nominal(mapped(MachineParams::z_16k20f3()))
        };
        let ticks = run.run();
        let (peak, a) = (following_peak(&ticks), acceleration_rms(&ticks));
        assert!(peak < follow, "{peak} d");
        assert!(a < bound, "{a} d/tick²");
    }
}

#[test]
fn the_stated_uncertainty_is_honest_on_the_nominal_machine() {
    let mut run = nominal();
    // The encoder as it is; there is no map, so no long wave of its residual.
    run.observer.edge_noise_d = 0.005;
    run.observer.map_residual_d = 0.0;
    for feed_mm_per_min in [300.0, 1000.0, 3000.0, 9000.0] {
        run.scenario.feed_mm_per_min = feed_mm_per_min;
        run.scenario.move_mm = 20.0_f64.max(feed_mm_per_min / 30.0);
        for (name, errors) in errors_and_sigmas(&run) {
            let stated = errors.iter().map(|(_, sigma)| sigma).sum::<f64>() / errors.len() as f64;
            let ratio = rms(errors.iter().map(|(error, _)| *error)) / stated;
            assert!(
                (0.8..=1.25).contains(&ratio),
                "{name} at {feed_mm_per_min} mm/min: {ratio}"
            );
            let within = errors
                .iter()
                .filter(|(error, sigma)| error.abs() <= 2.0 * sigma);
            let share = within.count() as f64 / errors.len() as f64;
            assert!(
                share >= 0.9,
                "{name} at {feed_mm_per_min} mm/min: {share} within 2σ"
            );
        }
    }
}

/// Speed from which on the gains settle faster than the density of edges changes, d/tick. Below it, as a move starts
/// and ends, errors are up to three times the stated 1σ.
const SETTLED: f64 = 4.0;

/// Errors of velocity and acceleration of five seeds with their stated 1σ.
fn errors_and_sigmas(run: &Loop) -> [(&'static str, Vec<(f64, f64)>); 2] {
    let ticks: Vec<Tick> = SEEDS.flat_map(|seed| Loop { seed, ..*run }.run()).collect();
    let settled = || moving(&ticks).filter(|tick| tick.shaft.velocity.abs() >= SETTLED);
    let velocity = settled().map(|tick| {
        (
            tick.velocity_error(),
            tick.variances.velocity.to_num::<f64>().sqrt(),
        )
    });
    let acceleration = settled().map(|tick| {
        (
            tick.acceleration_error(),
            tick.variances.acceleration.to_num::<f64>().sqrt(),
        )
    });
    [
        ("velocity", velocity.collect()),
        ("acceleration", acceleration.collect()),
    ]
}

#[test]
fn at_another_tick_rate_it_does_as_well() {
    let mut run = nominal();
    run.scenario = MoveAndBack::standard(2500.0);
    let ticks = run.run();
    // A d/tick² at 2.5 kHz is 6.25 at 1 kHz.
    let a = acceleration_rms(&ticks) * 6.25;
    assert!(a < 0.01, "{a} d/ms²");
}
