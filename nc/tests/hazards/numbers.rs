//! Numbers keep their style; what does not fit is refused.

use leadscrew_nc::coordinates::Axis::{X, Y, Z};

use super::known_terms::{constant, slope};
use super::{correct, refused};

#[test]
fn numbers_keep_digits_sign_and_leading_zeros() {
    let terms = || constant(&[(X, 0.012)]);
    for (from, to) in [
        ("G0 X10.\n", "G0 X10.012\n"),
        ("G0 X+010.500\n", "G0 X+010.512\n"),
        ("G0X-.5\n", "G0X-.488\n"),
        ("G0 X -0.012 Y1\n", "G0 X 0.000 Y1\n"),
        ("g0 x 1 0 . 5 y1\n", "g0 x 10.512 y1\n"),
        ("G0 X5 (X6)\n", "G0 X5.012 (X6)\n"),
        ("G0\tX9.988000\r\n", "G0\tX10.000000\r\n"),
    ] {
        assert_eq!(correct("linuxcnc-mill", terms(), from), to);
    }
}

#[test]
fn a_word_that_says_it_to_half_a_step_stays_as_it_is() {
    assert_eq!(
        correct("iso-mill", constant(&[(X, 0.0004)]), "G0X10.Y5.\n"),
        "G0X10.Y5.\n"
    );
    assert_eq!(
        correct("iso-mill", constant(&[(X, 0.0006)]), "G0X10.Y5.\n"),
        "G0X10.001Y5.\n"
    );
    assert_eq!(
        correct("linuxcnc-mill", constant(&[(X, 0.0)]), "G0X10.123456789\n"),
        "G0X10.123456789\n"
    );
}

#[test]
fn integers_are_increments_where_the_dialect_says_so() {
    let terms = || constant(&[(X, 0.012), (Y, -0.012)]);
    assert_eq!(
        correct("iso-mill", terms(), "G0X1000Y2.\n"),
        "G0X1012Y1.988\n"
    );
    assert_eq!(
        correct("iso-mill", terms(), "G20G0X1000Y2.\n"),
        "G20G0X1005Y1.9995\n"
    );
    assert_eq!(
        correct("linuxcnc-mill", terms(), "G0X1000Y2.\n"),
        "G0X1000.012Y1.988\n"
    );
}

#[test]
fn inches() {
    let terms = constant(&[(X, 0.0254)]);
    assert_eq!(
        correct("linuxcnc-mill", terms, "G20\nG0 X1\nG21 X25.4\n"),
        "G20\nG0 X1.001\nG21 X25.4254\n"
    );
}

#[test]
fn fixed_width_overflows_are_refused() {
    let terms = || constant(&[(Y, 0.002)]);
    assert_eq!(
        correct("micrometre", terms(), "N001G60Y+065000\n"),
        "N001G60Y+065002\n"
    );
    assert_eq!(
        correct("micrometre", terms(), "N001G60Y-000001\n"),
        "N001G60Y+000001\n"
    );
    assert_eq!(
        refused("micrometre", terms(), "N001G60Y+999999\n"),
        "1:8: the corrected value of Y, 1000001, does not fit into 6 digits: move the work, or check the correction's size"
    );
}

#[test]
fn ways_carry_the_remainder_of_rounding() {
    // Each way asks for a third of a step more than it can say.
    let k1 = 0.001 / 3.0 / 1.0;
    let program = format!("G91 G1 F100\n{}", "X1.\n".repeat(9000));
    let out = correct("iso-mill", slope(X, X, k1), &program);
    let sum: f64 = out
        .lines()
        .filter_map(|line| line.strip_prefix('X'))
        .map(|x| x.parse::<f64>().unwrap())
        .sum();
    assert!((sum - 9000.0 * (1.0 + k1)).abs() <= 0.0005 + 1e-6, "{sum}");
    assert!(out.contains("X1.\n") && out.contains("X1.001\n"));
}

#[test]
fn a_number_that_stays_may_be_of_any_precision() {
    let out = correct(
        "linuxcnc-mill",
        constant(&[(Z, 1.0)]),
        "G0 X0.123456789 Z0.123456\n",
    );
    assert_eq!(out, "G0 X0.123456789 Z1.123500\n");
}
