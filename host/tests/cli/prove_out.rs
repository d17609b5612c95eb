//! `leadscrew prove-out`: the closed circle through the command.

use serde_json::Value;

use crate::{Folder, assert_says};

fn of<'r>(report: &'r Value, key: &'r str) -> impl Iterator<Item = f64> + 'r {
    let rows = report["figures"].as_array().into_iter().flatten();
    rows.filter_map(move |row| row[key].as_f64())
}

/// Deviations fall below bounds that follow from the probe, and these are far below what was wrong.
#[test]
fn deviations_fall_to_the_noise_of_the_probe() {
    let folder = Folder::new();
    for seed in 1..=3 {
        let report = folder.json(&format!(
            "prove-out --seed {seed} --plot part.png --corrected part.ngc"
        ));
        assert_eq!(report["schema"], "leadscrew/prove-out/1");
        assert_eq!(report["holds"], true);
        assert_eq!(of(&report, "after").count(), 13);
        for (after, bound) in of(&report, "after").zip(of(&report, "bound")) {
            assert!(after.abs() <= bound, "{after}, bound {bound}");
        }
        let largest = |key| of(&report, key).fold(0.0, |most: f64, one| most.max(one.abs()));
        assert!(largest("before") > 10.0 * largest("after"), "seed {seed}");
    }
    let corrected = folder.read("part.ngc");
    assert_says(&corrected, &["T1 M6", "G43 H3", "M30"]);
    assert!(folder.path("part.png").exists());
}

/// A coarser probe gives wider bounds.
#[test]
fn the_bounds_grow_with_the_noise_of_the_probe() {
    let folder = Folder::new();
    let bounds = |um: f64| -> f64 {
        let report = folder.json(&format!("prove-out --probe-um {um}"));
        of(&report, "bound").sum()
    };
    assert!(bounds(4.0) > 1.5 * bounds(1.0));
}

/// A probe that scatters by more than the surface's usual play is let go of all the same, and does not touch anew on its way back.
#[test]
fn the_coarsest_probe_closes_the_circle() {
    let report = Folder::new().json("prove-out --probe-um 50");
    assert_eq!(report["holds"], true);
    assert_eq!(report["touches"], 67);
}

/// The axis is referenced after its map was learned: what the tools cut beside is found to the probe's noise, not to where the map
/// puts its zero, 1.6 um off.
#[test]
fn the_wear_of_the_tools_is_found() {
    let folder = Folder::new();
    for seed in 1..=3 {
        let report = folder.json(&format!("prove-out --seed {seed} --probe-um 0.2"));
        for tool in report["tools"].as_array().into_iter().flatten() {
            for axis in 0..3 {
                let at = |key: &str| tool[key][axis].as_f64().unwrap_or_default();
                let (found, truth) = (at("found_mm"), at("truth_mm"));
                assert!(
                    found == 0.0 || (found - truth).abs() < 7e-4,
                    "seed {seed}: {tool}"
                );
            }
        }
    }
}

#[test]
fn a_probe_that_cannot_be_is_refused() {
    let folder = Folder::new();
    let error = folder.refused(2, "prove-out --probe-um 0");
    assert_says(&error, &["--probe-um 0", "0.01 to 50 um"]);
    assert_says(
        &folder.refused(2, "prove-out --plot p.gif"),
        &[".svg or .png"],
    );
}
