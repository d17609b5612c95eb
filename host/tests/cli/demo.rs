//! No subcommand: the demonstration.

use leadscrew::estimator::EstimatorConfig;

use crate::pictures::assert_picture;
use crate::{Folder, assert_clear, assert_says, text};

/// Widest line of a plain terminal.
const TERMINAL_COLUMNS: usize = 80;

/// Figures of an estimator: three lags, rms v, rms a and its cut, tacho and its cut, error peak and
/// rms.
fn figures(printed: &str, name: &str) -> [f64; 10] {
    let row = printed.lines().find(|line| line.starts_with(name));
    let row = row.unwrap_or_else(|| panic!("{name} is not in the table:\n{printed}"));
    let cells = row.split_whitespace().skip(1);
    let figures: Vec<f64> = cells.map(|cell| cell.parse().expect("a figure")).collect();
    figures.try_into().expect("ten figures")
}

#[test]
fn prints_a_table_of_every_estimator_and_the_plots() {
    let folder = Folder::new();
    let printed = folder.printed("");
    for line in printed.lines() {
        assert!(line.chars().count() <= TERMINAL_COLUMNS, "{line}");
    }
    for name in EstimatorConfig::NAMES {
        let [_, _, _, errors @ ..] = figures(&printed, name);
        assert!(errors.iter().all(|figure| *figure > 0.0), "{name}");
        let [.., peak, rms] = errors;
        assert!(peak > rms, "{name}");
        // Plain differences are the yardstick of the cuts.
        let (cut, tacho_cut) = (errors[2], errors[4]);
        match *name {
            "difference" => assert_eq!((cut, tacho_cut), (1.0, 1.0)),
            _ => assert!(cut > 1.0 && tacho_cut > 1.0, "{name}"),
        }
    }
    assert_says(&printed, &["ramps included, seed 1"]);
    let plots: Vec<_> = printed
        .lines()
        .filter(|line| line.starts_with("target/leadscrew/"))
        .collect();
    assert_eq!(plots.len(), 6, "{printed}");
    for plot in plots {
        assert_picture(&folder.path(plot));
    }
    assert_eq!(folder.listing(), ["target"]);
}

#[test]
fn a_folder_that_cannot_be_made_is_an_error() {
    let folder = Folder::new();
    folder.write("target", "in the way");
    let output = folder.run("");
    let errors = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{errors}");
    assert_clear(&errors);
    assert_says(&errors, &["target/leadscrew", "cannot be written"]);
}
