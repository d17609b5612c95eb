//! Arcs: centre from the corrected start, R form, full circles, the control's radius tolerance, splitting.

use leadscrew_nc::coordinates::Axis::{X, Y, Z};

use super::known_terms::{constant, slope, square};
use super::{correct, refused};

#[test]
fn with_one_k_everywhere_an_arc_is_moved() {
    let terms = || constant(&[(X, 0.01), (Y, -0.02), (Z, 0.5)]);
    let from =
        "G0 X10 Y0 Z0\nG2 X0 Y-10 I-10 J0 F50\nG3 X10 Y0 R10\nG2 I-5\nG90.1 G3 X0 Y10 Z4 I0 J0\n";
    let to = "G0 X10.01 Y-0.02 Z0.5\nG2 X0.01 Y-10.02 I-10 J0 F50\nG3 X10.01 Y-0.02 R10\nG2 I-5\nG90.1 G3 X0.01 Y9.98 Z4.5 \
              I0.01 J-0.02\n";
    assert_eq!(correct("linuxcnc-mill", terms(), from), to);
}

#[test]
fn the_centre_counts_from_where_the_control_really_stands() {
    // The start says 10.0005 for 10.00047: the remainder of rounding goes into I.
    let out = correct(
        "linuxcnc-mill",
        constant(&[(X, 0.00047)]),
        "G0 X10 Y0\nG2 X0 Y-10 I-10.00001 J0\n",
    );
    assert_eq!(out, "G0 X10.0005 Y0\nG2 X0.0005 Y-10 I-10.00001 J0\n");
}

#[test]
fn a_line_leads_to_an_arc_that_would_begin_beside_its_circle() {
    let terms = || constant(&[(X, 0.1)]);
    let out = correct("linuxcnc-mill", terms(), "G2 X0 Y-20 I0 J-10\n");
    assert_eq!(out, "G1 X0.1\nG2 X0.1 Y-20 I0 J-10\n");
    let within = refused("linuxcnc-mill", terms(), "G41.1 D1 G2 X0 Y-20 I0 J-10\n");
    assert!(
        within.starts_with("1:13: the movement would have to be split into 2, which must not be between G41 or G42 and G40"),
        "{within}"
    );
}

#[test]
fn an_affine_k_makes_arcs_of_other_centres() {
    // X is stretched by a thousandth: a quarter of radius 1 stays within 2 µm as one arc, of another centre.
    let out = correct(
        "linuxcnc-mill",
        slope(X, X, 0.001),
        "G0 X1 Y0\nG3 X0 Y1 I-1 J0 F50\n",
    );
    let second = out.lines().nth(1).unwrap();
    assert!(out.starts_with("G0 X1.001 Y0\nG3 X0 Y1 I-"), "{out}");
    assert_eq!(out.lines().count(), 2, "{out}");
    assert!(!second.contains("I-1 "), "{out}");
    // Of radius 100 it does not: it is split, each part an arc with its own centre.
    let out = correct(
        "linuxcnc-mill",
        slope(X, X, 0.001),
        "G0 X100 Y0\nG3 X0 Y100 I-100 J0 F50\nG1 X0\n",
    );
    assert!(out.lines().count() > 3, "{out}");
    for line in out.lines().skip(2).take(out.lines().count() - 4) {
        assert!(
            line.starts_with('X') && line.contains(" I-") && line.contains(" J-"),
            "{line}"
        );
    }
    assert!(out.ends_with("G1 X0\n"), "{out}");
}

#[test]
fn a_full_circle_without_ends_gets_them_where_it_is_split() {
    let out = correct(
        "linuxcnc-mill",
        slope(X, X, 0.001),
        "G0 X50 Y0\nG3 I-50 J0 F50\n",
    );
    let lines: Vec<_> = out.lines().collect();
    assert!(lines.len() > 3, "{out}");
    assert!(
        lines[1].starts_with("G3 X") && lines[1].contains(" Y") && lines[1].ends_with(" F50"),
        "{out}"
    );
    assert!(lines.last().unwrap().contains("X50.05 Y0"), "{out}");
}

#[test]
fn the_r_form_keeps_its_form() {
    let out = correct(
        "iso-mill",
        slope(X, X, 0.001),
        "G0X100.Y0.\nG3X0.Y100.R100.F50\n",
    );
    assert!(
        out.lines()
            .skip(1)
            .all(|line| line.contains('R') && !line.contains('I')),
        "{out}"
    );
    // More than half of a circle.
    let out = correct(
        "iso-mill",
        constant(&[(X, 0.5)]),
        "G0X10.Y0.\nG3X0.Y-10.R-10.F50\n",
    );
    assert_eq!(out, "G0X10.5Y0.\nG3X0.5Y-10.R-10.F50\n");
}

#[test]
fn a_helix_is_corrected_across_its_plane() {
    let out = correct(
        "linuxcnc-mill",
        slope(Z, Z, 0.001),
        "G0 X10 Y0 Z0\nG2 X0 Y-10 Z-10 I-10 J0 F50\n",
    );
    assert_eq!(out, "G0 X10 Y0 Z0\nG2 X0 Y-10 Z-10.01 I-10 J0 F50\n");
}

#[test]
fn arcs_that_are_none_are_refused() {
    for (program, reason) in [
        (
            "G2 X5 Y5 I9 J0\n",
            "1:4: the arc has radius 9.00000 mm at its start",
        ),
        (
            "G2 X10 Y0 R2\n",
            "1:4: the arc's radius of 2.00000 mm is smaller than half",
        ),
        (
            "G2 X0 Y0 R2\n",
            "1:4: an arc in R form ends where it starts",
        ),
        ("G2 X5 Y5\n", "1:4: an arc without I, J, K needs R"),
        ("G2 X5 Y5 I1 R2\n", "1:13: R has no meaning with I, J and K"),
        (
            "G2 X5 Y5 I#1 J0\n",
            "1:10: the value of I is only known to the control",
        ),
    ] {
        let refusal = refused("linuxcnc-mill", slope(X, X, 0.001), program);
        assert!(refusal.starts_with(reason), "{program}{refusal}");
    }
}

#[test]
fn an_arc_under_compensation_is_not_split() {
    let program = "G0 X100 Y0\nG41.1 D0.01 G1 X100\nG3 X0 Y100 I-100 J0 F50\nG40 G1 X0\n";
    let refusal = refused("linuxcnc-mill", square(X, Y, 0.0001), program);
    assert!(
        refusal.contains("which must not be between G41 or G42 and G40"),
        "{refusal}"
    );
}

#[test]
fn turns_are_not_gone_again_by_the_first_piece() {
    let program = "G0 X10 Y0 Z0\nG3 X10 Y0 Z-8 I-10 J0 P2 F50\n";
    let out = correct("linuxcnc-mill", slope(X, X, 0.001), program);
    let lines: Vec<_> = out.lines().skip(1).collect();
    assert!(lines[0].ends_with(" P1 F50"), "{out}");
    assert!(
        lines.len() > 3 && lines[1..].iter().all(|line| !line.contains('P')),
        "{out}"
    );
    // Twice round, each piece climbs by its share: half of the height once round.
    let once = lines
        .iter()
        .position(|line| line.contains("X10.01 Y0 Z-4 "));
    assert!(once.is_some_and(|once| once < lines.len() - 1), "{out}");
    // Moved as a whole it keeps them.
    let out = correct("linuxcnc-mill", constant(&[(Y, 0.0)]), program);
    assert_eq!(out, program);
}
