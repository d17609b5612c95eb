//! Machine files: what they give, and what is refused where.

use leadscrew_nc::coordinates::Axis;
use leadscrew_process::deviations::{Component, DriveErrors, built_in, read};

use crate::machines::machine;

fn complaint(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "no {from} in the file");
    read(&text.replacen(from, to, 1)).unwrap_err().to_string()
}

#[test]
fn the_machining_centre_is_what_its_file_says() {
    let loaded = read(built_in("6904MF2").unwrap()).unwrap();
    let machine = &loaded.machine;
    assert_eq!(machine.drive_errors, DriveErrors::Included);
    let axes: Vec<_> = machine.axes().into_iter().map(|(axis, _)| axis).collect();
    assert_eq!(axes, [Axis::X, Axis::Y, Axis::Z, Axis::B]);
    assert_eq!(machine.corrected(), axes);
    // The indicators' readings were rounded to 0.1 µm from b 2.6 µm, λ 9 µrad, γ −5 µrad, a 3 µm, β 7 µrad at Z 0.
    let (unit, measured) = &loaded.measured[0];
    assert_eq!(unit, "longitudinal table");
    let found = measured.table.values()[2];
    for (component, truth, within) in [
        (Component::A, 3.0e-3, 2e-4),
        (Component::B, 2.6e-3, 1e-4),
        (Component::Lambda, 9e-6, 5e-7),
        (Component::Beta, 7e-6, 5e-7),
        (Component::Gamma, -5e-6, 5e-7),
    ] {
        let value = found.get(component);
        assert!(
            (value - truth).abs() < within,
            "{component}: {value}, not {truth}"
        );
    }
    assert_eq!(measured.sigma.as_ref().unwrap().len(), 5);
}

#[test]
fn the_lathe_corrects_two_axes_and_leaves_what_it_does_not_feel() {
    let lathe = machine("lathe");
    assert_eq!(lathe.corrected(), [Axis::X, Axis::Z]);
    let at = leadscrew_nc::coordinates::Coordinates::xyz(50.0, 0.0, 400.0);
    let delta = lathe.deviation(&at).unwrap();
    let found = lathe.correction(&at).unwrap();
    assert!((found.k[Axis::X] + delta.shift.x).abs() < 1e-12);
    assert!((found.k[Axis::Z] + delta.shift.z).abs() < 1e-12);
    assert_eq!(found.left.shift.y, delta.shift.y);
}

#[test]
fn a_drive_error_that_is_corrected_elsewhere_is_refused() {
    let text = built_in("6904MF2").unwrap();
    let error = complaint(
        text,
        "drive_errors = \"included\"",
        "drive_errors = \"elsewhere\"",
    );
    assert!(
        error.starts_with("13:1: unit \"longitudinal table\""),
        "{error}"
    );
    assert!(
        error.contains("positioning error c of its own drive"),
        "{error}"
    );
    let without = machine("6904MF2").without_drive_errors();
    assert_eq!(without.drive_errors, DriveErrors::Elsewhere);
    for (_, unit) in without.units().filter(|(_, unit)| unit.axis().is_some()) {
        assert!(
            !unit.law.has(unit.motion.drive_component()),
            "{}",
            unit.name
        );
    }
}

#[test]
fn what_is_wrong_in_a_file_is_said_where() {
    let text = built_in("6904MF2").unwrap();
    for (from, to, said) in [
        (
            "linear = \"-z\"",
            "linear = \"+z\"",
            "needs `linear = \"-z\"`",
        ),
        (
            "linear = \"-z\"",
            "linear = \"along\"",
            "\"along\" is no direction",
        ),
        (
            "linear = \"-z\"",
            "lineal = \"-z\"",
            "unknown field `lineal`",
        ),
        (
            "axis = \"Z\"",
            "axis = \"B\"",
            "X, Y, Z, U, V or W is expected",
        ),
        ("axis = \"Z\"", "axis = \"X\"", "needs `linear = \"-x\"`"),
        (
            "range_mm = [-200.0, 300.0]",
            "range_mm = [-200.0, 301.0]",
            "are known from -200 to 300 mm",
        ),
        (
            "range_mm = [-200.0, 300.0]",
            "range_mm = [300.0, -200.0]",
            "it must rise",
        ),
        (
            "range_mm = [-200.0, 300.0]",
            "",
            "needs `axis` and `range_mm`",
        ),
        (
            "name = \"cross table\"",
            "name = \"longitudinal table\"",
            "two units are called",
        ),
        (
            "a_um = [-4.8, ",
            "a_um = [",
            "a_um has 4 values for 5 places",
        ),
        (
            "a_um = [-4.8,",
            "a_um = [-20000.0,",
            "-10000 to 10000 is allowed",
        ),
        (
            "of = \"c\"\nslope_um_per_m",
            "of = \"c\"\nslope_urad_per_m",
            "um is expected",
        ),
        (
            "of = \"c\"",
            "of = \"k\"",
            "one of a, b, c, lambda, beta, gamma",
        ),
        ("period_mm = 500.0", "period_mm = 0.0", "needs `period_mm`"),
        ("periods_a_turn = 1", "periods_a_turn = 0", "1 to 100000"),
        (
            "direction = \"+x\"",
            "direction = \"-c\"",
            "of indicator \"I4\"",
        ),
        ("sigma_um = 0.2", "sigma_um = -1.0", "0.001 to 1000 um"),
        (
            "315.0, 360.0]",
            "315.0, 359.0]",
            "are known from 0 to 359 deg",
        ),
        (
            "[[tool.function]]\nof = \"lambda\"\nconstant_arcsec = 1.2",
            "[[tool.table]]\nat_deg = [0.0, 90.0]\nlambda_urad = [0.0, 3.0]",
            "known from 0 to 90 °, and it turns freely",
        ),
        (
            "tool_mm = [0.0, 0.0, -150.0]",
            "tool_mm = [0.0, 0.0, nan]",
            "must be from",
        ),
        ("at_deg = [0.0, 45.0", "at_deg = [0.0, -45.0", "must rise"),
        ("at_deg", "at_mm", "places as `at_deg`"),
    ] {
        let error = complaint(text, from, to);
        assert!(error.contains(said), "{from} → {to}: {error}");
        let line: usize = error.split(':').next().unwrap().parse().unwrap();
        assert!(line > 1, "{error}");
    }
    let error =
        read("name = \"x\"\norigin = \"\"\ndrive_errors = \"included\"\ntool_mm = [0, 0, 0]");
    assert!(error.unwrap_err().to_string().contains("has no unit"));
}
