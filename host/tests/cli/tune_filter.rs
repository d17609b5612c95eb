//! `leadscrew tune-filter`: what it finds best, and what it refuses.

use leadscrew::estimator::EstimatorConfig;
use leadscrew_host::recording::{Change, Recording};
use serde_json::Value;

use crate::capture_files::sigrok_vcd;
use crate::pictures::assert_picture;
use crate::scenes::{levels_at, put_ramp, real_ramp, short_walk};
use crate::{Folder, assert_says, keys, number};

/// The best entry of an estimator.
#[track_caller]
fn optimum<'r>(report: &'r Value, estimator: &str) -> &'r Value {
    let optima = report["optima"].as_array().expect("indices");
    let mut entries = optima.iter().map(|index| {
        let index = index.as_u64().expect("an index") as usize;
        &report["sweep"][index]
    });
    let found = entries.find(|entry| entry["estimator"] == estimator);
    found.expect(estimator)
}

fn entries(report: &Value) -> &[Value] {
    report["sweep"].as_array().expect("entries")
}

#[test]
fn table_1_has_its_optima_with_computed_lags() {
    let report = Folder::new().json("tune-filter --scene table-1");
    assert_eq!(report["reference"], "truth");
    assert_eq!(report["ticks"], 10_000);
    let raw = optimum(&report, "difference");
    let sigma = number(raw, "/sigma_a");
    assert!((sigma / 1.695 - 1.0).abs() < 0.01, "{sigma}");
    for (estimator, symbol, low, high) in [
        ("exponential", "α", 0.14, 0.18),
        ("simple", "N", 8.0, 10.0),
        ("gaussian", "σ", 5.0, 6.0),
    ] {
        let best = optimum(&report, estimator);
        assert_eq!(best["parameter"], symbol);
        let value = number(best, "/value");
        assert!((low..=high).contains(&value), "{estimator}: {value}");
    }
    // With the paper's own parameters Φ is that of the golden table.
    for (estimator, value, phi) in [
        ("exponential", 0.18, 0.353),
        ("simple", 15.0, 0.329),
        ("gaussian", 6.0, 0.283),
    ] {
        let entry = entries(&report)
            .iter()
            .find(|entry| entry["estimator"] == estimator && entry["value"] == value);
        let found = number(entry.expect(estimator), "/phi");
        assert!((found / phi - 1.0).abs() < 0.02, "{estimator}: {found}");
    }
}

#[test]
fn figures_belong_together() {
    let folder = Folder::new();
    let arguments = "tune-filter --scene flywheel --lag-weight 0.2 --sigma-weight 3";
    let report = folder.json(arguments);
    assert_eq!(
        keys(&report),
        [
            "best",
            "map",
            "optima",
            "reference",
            "schema",
            "source",
            "sweep",
            "tick_hz",
            "ticks",
            "units",
            "weights"
        ]
    );
    assert_eq!(report["schema"], "leadscrew/tune-filter/1");
    let mut least = f64::INFINITY;
    for entry in entries(&report) {
        let figure = |name: &str| number(entry, &format!("/{name}"));
        let (lag, sigma, phi) = (figure("t_z_ticks"), figure("sigma_a"), figure("phi"));
        assert!((phi - 0.2 * lag - 3.0 * sigma).abs() < 1e-12);
        let bandwidth = figure("bandwidth_hz");
        assert!((bandwidth * 4.0 * lag - 1000.0).abs() < 1e-9);
        assert_eq!(entry["suits_thyristor"], bandwidth >= 20.0);
        assert_eq!(entry["suits_transistor"], bandwidth >= 40.0);
        let name = entry["estimator"].as_str().expect("a name");
        assert!(phi >= number(optimum(&report, name), "/phi"), "{name}");
        least = least.min(phi);
    }
    for name in EstimatorConfig::NAMES {
        optimum(&report, name);
    }
    let best = report["best"].as_u64().expect("an index") as usize;
    assert_eq!(number(&report["sweep"][best], "/phi"), least);
    assert_eq!(report, folder.json(arguments), "it is not repeatable");
}

#[test]
fn the_text_says_what_it_is_and_marks_the_best() {
    let printed = Folder::new().printed("tune-filter --scene real-slow --tick-hz 2500");
    assert_says(
        &printed,
        &[
            "scene real-slow",
            "2500 Hz, 10000 ticks",
            "computed lag of the acceleration, not read off transients",
            "against the truth",
            "transistor",
        ],
    );
    let (optima, all) = printed
        .split_once("all that was tried")
        .expect("two tables");
    let marked = |table: &str, mark: &str| {
        let ends = |line: &&str| line.trim_end().ends_with(mark);
        table.lines().filter(ends).count()
    };
    for table in [optima.split_once("of all\n").expect("a table").1, all] {
        assert_eq!(marked(table, " *"), EstimatorConfig::NAMES.len() - 1);
        assert_eq!(marked(table, "**"), 1, "{table}");
    }
}

#[test]
fn a_capture_is_judged_by_its_own_trend() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    assert_ramp(&folder.json("tune-filter ramp.vcd"));
    if let Some(file) = real_ramp() {
        let file = file.to_str().expect("paths of tests are text");
        assert_ramp(&folder.json(&format!("tune-filter {file}")));
    }
}

/// The ramp is nothing but a constant acceleration, so that rounding to counts is all the error there is: 1/√12 d
/// differenced twice.
#[track_caller]
fn assert_ramp(report: &Value) {
    assert_eq!(report["reference"], "trend");
    let raw = number(optimum(report, "difference"), "/sigma_a");
    assert!((raw / 0.5_f64.sqrt() - 1.0).abs() < 0.03, "{raw}");
    let fine = number(optimum(report, "polynomial"), "/sigma_a");
    assert!(fine < 0.003, "{fine}");
}

#[test]
fn a_capture_without_steady_motion_is_refused() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    let message = folder.refused(1, "tune-filter ramp.vcd --tick-hz 100 --json");
    assert_says(
        &message,
        &["ramp.vcd", "no steady motion", "--tick-hz", "--from-s"],
    );
    folder.write("short.vcd", short_walk());
    let message = folder.refused(1, "tune-filter short.vcd --json");
    assert_says(&message, &["short.vcd", "constant feed"]);
    // To and fro once in a while: no stretch is long enough.
    let change = |step: u64| Change {
        time: 90 * step,
        levels: levels_at(if (step / 500).is_multiple_of(2) {
            step as i64 % 500
        } else {
            500 - step as i64 % 500
        }),
    };
    let recording = Recording {
        clock_hz: 1_000_000,
        duration: 900_000,
        initial: levels_at(0),
        changes: (1..10_000).map(change).collect(),
    };
    folder.write("swing.vcd", sigrok_vcd(&recording, &["A", "B"]));
    let message = folder.refused(1, "tune-filter swing.vcd --json");
    assert_says(&message, &["swing.vcd", "0 ticks have a trend"]);
}

#[test]
fn bad_usage_is_told() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    for (arguments, parts) in [
        ("tune-filter", ["name a capture", "--scene"]),
        (
            "tune-filter ramp.vcd --scene real",
            ["cannot be used with", "--scene"],
        ),
        ("tune-filter --scene lathe", ["table-1", "flywheel"]),
        ("tune-filter --scene real --map x", ["--map", "--scene"]),
        (
            "tune-filter --scene real --lag-weight -1",
            ["--lag-weight = -1", "allowed 0 to"],
        ),
        (
            "tune-filter --scene real --sigma-weight nan",
            ["--sigma-weight", "allowed 0 to"],
        ),
        (
            "tune-filter --scene real --lag-weight 0 --sigma-weight 0",
            ["--lag-weight 0", "give one of them"],
        ),
        (
            "tune-filter --scene real --tick-hz 1",
            ["--tick-hz", "allowed 100 to 40000"],
        ),
        ("tune-filter ramp.vcd --plot ramp.vcd", ["ramp.vcd", ".png"]),
        (
            "tune-filter ramp.vcd --from-s 2 --to-s 1",
            ["--from-s", "the span must"],
        ),
    ] {
        assert_says(&folder.refused(2, arguments), &parts);
    }
}

#[test]
fn the_plot_has_every_estimator() {
    let folder = Folder::new();
    for plot in ["tuned.svg", "tuned.png"] {
        folder.printed(&format!("tune-filter --scene flywheel --plot {plot}"));
    }
    assert_picture(&folder.path("tuned.png"));
    let svg = folder.read("tuned.svg");
    assert_says(&svg, &["optimum", "lag of the acceleration t_z, ticks"]);
    for name in EstimatorConfig::NAMES {
        assert_says(&svg, &[name]);
    }
}
