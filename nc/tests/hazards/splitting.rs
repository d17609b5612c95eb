//! Lines are split only where K bends, and never where they must not be.

use leadscrew_nc::coordinates::Axis::{X, Y, Z};

use super::known_terms::{constant, slope, square};
use super::{control, correct, correct_by, refused};

#[test]
fn lines_stay_lines_where_k_is_affine() {
    let out = correct(
        "linuxcnc-mill",
        slope(Z, X, 0.001),
        "G0 X0 Y0 Z0\nG1 X1000 F100\n",
    );
    assert_eq!(out, "G0 X0 Y0 Z0\nG1 X1000 Z1 F100\n");
}

#[test]
fn a_line_is_split_where_k_bends() {
    let out = correct(
        "linuxcnc-mill",
        square(Y, X, 1e-5),
        "G0 X0 Y0\nN7 G1 X100 F100 M8 (cut)\nX0\n",
    );
    let lines: Vec<_> = out.lines().collect();
    // A chord over s lies 1e-5 s² / 4 off: 28 mm for 2 µm.
    assert!(lines.len() >= 6, "{out}");
    assert!(
        lines[1].starts_with("N7 G1 X") && lines[1].ends_with(" F100 M8 (cut)"),
        "{out}"
    );
    assert!(
        lines[2].starts_with('X') && lines[2].contains(" Y0."),
        "{out}"
    );
    assert!(lines.contains(&"X100 Y0.1"), "{out}");
    assert_eq!(*lines.last().unwrap(), "X0 Y0");
    // Positioning is not split.
    let out = correct("linuxcnc-mill", square(Y, X, 1e-5), "G0 X0 Y0\nX100\n");
    assert_eq!(out, "G0 X0 Y0\nX100 Y0.1\n");
}

#[test]
fn pieces_by_ways_add_up() {
    let program = "G0 X0 Y0 Z0\nG91 G1 X100 Z1 F100\n";
    let out = correct("linuxcnc-mill", square(Y, X, 1e-5), program);
    let mut sums = [0.0; 3];
    for line in out.lines().skip(1) {
        for word in line.split(' ') {
            if let Some(axis) = "XYZ".find(&word[..1]) {
                sums[axis] += word[1..].parse::<f64>().unwrap();
            }
        }
    }
    for (sum, expected) in sums.into_iter().zip([100.0, 0.1, 1.0]) {
        assert!((sum - expected).abs() < 0.5e-4 + 1e-9, "{sums:?}\n{out}");
    }
}

#[test]
fn what_stands_beside_a_line_stands_beside_its_pieces() {
    let out = correct(
        "linuxcnc-mill",
        square(Y, X, 1e-5),
        "G0 X0 Y0\r\ng53 g1 x100 f9\r\n",
    );
    for line in out.split("\r\n").skip(2).filter(|line| !line.is_empty()) {
        assert!(line.starts_with("g53 x"), "{line}");
    }
    let mut state = control();
    state.block_delete = Some(false);
    let out = correct_by("iso-mill", &state, square(Y, X, 1e-5), "G0X0Y0\n/G1X100.F9").unwrap();
    let pieces: Vec<_> = out.lines().skip(1).collect();
    assert!(
        pieces.len() > 3 && pieces.iter().all(|line| line.starts_with('/')),
        "{out}"
    );
    assert!(
        !out.ends_with('\n'),
        "a file without a last line end keeps none: {out:?}"
    );
}

#[test]
fn never_within_compensation_threads_inverse_time_or_a_profile() {
    let bend = || square(Y, X, 1e-5);
    for (program, reason) in [
        (
            "G41.1 D0.01 G1 X1 F9\nX100\n",
            "2:1: the movement would have to be split into",
        ),
        (
            "G1 F9 X0\nG93 X100 F1\n",
            "which must not be where F is an inverse time",
        ),
        ("G33 X100 K1\n", "which must not be in a thread"),
        (
            "G1 X100 F9 M5\n",
            "which must not be with words that act after the movement",
        ),
    ] {
        let refusal = refused("linuxcnc-mill", bend(), program);
        assert!(refusal.contains(reason), "{refusal}");
    }
    let profile = "G71P1Q2U1.W1.\nN1G1X100.F.1\nN2Z0.\n";
    let refusal = refused("iso-lathe", square(Z, X, 1e-4), profile);
    assert!(
        refusal.starts_with("2:5: the movement would have to be split"),
        "{refusal}"
    );
}

#[test]
fn within_compensation_ends_are_corrected() {
    let program = "G41.1 D1 G1 X1 F9\nX100\nG40 X0\n";
    assert_eq!(
        correct("linuxcnc-mill", constant(&[(X, 0.1)]), program),
        "G41.1 D1 G1 X1.1 F9\nX100.1\nG40 X0.1\n"
    );
}

#[test]
fn splines_move_as_a_whole_or_not_at_all() {
    let program = "G0 X0 Y0\nG5 I0 J3 P0 Q-3 X1 Y1 F9\n";
    assert_eq!(
        correct("linuxcnc-mill", constant(&[(X, 0.1)]), program),
        "G0 X0.1 Y0\nG5 I0 J3 P0 Q-3 X1.1 Y1 F9\n"
    );
    let refusal = refused("linuxcnc-mill", slope(X, Y, 0.01), program);
    assert!(
        refusal.contains("a spline under a correction that changes"),
        "{refusal}"
    );
}
