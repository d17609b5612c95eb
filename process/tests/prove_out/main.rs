//! The closed circle: a part machined, probed, computed, corrected and machined again, with an exact axis.

use leadscrew_process::prove_out::{Amounts, Draws, Plant, ProveOut, SIGMAS, Touching, prove_out};

/// A probe on an axis that latches where it triggers.
struct Exact {
    sigma_mm: f64,
    draws: Draws,
}

impl Touching for Exact {
    fn touch(&mut self, contact_mm: f64, _: f64) -> Result<f64, String> {
        Ok(contact_mm + self.sigma_mm * self.draws.normal())
    }

    fn sigma_mm(&self) -> f64 {
        self.sigma_mm
    }
}

fn run(seed: u64, sigma_mm: f64, amounts: &Amounts, plant: Plant) -> ProveOut {
    let mut touching = Exact {
        sigma_mm,
        draws: Draws::new(seed, 1),
    };
    prove_out(amounts, plant, seed, &mut touching).unwrap()
}

/// A probe of 2σ = 1 µm.
const PROBE_MM: f64 = 5e-4;

/// The bound is 4σ of a computation from 38 touches of 1σ = 0.5 µm and a certificate; over 12 worlds all figures keep it, and the
/// bound is no empty one: their scatter is of the size of the stated 1σ.
#[test]
fn every_figure_falls_to_the_noise_of_the_probe() {
    let mut ratios = Vec::new();
    for seed in 1..=12 {
        let out = run(seed, PROBE_MM, &Amounts::default(), Plant::Nothing);
        assert!(out.holds(), "seed {seed}: {:#?}", out.rows);
        for row in &out.rows {
            let largest = if row.is_angle { 5e-5 } else { 5e-3 };
            assert!(row.bound < largest, "{row:?}");
            ratios.push(SIGMAS * row.after / row.bound);
        }
        for (tool, seen) in &out.tools_seen {
            for (found, seen) in out.found.tools[tool].mm.iter().zip(seen) {
                // A tool shows along the axes that its features look along only.
                let off = found - seen;
                assert!(
                    *found == 0.0 || off.abs() < 3e-3,
                    "tool {tool}: {found}, {seen}"
                );
            }
        }
        let before = out.rows.iter().map(|row| row.before.abs() / row.bound);
        assert!(
            before.fold(0.0, f64::max) > 5.0,
            "seed {seed}: nothing was wrong"
        );
    }
    let count = ratios.len() as f64;
    let rms = (ratios.iter().map(|ratio| ratio * ratio).sum::<f64>() / count).sqrt();
    assert!((0.3..1.2).contains(&rms), "rms {rms} of the stated 1σ");
}

/// Without noise nothing is left but rounding of the program, its chords and the setting's second order.
#[test]
fn without_noise_all_is_taken_away() {
    let known = Amounts {
        map_mm: 0.0,
        map_rad: 0.0,
        ..Amounts::default()
    };
    let out = run(5, 1e-9, &known, Plant::Nothing);
    for row in &out.rows {
        let largest = if row.is_angle { 5e-6 } else { 5e-4 };
        assert!(row.after.abs() < largest, "{row:?}");
    }
}

/// Each term alone with its sign turned is found out.
#[test]
fn a_wrong_sign_does_not_pass() {
    for plant in [Plant::MapSign, Plant::SettingSign, Plant::WearSign] {
        for seed in 1..=4 {
            let out = run(seed, PROBE_MM, &Amounts::default(), plant);
            assert!(!out.holds(), "{plant:?}, seed {seed}");
        }
    }
}

/// A part that lies where it was planned, tools as they were preset, a cold machine: all that is wrong is the machine, which the
/// probe cannot see without the certified map, as it stands off by as much as the tool stood.
#[test]
fn a_machine_does_not_see_its_own_deviations() {
    let machine_only = Amounts {
        machine: 3.0,
        setting_mm: 0.0,
        setting_rad: 0.0,
        wear_mm: 0.0,
        growth_mm: 0.0,
        map_mm: 0.0,
        map_rad: 0.0,
    };
    let out = run(3, 1e-9, &machine_only, Plant::Nothing);
    let largest = |of: &dyn Fn(&leadscrew_process::prove_out::Row) -> f64| {
        let lengths = out.rows.iter().filter(|row| !row.is_angle);
        lengths.map(|row| of(row).abs()).fold(0.0, f64::max)
    };
    let truth = largest(&|row| row.before);
    assert!(truth > 5e-3, "{truth} mm");
    assert!(largest(&|row| row.probed_before - row.before) < 2e-4);
    // The tool is up to 2 mm longer or shorter than the probe: so much of a turn is seen.
    let blind = largest(&|row| row.blind_before);
    assert!(blind < 5e-4, "{blind} mm");
}
