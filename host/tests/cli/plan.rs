//! `leadscrew plan`.

use crate::{Folder, assert_says};

const OWN: &str = "[[machine]]\nname = \"Own\"\n[[machine.axis]]\nname = \"X\"\nmax_feed_mm_per_min = 120000\n\
                   overload_g = 10\nmax_jerk_m_s3 = 5000\ncounts_per_mm = 100000\n";

#[test]
fn every_machine_has_its_golden_figures() {
    let folder = Folder::new();
    let mut text = folder.printed("plan");
    let list = folder.json("plan --list");
    for machine in list["machines"].as_array().unwrap() {
        let name = machine["name"].as_str().unwrap();
        let output = folder.command(["plan", name]).output().unwrap();
        assert!(output.status.success());
        text += "\n=====\n";
        text += &crate::text(&output.stdout);
    }
    insta::assert_snapshot!(text);
}

#[test]
fn the_figures_are_there_as_json() {
    let folder = Folder::new();
    let report = folder.json("plan 16k20f3 --radius 5,20 --tick-hz 2500");
    assert_eq!(report["schema"], "leadscrew/plan/1");
    let machine = &report["machines"][0];
    assert_eq!(machine["machine"], "16K20F3");
    assert_eq!(machine["tick_hz"], 2500.0);
    let z = &machine["axes"][0];
    assert_eq!(z["velocity_d_per_tick"], 50.0);
    assert_eq!(z["contours"].as_array().unwrap().len(), 2);
    assert_eq!(machine["boards"][0]["runs"], "shown");
    let all = folder.json("plan");
    assert_eq!(all["machines"].as_array().unwrap().len(), 7);
}

#[test]
fn a_machine_of_ones_own_is_planned_and_35_khz_are_refused() {
    let folder = Folder::new();
    folder.write("own.toml", OWN);
    let text = folder.printed("plan own --catalogue own.toml");
    assert_says(
        &text,
        &[
            "35018 Hz",
            "1000 Hz are too slow",
            "stm32f4 (F405, F407) at 35018 Hz: no",
        ],
    );
}

#[test]
fn errors_name_what_to_do() {
    let folder = Folder::new();
    folder.write("own.toml", OWN);
    folder.write("bad.toml", OWN.replace("= 10\n", "= \"much\"\n"));
    for (code, arguments, said) in [
        (
            2,
            "plan lathe",
            "the machine lathe is in no catalogue; there are 16K20F3",
        ),
        (
            2,
            "plan 16k20f3 --encoder X",
            "the encoder X is in no catalogue; there are BE178",
        ),
        (
            2,
            "plan 16k20f3 --encoder ern420",
            "ERN 420 comes with 1000 to 5000 lines: say which by lines",
        ),
        (
            2,
            "plan 16k20f3 --tick-hz 99",
            "tick_hz = 99 is out of range",
        ),
        (
            2,
            "plan 16k20f3 --radius 0",
            "radius_mm = 0 is out of range",
        ),
        (
            2,
            "plan 16k20f3 --chord -1",
            "allowed_chord_error_d = -1 is out of range",
        ),
        (2, "plan --plot figure.pdf", "figure.pdf"),
        (1, "plan --catalogue none.toml", "none.toml: cannot be read"),
        (
            1,
            "plan --catalogue bad.toml",
            "bad.toml:6:14: invalid type: string",
        ),
        (
            1,
            "plan --catalogue own.toml --catalogue own.toml",
            "own.toml:2:8: machine \"Own\": there is one of that name already",
        ),
    ] {
        let error = folder.refused(code, arguments);
        assert!(error.contains(said), "{arguments}: {error}");
    }
}

#[test]
fn the_papers_figures_are_drawn() {
    let folder = Folder::new();
    for (arguments, says) in [
        ("plan --plot f.svg", ["MIKRON UCP 710 X, mm/min", "by jerk"]),
        (
            "plan MA655SM30A --plot f.svg",
            ["MA655SM30A others, mm/min", "radius, mm"],
        ),
        ("plan --plot f.svg --figure 4", ["R 0.25 mm", "J 5000 m/s³"]),
        (
            "plan --plot f.svg --figure 5",
            ["resolution, d/mm", "n 10 g"],
        ),
    ] {
        folder.printed(arguments);
        assert_says(&folder.read("f.svg"), &says);
    }
}
