//! What is not known is refused, with block, column, reason and advice; without a correction nothing is.

use leadscrew_nc::coordinates::Axis::{X, Y};
use leadscrew_nc::corrector::{CorrectError, Corrector, Reason, correct as stream};
use leadscrew_nc::dialect::Dialect;
use leadscrew_nc::machine_state::MachineState;
use leadscrew_nc::terms::Terms;

use super::known_terms::constant;
use super::{TOLERANCE, control, correct, correct_by, refused};

#[test]
fn what_is_unknown_is_refused_at_its_column() {
    for (dialect, program, refusal) in [
        (
            "linuxcnc-mill",
            "G0 X1\nG123 X2\n",
            "2:1: G123 has no meaning in this dialect: check it, or state its meaning in a dialect file of your own",
        ),
        (
            "linuxcnc-mill",
            "M150\n",
            "1:1: M150 has no meaning in this dialect",
        ),
        (
            "linuxcnc-mill",
            "X1\n",
            "1:1: there are words of axes and no code says how they move: put G0, G1",
        ),
        (
            "linuxcnc-mill",
            "G0 X1 G1\n",
            "1:7: G0 and G1 cannot stand in one block",
        ),
        ("linuxcnc-mill", "G0 X1 X2\n", "1:7: X is there twice"),
        ("linuxcnc-mill", "G0 X\n", "1:4: X has no value"),
        (
            "linuxcnc-mill",
            "G0 X1 I5\n",
            "1:7: I has no meaning with positioning",
        ),
        (
            "linuxcnc-mill",
            "G[1] X1\n",
            "1:1: the value of G is only known to the control",
        ),
        (
            "linuxcnc-mill",
            "o100 sub\n",
            "1:1: an O word steers the program",
        ),
        (
            "linuxcnc-mill",
            "#5221 = 3\n",
            "1:1: `#5221 = 3` may set an offset of the control: set offsets by G10",
        ),
        (
            "linuxcnc-mill",
            "##1 = 3\n",
            "1:1: `##1 = 3` may set an offset",
        ),
        (
            "linuxcnc-mill",
            "G5.2 X1 Y1\n",
            "1:1: G5.2 is refused: its control points are places of their own: write out",
        ),
        (
            "linuxcnc-mill",
            "G0 @5 ^10\n",
            "1:4: the letter @ has no meaning",
        ),
        (
            "linuxcnc-mill",
            "/G0 X1\n",
            "1:1: the block is left out or not as a switch of the control stands: give control.block_delete",
        ),
        (
            "linuxcnc-mill",
            "G10 L2 P1 R45\n",
            "1:1: G10 L2 R turns the coordinates",
        ),
        (
            "linuxcnc-mill",
            "G10 L10 P1 X1\n",
            "1:1: L is not one that is known for G10",
        ),
        (
            "iso-mill",
            "G68X0Y0R30.\n",
            "1:1: G68 is refused: scaled, mirrored or turned coordinates are not followed",
        ),
        (
            "iso-mill",
            "M98P1000\n",
            "1:1: M98 is refused: macros and subprograms are not followed",
        ),
        ("iso-mill", "G0X1.U2.\n", "1:6: the letter U has no meaning"),
        (
            "iso-mill",
            "G1X1.,R2.\n",
            "1:6: the character `,` begins no word",
        ),
        (
            "iso-mill",
            "G1X1.R2.\n",
            "1:6: R has no meaning with a line",
        ),
        ("iso-lathe", "G0X1.U2.\n", "1:6: X is there twice"),
        (
            "micrometre",
            "N01G60X+000001\n",
            "1:1: N has 2 digits, 3 are expected",
        ),
        (
            "micrometre",
            "N001G60X+00001\n",
            "1:8: X has 5 digits, a sign and 6 are expected",
        ),
        (
            "micrometre",
            "N001G60X000001\n",
            "1:8: X has 6 digits, a sign and 6 are expected",
        ),
    ] {
        let found = refused(dialect, constant(&[(X, 0.1), (Y, 0.1)]), program);
        assert!(
            found.starts_with(refusal),
            "{program}{found}\nexpected {refusal}"
        );
    }
}

#[test]
fn without_a_correction_everything_passes() {
    let text = "o100 sub\nG123 X[1] \u{7}\n(open\n/#5221=1";
    assert_eq!(correct("linuxcnc-mill", Terms::none(), text), text);
}

#[test]
fn block_delete_as_the_switch_stands() {
    let program = "G0 X1\n/X2\nG91 X1\n";
    for (switch, expected) in [
        (true, "G0 X1.1\n/X2\nG91 X1\n"),
        (false, "G0 X1.1\n/X2.1\nG91 X1\n"),
    ] {
        let state = MachineState {
            block_delete: Some(switch),
            ..control()
        };
        assert_eq!(
            correct_by("linuxcnc-mill", &state, constant(&[(X, 0.1)]), program).unwrap(),
            expected
        );
    }
}

#[test]
fn behind_the_end_nothing_is_read() {
    let program = "%\nG0 X1\nM2\nG123\n";
    assert_eq!(
        correct("linuxcnc-mill", constant(&[(X, 0.1)]), program),
        "%\nG0 X1.1\nM2\nG123\n"
    );
    let program = "%\nG0 X1\n%\nG123\n";
    assert_eq!(
        correct("linuxcnc-mill", constant(&[(X, 0.1)]), program),
        "%\nG0 X1.1\n%\nG123\n"
    );
}

#[test]
fn a_stream_is_written_up_to_the_refused_block() {
    let dialect = Dialect::named("linuxcnc-mill").unwrap();
    let mut corrector =
        Corrector::new(dialect, &control(), constant(&[(X, 0.1)]), TOLERANCE).unwrap();
    let mut out = Vec::new();
    let error = stream(&b"G0 X1\nX2\nX2\nX2 X2\nX5\n"[..], &mut out, &mut corrector).unwrap_err();
    assert_eq!(out, b"G0 X1.1\nX2.1\nX2.1\n");
    let CorrectError::Refused(refusal) = error else {
        panic!("{error}")
    };
    assert_eq!(
        (refusal.block, refusal.column, refusal.reason),
        (4, 4, Reason::Twice('X'))
    );
}

#[test]
fn a_state_the_dialect_does_not_know_is_refused() {
    let mut state = control();
    state.work_offsets.active = Some("G7".into());
    let dialect = || Dialect::named("linuxcnc-mill").unwrap();
    let error = Corrector::new(dialect(), &state, Terms::none(), TOLERANCE).unwrap_err();
    assert_eq!(
        error.to_string(),
        "work_offsets.active: G7 is no work offset of dialect linuxcnc-mill"
    );
    let mut state = control();
    state.references.insert("G54".into(), state.start.clone());
    let error = Corrector::new(dialect(), &state, Terms::none(), TOLERANCE).unwrap_err();
    assert_eq!(
        error.to_string(),
        "references.G54: G54 goes to no reference in dialect linuxcnc-mill"
    );
}
