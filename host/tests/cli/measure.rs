//! `leadscrew measure`.

use leadscrew_process::metrology::part;

use crate::{Folder, assert_says, keys, number};

const HOUSING: &str = include_str!("../../../process/tests/metrology/data/housing.toml");

/// A table of touches of the housing: moved by (20, −30, 50) µm and turned by 0.2 mrad about x, with up to 1 µm of scatter, and
/// touch 5 of the face off by `off_mm`.
fn table(off_mm: f64) -> String {
    let part = part::read(HOUSING).unwrap();
    let mut table = "feature,point,measured_x_mm,measured_y_mm,measured_z_mm\n".to_owned();
    let mut count = 0_u32;
    for feature in &part.features {
        for planned in &feature.planned {
            count += 1;
            let [_, y, z] = planned.nominal;
            let moved = [0.020, -0.030 - 2e-4 * z, 0.050 + 2e-4 * y];
            let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let mut along = dot(moved, planned.normal) + (f64::from(count * 37 % 11) - 5.0) * 2e-4;
            if feature.name == "top" && planned.point == "5" {
                along += off_mm;
            }
            let place: [f64; 3] =
                std::array::from_fn(|axis| planned.nominal[axis] + planned.normal[axis] * along);
            let [x, y, z] = place;
            table += &format!("{},{},{x:.6},{y:.6},{z:.6}\n", feature.name, planned.point);
        }
    }
    table
}

fn folder(off_mm: f64) -> Folder {
    let folder = Folder::new();
    folder.write("housing.toml", HOUSING);
    folder.write("touches.csv", table(off_mm));
    folder
}

#[test]
fn a_housing_has_its_golden_table() {
    insta::assert_snapshot!(folder(0.0).printed("measure housing.toml --touches touches.csv"));
}

#[test]
fn a_bad_touch_is_flagged_and_left_out_when_asked() {
    let folder = folder(0.2);
    let flagged = folder.printed("measure housing.toml --touches touches.csv");
    assert_says(
        &flagged,
        &[
            "top/5",
            "counts: --without-outliers",
            "top: the residuals are larger",
        ],
    );
    let offset = |report: &serde_json::Value| number(report, "/features/0/values/0/value");
    let counts = folder.json("measure housing.toml --touches touches.csv");
    let without = folder.json("measure housing.toml --touches touches.csv --without-outliers");
    assert!((offset(&counts) - 0.05).abs() > 0.02, "{}", offset(&counts));
    assert!(
        (offset(&without) - 0.05).abs() < 0.003,
        "{}",
        offset(&without)
    );
    let left_out = folder.printed("measure housing.toml --touches touches.csv --without-outliers");
    assert_says(&left_out, &["top/5", "left out"]);
}

#[test]
fn the_json_has_values_and_touches() {
    let report = folder(0.0).json("measure housing.toml --touches touches.csv");
    assert_eq!(report["schema"], "leadscrew/measure/1");
    assert_eq!(
        keys(&report),
        ["features", "level", "schema", "without_outliers"]
    );
    assert_eq!(report["features"].as_array().unwrap().len(), 12);
    let top = &report["features"][0];
    assert_eq!(top["name"], "top");
    assert_eq!(top["sigma_from"], "stated");
    assert_eq!(top["touches"].as_array().unwrap().len(), 5);
    assert_eq!(
        keys(&top["values"][0]),
        ["quantity", "sigma", "unit", "value"]
    );
}

#[test]
fn the_program_is_written_for_the_log_that_is_read() {
    let folder = folder(0.0);
    let said = folder.printed("measure housing.toml --program out.ngc");
    assert_says(&said, &["out.ngc: 30 touches", "housing.txt"]);
    let program = folder.read("out.ngc");
    assert_eq!(program.matches("G38.2").count(), 30);
    assert_says(
        &program,
        &["(PROBEOPEN housing.txt)", "(PROBECLOSE)", "G21", "M2"],
    );
    // A log of the planned places: the centre of the stylus at the latch.
    let part = part::read(HOUSING).unwrap();
    let line = |planned: &part::Planned| {
        let pretravel = if planned.normal[2] > 0.9 {
            0.002
        } else {
            0.004
        };
        let [x, y, z]: [f64; 3] = std::array::from_fn(|axis| {
            planned.nominal[axis] + planned.normal[axis] * (3.0 - pretravel)
        });
        format!("{x:.6} {y:.6} {z:.6} 0 0 0 0 0 0\n")
    };
    let planned = part.features.iter().flat_map(|feature| &feature.planned);
    folder.write("housing.txt", planned.map(line).collect::<String>());
    let report = folder.json("measure housing.toml --log housing.txt");
    assert!(number(&report, "/features/0/values/0/value").abs() < 1e-6);
}

#[test]
fn residuals_are_drawn() {
    let folder = folder(0.03);
    folder.printed("measure housing.toml --touches touches.csv --plot residuals.svg");
    let picture = folder.read("residuals.svg");
    assert_says(&picture, &["flagged", "residual, µm", "II"]);
}

#[test]
fn what_cannot_be_is_refused() {
    let folder = folder(0.0);
    let table = folder.read("touches.csv");
    folder.write("bad.csv", table.replacen("top,3", "roof,3", 1));
    folder.write(
        "bad.toml",
        HOUSING.replacen("diameter_mm", "diametre_mm", 1),
    );
    folder.write("short.txt", "10 10 3 0 0 0 0 0 0\n");
    let refused = |arguments: &str| folder.refused(1, arguments);
    assert_says(
        &refused("measure housing.toml --touches bad.csv"),
        &["bad.csv:4:1:", "`roof`"],
    );
    assert_says(
        &refused("measure bad.toml --touches touches.csv"),
        &["bad.toml:31:1:", "diametre_mm"],
    );
    assert_says(
        &refused("measure housing.toml --log short.txt"),
        &["short.txt:", "1 lines for 30"],
    );
    assert_says(
        &refused("measure housing.toml --touches none.csv"),
        &["none.csv"],
    );
    let usage = folder.refused(2, "measure housing.toml --touches touches.csv --level 1");
    assert_says(&usage, &["--level 1"]);
    let plot = folder.refused(2, "measure housing.toml --touches touches.csv --plot a.gif");
    assert_says(&plot, &["a.gif"]);
    let over = folder.refused(2, "measure housing.toml --program housing.toml");
    assert_says(&over, &["housing.toml"]);
}
