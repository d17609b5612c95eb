//! `leadscrew identify`.

use crate::{Folder, assert_says, number};

#[test]
fn every_figure_stands_beside_that_of_the_machine() {
    let folder = Folder::new();
    let report = folder.json("identify --plot motion.svg");
    assert_eq!(report["schema"], "leadscrew/identify/1");
    assert_eq!(report["polarity"], "right");
    assert!(number(&report, "/furthest_mm") < 10.0);
    let figures = report["figures"].as_array().expect("figures");
    assert_eq!(figures.len(), 14);
    for figure in figures {
        let name = figure["name"].as_str().expect("a name");
        let (value, sigma, truth) = (
            number(figure, "/value"),
            number(figure, "/sigma"),
            number(figure, "/truth"),
        );
        assert!(sigma > 0.0, "{name}");
        assert!(
            (value - truth).abs() < 3.0 * sigma,
            "{name}: {value} ± {sigma}, true {truth}"
        );
    }
    assert_eq!(folder.listing(), ["motion.svg"]);
}

#[test]
fn the_text_has_units_and_uncertainty() {
    let folder = Folder::new();
    let text = folder.printed("identify --machine 16k20f3-bare --seed 3");
    assert_says(
        &text,
        &[
            "polarity: right",
            "1σ",
            "machine",
            "natural period",
            "ms",
            "m/s²",
            "seed 3",
        ],
    );
    assert!(!text.contains("-0.0000"), "{text}");
}

#[test]
fn machines_that_cannot_be_identified_are_refused_with_what_to_do() {
    let folder = Folder::new();
    let wrong = folder.refused(1, "identify --reverse-drive --json");
    assert_says(&wrong, &["wrong polarity", "exchange A and B", "16k20f3"]);
    folder.write("dead.toml", "[mount]\ncoupling_slip = 1.0\n");
    folder.write("blocked.toml", "[drive]\nfriction_mm_per_min = 50000.0\n");
    for machine in ["dead.toml", "blocked.toml"] {
        let none = folder.refused(1, &format!("identify --machine {machine} --plot x.png"));
        assert_says(&none, &["no motion", "encoder", "blocked", machine]);
    }
    let small = folder.refused(1, "identify --window-mm 2");
    assert_says(&small, &["window"]);
}

#[test]
fn usage_is_checked_before_anything_runs() {
    let folder = Folder::new();
    for (arguments, part) in [
        ("identify --window-mm 0", "--window-mm = 0"),
        ("identify --tick-hz 10", "--tick-hz"),
        ("identify --nominal-feed -1", "--nominal-feed"),
        ("identify --machine nothing", "expected one of"),
        ("identify --plot x.pdf", ".svg"),
    ] {
        let message = folder.refused(2, arguments);
        assert_says(&message, &[part]);
    }
}
