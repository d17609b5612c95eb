//! `leadscrew deviations`: its tables, JSON, picture and table of corrections, and what it refuses.

use serde_json::Value;

use crate::{Folder, assert_says};

#[test]
fn a_place_shows_what_each_unit_adds_and_the_sum() {
    let report = Folder::new().json("deviations 6904MF2 --at X=100,Y=200,Z=50,B=90");
    assert_eq!(report["schema"], "leadscrew/deviations/1");
    let sum = |axis: usize| -> f64 {
        let units = report["units"].as_array().expect("units");
        units
            .iter()
            .filter_map(|unit| unit["part"]["um"][axis].as_f64())
            .sum()
    };
    for axis in 0..3 {
        let delta = report["at"]["deviation"]["um"][axis].as_f64().expect("Δ");
        assert!((sum(axis) - delta).abs() < 1e-9 && delta != 0.0);
    }
    let k = report["at"]["correction"]["Y"].as_f64().expect("K");
    let delta_y = report["at"]["deviation"]["um"][1].as_f64().expect("Δy");
    assert!((1e3 * k + delta_y).abs() < 1e-9, "K = −Δ");
}

#[test]
fn golden_text_of_both_machines() {
    let folder = Folder::new();
    let text = |arguments: &str| folder.printed(arguments);
    insta::assert_snapshot!(
        "deviations_machining_centre_at",
        text("deviations 6904MF2 --at X=100,Y=200,Z=50,B=90")
    );
    insta::assert_snapshot!(
        "deviations_lathe_map",
        text("deviations lathe --map --steps 3")
    );
}

#[test]
fn the_table_of_corrections_says_what_it_holds_for() {
    let folder = Folder::new();
    let report = folder.json("deviations 6904MF2 --at B=90 --corrections k.toml --plot k.png");
    assert!(
        report["corrections_error_um"]
            .as_f64()
            .is_some_and(|um| um > 0.0)
    );
    let table = folder.read("k.toml");
    assert!(table.contains("made up"), "{table}");
    assert!(table.contains("includes_drive_errors = true"), "{table}");
    assert!(table.contains("places_deg = [89.999, 90.001]"), "{table}");
    assert!(table.contains("Z = 150.0"), "{table}");
    folder.printed("deviations 6904MF2 --drive-errors-elsewhere --corrections e.toml");
    assert!(
        folder
            .read("e.toml")
            .contains("includes_drive_errors = false")
    );
}

#[test]
fn what_cannot_be_is_said() {
    let folder = Folder::new();
    folder.write("bad.toml", "name = \"m\"\norigin = 3\n");
    for (arguments, code, said) in [
        ("deviations bad.toml", 1, "bad.toml:2:10: invalid type"),
        ("deviations nowhere.toml", 1, "one of 6904MF2, lathe"),
        ("deviations lathe --at Y=1", 2, "has no axis Y; it has XZ"),
        ("deviations lathe --at X=1,X=2", 2, "X is given twice"),
        ("deviations lathe --at X", 2, "as X=100"),
        (
            "deviations lathe --at X=500,Z=1",
            1,
            "beyond the ends of unit \"cross slide\"",
        ),
        (
            "deviations lathe --at X=5 --plot p.png",
            2,
            "name fewer in --at",
        ),
        ("deviations lathe --plot p.gif", 2, ".svg or .png"),
        ("deviations lathe --steps 1", 2, "2..=101"),
    ] {
        assert_says(&folder.refused(code, arguments), &[said]);
    }
}

#[test]
fn the_spindle_of_the_lathe_may_be_placed() {
    let folder = Folder::new();
    let spindle = |at: &str| -> Value {
        let report = folder.json(&format!("deviations lathe --at {at}"));
        report["units"][0]["setting"]["um"][0].clone()
    };
    assert_eq!(spindle("X=20,Z=100"), 0.0);
    assert!(
        spindle("X=20,Z=100,C=90")
            .as_f64()
            .is_some_and(|um| um > 0.9)
    );
}
