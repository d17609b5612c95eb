//! Lost motion: from which side an axis came is known behind every kind of movement.

use leadscrew_nc::coordinates::Axis::{self, X, Y, Z};
use leadscrew_nc::terms::Terms;
use leadscrew_nc::terms::screw::ScrewMap;

use super::correct;

/// Reached downward an axis stands 0.02 mm too high, upward where it should.
fn lost_motion(axis: Axis) -> Terms {
    lost(axis, 0.02)
}

fn lost(axis: Axis, by_mm: f64) -> Terms {
    let points = [(-500.0, 0.0, by_mm), (500.0, 0.0, by_mm)];
    Terms::none().with(ScrewMap::new("screw", axis, &points).unwrap())
}

#[test]
fn behind_positioning_and_lines() {
    let program = "G0 X10 Y0\nX5\nY1\nG1 X4 F9\nX2 Y2\nY3\nX3\n";
    let out = correct("linuxcnc-mill", lost_motion(X), program);
    assert_eq!(
        out,
        "G0 X10 Y0\nX4.98\nY1\nG1 X3.98 F9\nX1.98 Y2\nY3\nX2\nX3\n"
    );
}

#[test]
fn behind_machine_coordinates() {
    let out = correct("linuxcnc-mill", lost_motion(X), "G53 G0 X-10\nG0 Y1\n");
    assert_eq!(out, "G53 G0 X-10\nG0 X-10.02 Y1\n");
}

#[test]
fn the_bottom_of_a_hole_is_reached_from_above_and_left_upward() {
    let program = "G0 Z10\nX0 Y0\nG99 G81 X10 Z-5 R2 F50\nG80\nG0 X20\n";
    let out = correct("linuxcnc-mill", lost_motion(Z), program);
    assert_eq!(
        out,
        "G0 Z10\nX0 Y0\nG99 G81 X10 Z-5.02 R2 F50\nG80\nG0 X20\n"
    );
}

#[test]
fn a_box_comes_back_against_the_way_it_went() {
    let out = correct(
        "iso-lathe",
        // Less than the tolerance, for a box is led by its end alone.
        lost(Z, 0.0014),
        "G0X60.Z5.\nG90X45.Z-20.F.2\nG0X70.\n",
    );
    assert_eq!(out, "G0X60.Z5.\nG90X45.Z-20.001F.2\nG0X70.\n");
}

#[test]
fn an_arc_that_turns_round_first_takes_up_the_reversal_with_the_feed_it_brings() {
    let program = "G0 X-1 Y0\nX10 Y0\nG3 X0 Y10 I-10 J0 F50\nG1 Z1\n";
    let out = correct("linuxcnc-mill", lost_motion(X), program);
    let lines: Vec<_> = out.lines().collect();
    assert_eq!(lines[2], "G1 X9.98 F50", "{out}");
    assert!(lines[3].starts_with("G3 X-0.02 Y10 I-10 J0"), "{out}");
    assert_eq!(*lines.last().unwrap(), "G1 Z1", "X stays down: {out}");
    // The code in force from before is named again behind the line.
    let program = "G0 X-1 Y0\nX10 Y0\nG3 X20 Y0 I5 J0 F50\nX0 Y0 I-10 J0\nG1 Z1\n";
    let out = correct("linuxcnc-mill", lost_motion(X), program);
    let lines: Vec<_> = out.lines().collect();
    let line = lines.iter().position(|line| line.starts_with("G1 X19.98"));
    let line = line.unwrap_or_else(|| panic!("{out}"));
    assert!(lines[line + 1].starts_with("G3 X"), "{out}");
}

#[test]
fn the_block_that_ends_compensation_is_not_split_either() {
    let bend = super::known_terms::square(Y, X, 1e-5);
    let program = "G41.1 D0.01 G1 X1 F9\nG40 X100\n";
    let refusal = super::refused("linuxcnc-mill", bend, program);
    assert!(
        refusal.starts_with("2:5: the movement would have to be split"),
        "{refusal}"
    );
}
