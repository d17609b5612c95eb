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

#[test]
fn a_probe_that_cannot_be_is_refused() {
    let folder = Folder::new();
    let error = folder.refused(2, "prove-out --probe-um 0");
    assert_says(&error, &["--probe-um 0", "0.01 to 5 um"]);
    assert_says(
        &folder.refused(2, "prove-out --plot p.gif"),
        &[".svg or .png"],
    );
}
