//! Words that a block needs and has not; words that are no places; mixed modes.

use leadscrew_nc::coordinates::Axis::{X, Y, Z};

use super::known_terms::{constant, slope};
use super::{control, correct, correct_by, refused};

#[test]
fn a_word_is_added_where_the_correction_needs_one() {
    let terms = || slope(Y, X, 0.001);
    for (from, to) in [
        ("G0 X100. Z5.\n", "G0 X100. Y0.1 Z5.\n"),
        ("G0X100.Z5.\n", "G0X100.Y0.1Z5.\n"),
        ("g0 x100 z5 (Y)\n", "g0 x100 y0.1 z5 (Y)\n"),
        ("N5 G1 X100 F200 M8\n", "N5 G1 X100 Y0.1 F200 M8\n"),
        ("G91\nX1 G0\nX-1\n", "G91\nX1 Y0.001 G0\nX-1 Y-0.001\n"),
        ("G0 X0.01\n", "G0 X0.01\n"),
    ] {
        assert_eq!(correct("linuxcnc-mill", terms(), from), to);
    }
    let out = correct("iso-mill", slope(X, Y, 0.001), "G0Y100.\nY0\n");
    assert_eq!(out, "G0X0.1Y100.\nX0Y0\n");
}

#[test]
fn an_axis_the_program_has_not_placed_is_left_alone() {
    let mut state = control();
    state.start.clear();
    let out = correct_by(
        "linuxcnc-mill",
        &state,
        constant(&[(Z, 0.1)]),
        "G0 X1\nZ5\nX2\n",
    );
    assert_eq!(out.unwrap(), "G0 X1\nZ5.1\nX2\n");
}

#[test]
fn words_that_are_no_places_stay() {
    let terms = || constant(&[(X, 0.5), (Y, 0.5), (Z, 0.5)]);
    for program in [
        "G4 P1.5\n",
        "G10 L2 P1 X0 Y0 Z0\n",
        "G64 P0.01 Q0.02\n",
        "S1000 M3\nF200\nT3 M6\n",
        "M66 P0 L3 Q5\n",
        "(X1) ; Y2\n",
        "G92 X1 Y2\n",
        "G52 X10\n",
    ] {
        assert_eq!(correct("linuxcnc-mill", terms(), program), program);
    }
    for program in [
        "G4X1.5\n",
        "G04U2.\n",
        "G50X100.Z50.\n",
        "G50S2500\n",
        "G28U0W0\n",
        "G10L2P1X0Z0\n",
    ] {
        assert_eq!(
            correct("iso-lathe", constant(&[(X, 0.5), (Z, 0.5)]), program),
            program
        );
    }
}

#[test]
fn absolute_ways_and_both_mixed() {
    let terms = || slope(X, X, 0.01);
    let out = correct(
        "linuxcnc-mill",
        terms(),
        "G90 G0 X100\nG91 X100\nG90 X300\nG91 X-300\n",
    );
    assert_eq!(out, "G90 G0 X101\nG91 X101\nG90 X303\nG91 X-303\n");
    // Half an increment and half a place in one block.
    let out = correct(
        "iso-lathe",
        slope(Z, Z, 0.01),
        "G0X50.Z100.\nX40.W-50.\nU2.Z0\n",
    );
    assert_eq!(out, "G0X50.Z101.\nX40.W-50.5\nU2.Z0\n");
}

#[test]
fn a_shift_set_where_the_tool_stands_corrected_does_not_count_twice() {
    // X stands at 10.1 in truth when it is called 0.
    let out = correct(
        "linuxcnc-mill",
        constant(&[(X, 0.1)]),
        "G0 X10\nG92 X0\nX5\nG92.1\nX5\n",
    );
    assert_eq!(out, "G0 X10.1\nG92 X0\nX5\nG92.1\nX5.1\n");
    let out = correct(
        "linuxcnc-mill",
        constant(&[(X, 0.1)]),
        "G0 X10\nG10 L20 P2 X0\nX1\nG55 X1\nG54 X1\n",
    );
    assert_eq!(out, "G0 X10.1\nG10 L20 P2 X0\nX1.1\nG55 X1\nG54 X1.1\n");
}

#[test]
fn what_only_the_control_can_work_out_is_refused_on_an_axis_of_the_correction() {
    let out = correct(
        "linuxcnc-mill",
        constant(&[(X, 0.1)]),
        "#1 = 5\nG0 X1 Y#1 F[#1*2]\n",
    );
    assert_eq!(out, "#1 = 5\nG0 X1.1 Y#1 F[#1*2]\n");
    assert_eq!(
        refused(
            "linuxcnc-mill",
            constant(&[(Y, 0.1)]),
            "#1 = 5\nG0 X1 Y#1\n"
        ),
        "2:7: the value of Y is only known to the control, and the correction needs it: write the number, or leave the axis \
         out of the correction"
    );
    let refusal = refused("linuxcnc-mill", slope(Y, X, 0.1), "G0 X[1+1]\n");
    assert!(refusal.starts_with("1:4: the value of X"), "{refusal}");
}
