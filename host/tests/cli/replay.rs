//! `leadscrew replay` of a known motion: what it reports and writes.

use std::path::Path;

use leadscrew::estimator::EstimatorConfig;
use serde_json::Value;

use crate::capture_files::{saleae_csv, sigrok_csv};
use crate::pictures::assert_picture;
use crate::scenes::{RAMP_EDGES, put_ramp, ramp, real_ramp};
use crate::table::{SHARED, Table};
use crate::{Folder, assert_says, keys, number};

/// The part of the ramp's rising half that no window of an estimator leaves.
const RISING: &str = "--from-s 0.05 --to-s 0.29";

/// Asserts the figures of the ramp in a file, at both rates of the papers.
#[track_caller]
fn assert_ramp(folder: &Folder, file: &Path) {
    let file = file.to_str().expect("paths of tests are text");
    for (tick_hz, acceleration, ticks) in [(1000, 0.141_47, 601), (2500, 0.022_635, 1501)] {
        let report = folder.json(&format!("replay {file} --tick-hz {tick_hz} {RISING}"));
        assert_eq!(report["schema"], "leadscrew/replay/1");
        assert_eq!(report["edges"], RAMP_EDGES);
        assert_eq!(report["illegal"], 0);
        assert_eq!(report["final_count"], RAMP_EDGES);
        assert_eq!(report["ticks"], ticks);
        assert_eq!(report["overspeed_ticks"], 0);
        for name in EstimatorConfig::NAMES {
            let fit = number(&report, &format!("/estimators/{name}/acceleration_fit"));
            let error = fit / acceleration - 1.0;
            assert!(error.abs() < 0.005, "{name} at {tick_hz} Hz: {fit}");
            // v = 2 t/(14.13721 ms²): 42.44 d/ms at the top.
            // Of the other estimators it hangs on the first and last tick of the span.
            if *name == "polynomial" {
                assert_fine(&report, acceleration);
            }
            let peak = number(&report, &format!("/estimators/{name}/velocity_peak"));
            let top = 42.441 * 1000.0 / f64::from(tick_hz);
            assert!(peak > top - 1.0 && peak < top + 1.0, "{name}: {peak}");
        }
    }
}

/// Asserts both figures of the acceleration from edge times to 0.1 %.
#[track_caller]
fn assert_fine(report: &Value, acceleration: f64) {
    for figure in ["acceleration_fit", "acceleration_mean"] {
        let found = number(report, &format!("/estimators/polynomial/{figure}"));
        let error = found / acceleration - 1.0;
        assert!(error.abs() < 0.001, "{figure}: {found}");
    }
}

/// Asserts the acceleration by the polynomial on the falling half in a file, at both rates of the papers.
#[track_caller]
fn assert_falling(folder: &Folder, file: &Path) {
    let file = file.to_str().expect("paths of tests are text");
    for (tick_hz, acceleration) in [(1000, -0.141_47), (2500, -0.022_635)] {
        let span = "--from-s 0.35 --to-s 0.59";
        let report = folder.json(&format!("replay {file} --tick-hz {tick_hz} {span}"));
        assert_fine(&report, acceleration);
    }
}

#[test]
fn the_ramp_as_the_test_writes_it() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    assert_ramp(&folder, "ramp.vcd".as_ref());
}

#[test]
fn the_ramp_of_the_sigrok_project() {
    if let Some(file) = real_ramp() {
        assert_ramp(&Folder::new(), &file);
        assert_falling(&Folder::new(), &file);
    }
}

#[test]
fn the_falling_half_slows_down_as_fast() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    assert_falling(&folder, "ramp.vcd".as_ref());
    let report = folder.json("replay ramp.vcd --from-s 0.35 --to-s 0.59");
    for name in EstimatorConfig::NAMES {
        let fit = number(&report, &format!("/estimators/{name}/acceleration_fit"));
        assert!((fit / -0.141_47 - 1.0).abs() < 0.005, "{name}: {fit}");
    }
}

#[test]
fn json_has_its_keys() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    let report = folder.json("replay ramp.vcd");
    assert_eq!(
        keys(&report),
        [
            "ambiguous_ticks",
            "edges",
            "estimators",
            "final_count",
            "illegal",
            "map",
            "overrun_ticks",
            "overspeed_ticks",
            "schema",
            "tick_hz",
            "ticks",
            "units"
        ]
    );
    assert_eq!(report["units"]["acceleration_fit"], "d/tick²");
    let mut names = EstimatorConfig::NAMES.to_vec();
    names.sort_unstable();
    assert_eq!(keys(&report["estimators"]), names);
    for name in names {
        assert_eq!(
            keys(&report["estimators"][name]),
            [
                "acceleration_fit",
                "acceleration_mean",
                "acceleration_rms",
                "lag_a_ticks",
                "lag_v_ticks",
                "lag_x_ticks",
                "model",
                "velocity_peak"
            ]
        );
    }
}

#[test]
fn every_format_gives_the_same_report() {
    let folder = Folder::new();
    let recording = ramp();
    put_ramp(&folder, "ramp.vcd");
    let csv = sigrok_csv(&recording, &["0", "1"]);
    folder.write("sigrok.csv", &csv);
    let stripped: Vec<_> = csv.lines().filter(|line| !line.starts_with(';')).collect();
    folder.write("stripped.csv", stripped.join("\n"));
    folder.write(
        "saleae.csv",
        saleae_csv(&recording, &["Channel 0", "Channel 1"], -1234),
    );

    let report = |arguments: &str| -> (Value, String) {
        let report = folder.json(&format!("replay {arguments} {RISING} --csv ticks.csv"));
        (report, folder.read("ticks.csv"))
    };
    let expected = report("ramp.vcd");
    for arguments in [
        "sigrok.csv",
        "saleae.csv",
        "stripped.csv --samplerate 1000000",
    ] {
        assert!(report(arguments) == expected, "{arguments}");
    }
    let message = folder.refused(1, "replay stripped.csv --json");
    assert_says(&message, &["stripped.csv", "--samplerate"]);
}

#[test]
fn the_text_lines_up_and_tells_the_span() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    let printed = folder.printed(&format!("replay ramp.vcd {RISING}"));
    let first = "ramp.vcd: 12732 edges, 0 illegal, final count 12732 d, 601 ticks at 1000 Hz\n";
    assert!(printed.starts_with(first), "{printed}");
    assert_says(
        &printed,
        &["after warm-up, from 0.05 s, to 0.29 s", "d/tick²", "0.141"],
    );
    let (_, table) = printed.split_once("\n\n").expect("a table");
    let widths: Vec<_> = table.lines().map(|line| line.chars().count()).collect();
    assert_eq!(widths.len(), 3 + EstimatorConfig::NAMES.len());
    // The unit of the last column and its figures end in one place.
    assert!(
        widths[2..].iter().all(|width| *width == widths[2]),
        "{table}"
    );
}

#[test]
fn the_csv_has_the_counts_of_the_file_tick_by_tick() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    folder.printed("replay ramp.vcd --tick-hz 1234.5 --csv ticks.csv");
    let table = Table::read(&folder.path("ticks.csv"));
    assert_eq!(table.header.join(","), SHARED);
    // ⌊0.6 s · 1234.5 Hz⌋ = 740.
    table.assert_ticks(741, 1234.5);
    let times: Vec<u64> = ramp().changes.iter().map(|change| change.time).collect();
    for (tick, count) in table.column("count_d").iter().enumerate() {
        // t·f ≤ k, in units of 0.1 µHz.
        let due = |time: &u64| *time * 12_345 <= tick as u64 * 10_000_000;
        let expected = times.iter().filter(|time| due(time)).count();
        assert_eq!(*count, expected as f64, "tick {tick}");
    }
    // Estimates hold for the instant `lag` before the row: v = 2 t/(14.13721 ms²).
    let lag = table.column("lag_v_ticks")[0];
    for tick in 100..370 {
        let time_ms = (tick as f64 - lag) / 1.2345;
        let expected = 2.0 * time_ms / 14.137_21 / 1.2345;
        let velocity = table.column("velocity_d_per_tick")[tick];
        assert!(
            (velocity - expected).abs() < 0.3,
            "tick {tick}: {velocity}, {expected}"
        );
    }
}

#[test]
fn the_default_csv_is_exponential() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    folder.printed("replay ramp.vcd --csv default.csv");
    for name in EstimatorConfig::NAMES {
        folder.printed(&format!(
            "replay ramp.vcd --estimator {name} --csv named.csv"
        ));
        let same = folder.read("named.csv") == folder.read("default.csv");
        assert_eq!(same, *name == "exponential", "{name}");
    }
}

#[test]
fn plots_in_both_formats() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    for plot in ["ramp.svg", "ramp.png"] {
        folder.printed(&format!("replay ramp.vcd --plot {plot}"));
        assert_picture(&folder.path(plot));
    }
    let svg = folder.read("ramp.svg");
    assert_says(&svg, &["ramp.vcd at 1000 Hz", "velocity, d/tick"]);
    for name in EstimatorConfig::NAMES {
        assert_says(&svg, &[name]);
    }
}
