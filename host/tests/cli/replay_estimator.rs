//! `leadscrew replay`: the parameters of an estimator.

use crate::scenes::put_ramp;
use crate::table::Table;
use crate::{Folder, assert_says, number};

/// The part of the rising half that a window of 40 ticks does not leave.
const RISING: &str = "--from-s 0.07 --to-s 0.29";

#[test]
fn a_window_sets_lags_and_figures() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    for (choice, name, lags) in [
        ("--estimator simple --window 9", "simple", [4.0, 4.5, 5.0]),
        (
            "--estimator polynomial --window 8",
            "polynomial",
            [0.0, 0.0, 4.0],
        ),
        (
            "--estimator polynomial --window 8 --answer centre",
            "polynomial",
            [4.0; 3],
        ),
        (
            "--estimator polynomial --answer centre",
            "polynomial",
            [7.5; 3],
        ),
        (
            "--estimator polynomial --window 40 --answer newest",
            "polynomial",
            [0.0, 0.0, 20.0],
        ),
    ] {
        let report = folder.json(&format!(
            "replay ramp.vcd {choice} {RISING} --csv x.csv --plot x.svg"
        ));
        let table = Table::read(&folder.path("x.csv"));
        let names = ["lag_x_ticks", "lag_v_ticks", "lag_a_ticks"];
        for (lag, expected) in names.into_iter().zip(lags) {
            let stated = number(&report, &format!("/estimators/{name}/{lag}"));
            // The mean of what the estimates state, a window that widens at the start from rest included.
            assert!((stated - expected).abs() < 0.5, "{choice}: {lag} {stated}");
            // The edges of a tick lie up to half an edge's spacing beside its middle.
            let in_row = table.column(lag)[200];
            assert!((in_row - expected).abs() < 0.1, "{choice}: {lag} {in_row}");
        }
        let fit = number(&report, &format!("/estimators/{name}/acceleration_fit"));
        assert!((fit / 0.141_47 - 1.0).abs() < 0.001, "{choice}: {fit}");
        assert!(folder.read("x.svg").contains(name));
    }
}

#[test]
fn the_built_in_parameters_can_be_said() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    let rows = |choice: &str| {
        folder.printed(&format!("replay ramp.vcd {choice} --csv x.csv"));
        folder.read("x.csv")
    };
    let simple = rows("--estimator simple");
    assert!(simple == rows("--estimator simple --window 15"));
    let polynomial = rows("--estimator polynomial");
    assert!(polynomial == rows("--estimator polynomial --window 15 --answer newest"));
    assert!(polynomial != rows("--estimator polynomial --window 14"));
    assert!(polynomial != rows("--estimator polynomial --answer centre"));
}

#[test]
fn parameters_that_an_estimator_lacks_are_bad_usage() {
    let folder = Folder::new();
    put_ramp(&folder, "ramp.vcd");
    for (arguments, parts) in [
        ("--window 9", ["--window", "--estimator"]),
        ("--answer centre", ["--answer", "--estimator"]),
        (
            "--estimator exponential --window 9",
            ["exponential is not set by a window", "simple or polynomial"],
        ),
        (
            "--estimator gaussian --window 9",
            ["gaussian is not set by a window", "leave it out"],
        ),
        (
            "--estimator simple --answer newest",
            ["simple has no choice", "--estimator polynomial"],
        ),
        (
            "--estimator simple --window 65",
            ["--window 65", "simple takes 1 to 64"],
        ),
        (
            "--estimator polynomial --window 3",
            ["--window 3", "polynomial takes 4 to 64"],
        ),
        (
            "--estimator polynomial --window -3",
            ["--window", "invalid"],
        ),
        (
            "--estimator polynomial --answer oldest",
            ["oldest", "centre"],
        ),
    ] {
        let message = folder.refused(2, &format!("replay ramp.vcd {arguments} --json"));
        assert_says(&message, &parts);
    }
}
