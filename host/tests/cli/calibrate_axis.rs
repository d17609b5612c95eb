//! `leadscrew calibrate-axis`.

use std::fmt::Write as _;

use crate::{Folder, assert_says};

const TARGETS: [f64; 6] = [0.3, 61.7, 122.4, 188.9, 243.1, 307.6];

/// Five runs of a screw of 20 µm/m, 4 µm of play, at 22 °C; run j is j/10 µm off.
fn runs(targets: &[f64]) -> String {
    let mut text = "target_mm,direction,run,deviation_um,temperature_c\n".to_owned();
    for run in 1..=5 {
        for (direction, play) in [("up", -2.0), ("down", 2.0)] {
            for target in targets {
                let deviation = 0.02 * target + play + 0.1 * f64::from(run - 3) + 0.023 * target;
                let _ = writeln!(text, "{target},{direction},{run},{deviation:.4},22");
            }
        }
    }
    text
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("runs.csv", runs(&TARGETS));
    folder
}

#[test]
fn the_report_is_the_golden_one() {
    let folder = folder();
    let text = folder.printed(
        "calibrate-axis runs.csv --pitch 10 --device 1 --misalignment 0.5 --thermometer 0.5 --expansion-range 1 --drift 1",
    );
    insta::assert_snapshot!(text);
}

/// What nobody told is unknown, not 0: drift alone gives an uncertainty to all figures, the instrument none to a reversal.
#[test]
fn an_uncertainty_without_a_source_is_none() {
    let folder = folder();
    let last = |arguments: &str, figure: &str| {
        let text = folder.printed(&format!("calibrate-axis runs.csv --pitch 10 {arguments}"));
        let row = text.lines().find(|line| line.starts_with(figure)).unwrap();
        row.split_whitespace().last().unwrap().to_owned()
    };
    assert_eq!(last("", "accuracy A"), "-");
    assert_eq!(last("--device 1", "reversal B"), "-");
    assert_eq!(last("--device 1", "accuracy A"), "0.31");
    assert_eq!(last("--drift 1", "reversal B"), "0.37");
}

#[test]
fn figures_tables_and_plot_are_written() {
    let folder = folder();
    let report = folder.json(
        "calibrate-axis runs.csv --table errors.csv --linuxcnc x.comp --linuxcnc-type 1 --plot runs.svg",
    );
    assert_eq!(report["schema"], "leadscrew/calibrate-axis/1");
    let axis = &report["calibration"]["axis"];
    let near = |key: &str, expected: f64| {
        let found = axis[key].as_f64().unwrap();
        assert!((found - expected).abs() < 1e-3, "{key} = {found}");
    };
    near("mean_reversal_um", -4.0);
    near("mean_range_um", 0.02 * (307.6 - 0.3));
    near("systematic_um", 0.02 * (307.6 - 0.3) + 4.0);
    let table = folder.read("errors.csv");
    assert_says(
        &table,
        &["position_mm,forward_um,backward_um", "61.7,-0.7660,3.2340"],
    );
    assert_says(
        &folder.read("x.comp"),
        &["61.700000000 0.000766000 -0.003234000"],
    );
    assert_says(
        &folder.read("runs.svg"),
        &["runs.csv: A ", "up, mean", "target, mm"],
    );
}

#[test]
fn a_screw_table_goes_to_the_axis_and_back() {
    let folder = folder();
    folder.printed("calibrate-axis runs.csv --table errors.csv");
    let run = |arguments: &str| {
        let output = folder.run(&format!("--port sim --flash axis.flash {arguments}"));
        assert!(
            output.status.success(),
            "{arguments}: {}",
            crate::text(&output.stderr)
        );
        crate::text(&output.stdout)
    };
    let written = run("screw-table write errors.csv");
    assert_says(
        &written,
        &[
            "written errors.csv: 6 points, 96 bytes",
            "compensation.screw_table=1",
        ],
    );
    assert_says(
        &run("screw-table read back.csv"),
        &["read back.csv: 6 points"],
    );
    let fields = |text: &str| -> Vec<f64> {
        let lines = text.lines().skip(2);
        lines
            .flat_map(|line| {
                line.split(',')
                    .map(|field| field.parse().unwrap())
                    .collect::<Vec<f64>>()
            })
            .collect()
    };
    let (one, other) = (
        fields(&folder.read("errors.csv")),
        fields(&folder.read("back.csv")),
    );
    assert_eq!(one.len(), 18);
    for (one, other) in one.iter().zip(&other) {
        assert!((one - other).abs() < 2e-3, "{one} and {other}");
    }
    let report: serde_json::Value =
        serde_json::from_str(&run("screw-table erase --yes --json")).unwrap();
    assert_eq!(report["what"], "erased");
    let gone = folder.run("--port sim --flash axis.flash screw-table read gone.csv");
    assert_eq!(gone.status.code(), Some(1));
    assert_says(
        &crate::text(&gone.stderr),
        &["no screw table is saved on this axis"],
    );
}

#[test]
fn errors_name_file_place_and_what_to_do() {
    let folder = folder();
    folder.write("bad.csv", runs(&TARGETS).replacen(",22", ",hot", 1));
    folder.write("few.csv", runs(&TARGETS[..4]));
    folder.write("pitch.csv", runs(&[0.0, 50.0, 120.0, 200.0, 240.0, 310.0]));
    folder.write(
        "steep.csv",
        "position_mm,forward_um,backward_um\n0,0,0\n1,200,0\n",
    );
    for (code, arguments, said) in [
        (1, "calibrate-axis none.csv", "none.csv: cannot be read"),
        (
            1,
            "calibrate-axis bad.csv",
            "bad.csv:2:18: temperature_c = \"hot\": expected a number",
        ),
        (
            1,
            "calibrate-axis few.csv",
            "few.csv: 4 targets over 188.6 mm, 5 are needed",
        ),
        (
            1,
            "calibrate-axis pitch.csv --pitch 10",
            "pitch.csv: the targets lie at multiples of the pitch, 10 mm",
        ),
        (1, "calibrate-axis pitch.csv --pitch 10", "--accept-aliased"),
        (
            2,
            "calibrate-axis runs.csv --pitch 0",
            "--pitch = 0 is out of range",
        ),
        (
            2,
            "calibrate-axis runs.csv --expansion 100",
            "machine_expansion_um_per_m_k = 100 is out of range",
        ),
        (
            2,
            "calibrate-axis runs.csv --drift -1",
            "drift_um = -1 is out of range",
        ),
        (
            2,
            "calibrate-axis runs.csv --table runs.csv",
            "is the file that is read",
        ),
        (
            2,
            "calibrate-axis runs.csv --table a.csv --linuxcnc a.csv",
            "give two names",
        ),
        (
            2,
            "calibrate-axis runs.csv --linuxcnc a --linuxcnc-type 2",
            "2 is not in 0..=1",
        ),
        (
            1,
            "--port sim screw-table write none.csv",
            "none.csv: cannot be read",
        ),
        (
            1,
            "--port sim screw-table write runs.csv",
            "runs.csv:1:1: column \"target_mm\" is not known",
        ),
    ] {
        let error = folder.refused(code, arguments);
        assert!(error.contains(said), "{arguments}: {error}");
    }
    let steep = folder.run("--port sim --flash axis.flash screw-table write steep.csv");
    assert_eq!(steep.status.code(), Some(1));
    assert_says(
        &crate::text(&steep.stderr),
        &["steep.csv: the error at point 1 of the screw table differs by 0.2 d a d"],
    );
    let aliased = folder.printed("calibrate-axis pitch.csv --pitch 10 --accept-aliased");
    assert_says(
        &aliased,
        &["warning: the targets lie at multiples of the pitch"],
    );
}
