//! The closed circle: a part machined, probed, computed, corrected and machined again, with an exact axis.

use std::collections::BTreeMap;

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
    // The certificate is a good part of it, and its share of the bound is an upper one.
    let rms = rms(&ratios);
    assert!((0.45..0.75).contains(&rms), "rms {rms} of the stated 1σ");
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// Where the probe rules, what is left is what the stated 1σ says.
#[test]
fn a_coarse_probe_leaves_what_its_1_sigma_says() {
    let ratios: Vec<f64> = (1..=20)
        .flat_map(|seed| run(seed, 4.0 * PROBE_MM, &Amounts::default(), Plant::Nothing).rows)
        .map(|row| SIGMAS * row.after / row.bound)
        .collect();
    let rms = rms(&ratios);
    assert!((0.8..1.05).contains(&rms), "rms {rms} of the stated 1σ");
}

/// On a machine that is known exactly the setting and each tool scatter by their own 1σ, about what the probe should see.
#[test]
fn setting_and_tools_are_found_to_their_1_sigma() {
    let known = Amounts {
        map_mm: 0.0,
        map_rad: 0.0,
        ..Amounts::default()
    };
    let mut ratios: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for seed in 1..=60 {
        let out = run(seed, PROBE_MM, &known, Plant::Nothing);
        let off = (out.found.setting - out.setting_seen).to_array();
        for (index, off) in off.into_iter().enumerate() {
            let sigma = out.found.setting_covariance[(index, index)].sqrt();
            ratios.entry("setting").or_default().push(off / sigma);
        }
        for (tool, name) in [(1, "tool 1"), (2, "tool 2"), (3, "tool 3")] {
            let (found, seen) = (&out.found.tools[&tool], out.tools_seen[&tool]);
            for (found_mm, seen_mm) in found.mm.into_iter().zip(seen) {
                if found_mm != 0.0 {
                    let off = (found_mm - seen_mm) / found.sigma_mm;
                    ratios.entry(name).or_default().push(off);
                }
            }
        }
    }
    for (what, ratios) in ratios {
        let rms = rms(&ratios);
        assert!((0.78..1.25).contains(&rms), "{what}: rms {rms} of its 1σ");
    }
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
