//! Intervals hold the truth as often as they say.

use leadscrew::identification::Figure;
use leadscrew_hal_mock::machine::MachineParams;

use crate::support::Bench;

const SEEDS: u64 = 10;

/// Counts figures within 2σ of the truth, over seeds.
fn covered(machine: impl Fn(u64) -> MachineParams) -> Vec<(&'static str, u64)> {
    let mut hits: Vec<(&'static str, u64)> = Vec::new();
    for seed in 100..100 + SEEDS {
        let bench = Bench {
            seed,
            ..Bench::of(machine(seed))
        };
        let found = bench.identified();
        let (drive, scale) = (&bench.machine.drive, bench.scale());
        let speed = |feed| scale.velocity_from_feed(feed).unwrap();
        let figures: [(&'static str, Figure, f64); 7] = [
            (
                "gain",
                found.gain,
                speed(drive.full_command_feed_mm_per_min),
            ),
            ("offset", found.offset, drive.offset),
            ("friction", found.friction, speed(drive.friction_mm_per_min)),
            ("period", found.natural_period_s, drive.natural_period_s),
            ("damping", found.damping, drive.damping),
            ("delay", found.delay_s, drive.delay_s),
            ("dead time", found.dead_time_s, drive.dead_time_s),
        ];
        for (place, (name, figure, truth)) in figures.into_iter().enumerate() {
            let hit = u64::from((figure.value - truth).abs() <= 2.0 * figure.sigma);
            match hits.get_mut(place) {
                Some(entry) => entry.1 += hit,
                None => hits.push((name, hit)),
            }
        }
    }
    hits
}

/// The drive of a seed: off nominal by up to 20 %.
fn varied(seed: u64, machine: MachineParams) -> MachineParams {
    let part = |n: u64| ((seed * 7 + n * 13) % 17) as f64 / 16.0 - 0.5;
    let mut machine = machine;
    let drive = &mut machine.drive;
    drive.full_command_feed_mm_per_min *= 1.0 + 0.4 * part(0);
    drive.natural_period_s *= 1.0 + 0.4 * part(1);
    drive.damping *= 1.0 + 0.4 * part(2);
    machine
}

#[test]
fn nine_of_ten_figures_lie_within_two_sigma() {
    let hits = covered(|seed| varied(seed, MachineParams::z_16k20f3()));
    for (name, hit) in &hits {
        assert!(10 * hit >= 9 * SEEDS, "{name}: {hit} of {SEEDS}: {hits:?}");
    }
}
