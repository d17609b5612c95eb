//! The built-in catalogue, those of users, and what is wrong with them.

use leadscrew_process::plan::{Catalogue, Question};

const OWN: &str = r#"
[[encoder]]
name = "Own 1000"
lines = [1000, 1000]
max_line_khz = 100

[[machine]]
name = "Own mill"

[[machine.axis]]
name = "Y"
max_feed_mm_per_min = 12000
acceleration_m_s2 = 1
travel_mm = 5
encoder = "ERN 420"
lines = 5000

[[machine.spindle]]
name = "S"
max_rpm = 8000
encoder = "Own 1000"
"#;

#[test]
fn every_machine_of_the_built_in_one_has_figures() {
    let catalogue = Catalogue::built_in().unwrap();
    assert_eq!(catalogue.machines().len(), 7);
    assert_eq!(catalogue.encoders().len(), 4);
    for machine in catalogue.machines() {
        let plan = Question::default().machine(machine).unwrap();
        assert!(plan.cycle.frequency_hz > 50.0, "{plan:?}");
    }
    assert!(
        catalogue.machine("16k20f3 Retrofit").is_some(),
        "capitals do not count"
    );
    assert!(catalogue.encoder("ERN420").is_some(), "blanks do not count");
}

#[test]
fn users_add_theirs_and_may_have_encoders_that_are_there() {
    let mut catalogue = Catalogue::built_in().unwrap();
    catalogue.add(OWN).unwrap();
    let plan = Question::default()
        .machine(catalogue.machine("own mill").unwrap())
        .unwrap();
    let axis = &plan.axes[0];
    assert!((axis.kinematics.counts_per_mm() - 4000.0).abs() < 1e-9);
    // 2 400 rpm of 5 000 lines: 200 kHz of 300.
    assert!((axis.encoder.line_hz - 200e3).abs() < 1e-6 && axis.encoder.is_within);
    // 8 000 rpm of 1 000 lines: 133 kHz of 100.
    let spindle = &plan.spindles[0].encoder;
    assert!(!spindle.is_within && spindle.is_max_line_own);
    assert!((spindle.largest_lines.unwrap() - 750.0).abs() < 1e-9);
}

#[test]
fn another_encoder_may_be_tried() {
    let catalogue = Catalogue::built_in().unwrap();
    let lathe = catalogue.machine("16K20F3").unwrap();
    let finer = lathe
        .with_encoder(catalogue.encoder("A110-F").unwrap(), Some(180_000.0))
        .unwrap();
    let plan = Question::default().machine(&finer).unwrap();
    let z = &plan.axes[0];
    // 2.25 MHz of 125 kHz: P1's finding, a finer encoder cannot give the resolution that acceleration needs.
    assert!((z.encoder.line_hz - 2.25e6).abs() < 1e-3 && !z.encoder.is_within);
    assert!((z.encoder.largest_lines.unwrap() - 10_000.0).abs() < 1e-9);
    assert!(
        lathe
            .with_encoder(catalogue.encoder("A110-F").unwrap(), None)
            .is_err()
    );
    let mill = catalogue.machine("FP7M").unwrap();
    let message = mill
        .with_encoder(catalogue.encoder("BE178").unwrap(), None)
        .unwrap_err();
    assert!(
        message.starts_with("of axis all only the resolution is known"),
        "{message}"
    );
}

#[test]
fn an_encoder_past_its_highest_speed_is_told() {
    let mut catalogue = Catalogue::built_in().unwrap();
    let fast = OWN
        .replace("max_feed_mm_per_min = 12000", "max_feed_mm_per_min = 65000")
        .replace("= 5000\n", "= 1000\n");
    catalogue.add(&fast).unwrap();
    let plan = Question::default()
        .machine(catalogue.machine("Own mill").unwrap())
        .unwrap();
    let encoder = &plan.axes[0].encoder;
    assert!(
        encoder.line_hz < encoder.max_line_hz && !encoder.is_within,
        "13 000 of 12 000 rpm"
    );
}

/// What the catalogue says to `text`.
#[track_caller]
fn refused(text: &str) -> String {
    let mut catalogue = Catalogue::built_in().unwrap();
    let before = catalogue.clone();
    let error = catalogue.add(text).unwrap_err().to_string();
    assert_eq!(catalogue, before, "nothing is added");
    error
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let of = |from: &str, to: &str| {
        assert!(OWN.contains(from), "{from}");
        refused(&OWN.replacen(from, to, 1))
    };
    for (from, to, said) in [
        (
            "Own mill",
            "16k20 F3",
            "8:8: machine \"16k20 F3\": there is one of that name already (\"16K20F3\"): choose another name",
        ),
        (
            "Own 1000",
            "be178",
            "3:8: encoder \"be178\": there is one of that name already",
        ),
        ("Own mill", " ", "8:8: the machine has no name"),
        (
            "ERN 420",
            "ERN 421",
            "15:11: encoder \"ERN 421\" is in no catalogue; there are BE178, A110-F, ERN 420, ERN 460, Own 1000",
        ),
        (
            "lines = 5000",
            "lines = 6000",
            "16:9: ERN 420 with 6000 lines: it comes with 1000 to 5000",
        ),
        (
            "lines = 5000\n",
            "",
            "15:11: ERN 420 comes with 1000 to 5000 lines: say which by lines",
        ),
        (
            "= 12000",
            "= -1",
            "12:23: max_feed_mm_per_min = -1 is out of range: allowed 0.001 to 1000000",
        ),
        ("= 12000", "= \"fast\"", "12:23: invalid type"),
        (
            "acceleration_m_s2",
            "acceleration",
            "13:1: unknown field `acceleration`",
        ),
        (
            "acceleration_m_s2 = 1\n",
            "",
            "11:8: axis \"Y\": expected one of overload_g and acceleration_m_s2",
        ),
        (
            "travel_mm = 5",
            "counts_per_mm = 5",
            "15:11: an encoder without travel_mm",
        ),
        (
            "travel_mm = 5",
            "travel_mm = 5\ncounts_per_mm = 5",
            "11:8: axis \"Y\": expected either counts_per_mm, or encoder and travel_mm",
        ),
        (
            "encoder = \"ERN 420\"\n",
            "",
            "14:13: travel_mm without an encoder",
        ),
        (
            "[1000, 1000]",
            "[2000, 1000]",
            "4:9: lines = [2000, 1000]: expected fewest and most",
        ),
        (
            "max_rpm = 8000",
            "max_rpm = nan",
            "20:11: max_rpm = NaN is out of range",
        ),
    ] {
        let error = of(from, to);
        assert!(error.starts_with(said), "{from} → {to}: {error}");
    }
    let no_axis = refused("[[machine]]\nname = \"M\"\n");
    assert!(
        no_axis.starts_with("2:8: machine \"M\" has no axis"),
        "{no_axis}"
    );
    let twice = refused(&OWN.replace("[[machine.spindle]]", "[[machine.axis]]\nname = \"y\"\nmax_feed_mm_per_min = 1\noverload_g = 1\ncounts_per_mm = 1\n[[machine.spindle]]"));
    assert!(
        twice.contains("axis \"y\": there is one of that name already (\"Y\")"),
        "{twice}"
    );
}

#[test]
fn a_question_out_of_range_is_refused() {
    let catalogue = Catalogue::built_in().unwrap();
    let machine = &catalogue.machines()[0];
    for (question, name) in [
        (
            Question {
                tick_hz: 99.0,
                ..Question::default()
            },
            "tick_hz",
        ),
        (
            Question {
                radii_mm: vec![0.0],
                ..Question::default()
            },
            "radius_mm",
        ),
        (
            Question {
                allowed_d: f64::NAN,
                ..Question::default()
            },
            "allowed_chord_error_d",
        ),
        (
            Question {
                max_line_hz: 0.0,
                ..Question::default()
            },
            "line_hz",
        ),
    ] {
        assert_eq!(question.machine(machine).unwrap_err().name, name);
    }
}
