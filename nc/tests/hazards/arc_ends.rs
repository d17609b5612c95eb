//! What a control makes of the arcs that are written: from the ends in whole steps it must find the angle that is meant, never a
//! full circle for a short arc, nor nothing for a full circle.

use std::f64::consts::{PI, TAU};

use leadscrew_nc::coordinates::Axis::{self, X, Y, Z};
use leadscrew_nc::terms::Terms;
use leadscrew_nc::terms::screw::ScrewMap;

use super::known_terms::{constant, slope, square};
use super::{control, correct_by};

fn correct(dialect: &str, terms: Terms, program: &str) -> Result<String, String> {
    correct_by(dialect, &control(), terms, program)
}

/// Angles that a control turns through: one for each arc in X and Y, in centre form, millimetres or inches.
fn turned(program: &str) -> Vec<f64> {
    let (mut at, mut motion, mut incremental, mut unit) = ([0.0; 2], 0, false, 1.0);
    let mut all = Vec::new();
    for block in program.lines() {
        let mut said = [None; 2];
        let mut centre = [None; 2];
        let mut turns = 1.0;
        for (letter, value) in words(block) {
            match letter {
                'G' if value <= 3.0 => motion = value as u32,
                'G' if value == 90.0 => incremental = false,
                'G' if value == 91.0 => incremental = true,
                'G' if value == 20.0 => unit = 25.4,
                'G' if value == 21.0 => unit = 1.0,
                'X' => said[0] = Some(value * unit),
                'Y' => said[1] = Some(value * unit),
                'I' => centre[0] = Some(value * unit),
                'J' => centre[1] = Some(value * unit),
                'P' => turns = value,
                _ => {}
            }
        }
        let from = at;
        for axis in 0..2 {
            at[axis] = match said[axis] {
                Some(way) if incremental => from[axis] + way,
                Some(place) => place,
                None => from[axis],
            };
        }
        if motion >= 2 && centre.iter().any(Option::is_some) {
            let centre = [0, 1].map(|axis: usize| from[axis] + centre[axis].unwrap_or(0.0));
            let angle = |place: [f64; 2]| (place[1] - centre[1]).atan2(place[0] - centre[0]);
            let sign = if motion == 2 { -1.0 } else { 1.0 };
            let way = (sign * (angle(at) - angle(from))).rem_euclid(TAU);
            let same = (at[0] - from[0]).hypot(at[1] - from[1]) < 1e-9;
            all.push(sign * (if same { TAU } else { way } + (turns - 1.0) * TAU));
        }
    }
    all
}

fn words(block: &str) -> Vec<(char, f64)> {
    let starts: Vec<usize> = block
        .char_indices()
        .filter(|(_, c)| c.is_ascii_alphabetic())
        .map(|(at, _)| at)
        .chain([block.len()])
        .collect();
    let word = |pair: &[usize]| {
        let text = block[pair[0]..pair[1]].trim();
        (text.as_bytes()[0].into(), text[1..].parse().unwrap())
    };
    starts.windows(2).map(word).collect()
}

/// The corrected program turns through what the program does.
fn turns_through(dialect: &str, terms: Terms, program: &str, angle: f64) {
    let out =
        correct(dialect, terms, program).unwrap_or_else(|refusal| panic!("{program}{refusal}"));
    let pieces = turned(&out);
    let sum: f64 = pieces.iter().sum();
    assert!((sum - angle).abs() < 0.01, "{pieces:?}\n{out}");
}

const SHORT: &str = "turns through 360 degrees for the control";

fn is_refused(dialect: &str, terms: Terms, program: &str) {
    match correct(dialect, terms, program) {
        Err(refusal) => assert!(
            refusal.contains("2:") && refusal.contains(SHORT),
            "{refusal}"
        ),
        Ok(out) => panic!("not refused: {:?}\n{out}", turned(&out)),
    }
}

#[test]
fn a_short_arc_whose_ends_become_one_place_is_refused() {
    // K takes nine tenths of X: what was three steps long is a third of one.
    let narrow = || slope(X, X, -0.9);
    is_refused(
        "linuxcnc-mill",
        narrow(),
        "G0 X10 Y0\nG2 X10.0003 Y0 I0.00015 J-1\n",
    );
    is_refused(
        "linuxcnc-mill",
        narrow(),
        "G0 X10 Y0 \nG91 G2 X0.0003 Y0 I0.00015 J-1\n",
    );
    is_refused("iso-mill", narrow(), "G0X10.Y0.\nG3X10.003Y0.I.0015J1.\n");
    is_refused("iso-mill", narrow(), "G0X10.Y0.\nG91G3X.003I.0015J1.\n");
}

#[test]
fn an_arc_that_was_shorter_than_a_step_already_is_refused() {
    let shift = || constant(&[(X, 0.0105)]);
    is_refused("iso-mill", shift(), "G0X10.Y0.\nG3X10.0003Y.0003I0.J10.\n");
    is_refused("iso-mill", shift(), "G0X10.Y0.\nG91G3X.0003I.00015J10.\n");
    let turn = || slope(Z, X, 0.001);
    is_refused(
        "iso-mill",
        turn(),
        "G0X10.Y0.Z0.\nG3X10.0003Y.0003I0.J10.\n",
    );
}

#[test]
fn the_r_form_of_such_an_arc_is_refused_too() {
    let refusal = correct(
        "linuxcnc-mill",
        slope(X, X, -0.9),
        "G0 X10 Y0\nG2 X10.0003 Y0 R1\n",
    );
    assert!(
        refusal
            .as_ref()
            .is_err_and(|refusal| refusal.starts_with("2:")),
        "{refusal:?}"
    );
    // Nearly a whole turn in R form: with its ends in one place the control does not move at all.
    let out = correct(
        "iso-mill",
        constant(&[(X, 0.0105)]),
        "G0X10.Y0.\nG3X10.0003Y0.R-10.\n",
    );
    assert!(out.is_err(), "{out:?}");
}

#[test]
fn ends_that_change_places_are_refused() {
    // K turns the way round: a short arc would become nearly a full one.
    let out = correct(
        "linuxcnc-mill",
        slope(X, X, -1.5),
        "G0 X10 Y0\nG3 X10.0003 Y0 I0.00015 J1\n",
    );
    assert!(out.is_err(), "{out:?}");
}

#[test]
fn a_full_circle_stays_one() {
    for program in [
        "G0 X10 Y0\nG3 X10 Y0 I-10 J0\n",
        "G0 X10 Y0\nG3 I-10 J0\n",
        "G91\nG0 X3.3333\nX3.3333\nX3.3334\nG3 X0 Y0 I-10 J0\nG90 G3 X10 Y0 I-10 J0\nG91 G3 I-10\n",
        "G20\nG0 X0.39370 Y0\nG21\nG3 X9.99998 Y0 I-9.99998 J0\n",
        "G20\nG0 X0.39370 Y0\nG21\nG3 I-9.99998 J0\n",
    ] {
        let circles = program.matches("G3").count() as f64;
        for k in [0.00003_f64, 0.00005, 0.00007, -0.00007, 0.01234] {
            turns_through(
                "linuxcnc-mill",
                constant(&[(X, k), (Y, -k)]),
                program,
                circles * TAU,
            );
            let affine = slope(X, Y, k / 100.0);
            turns_through("linuxcnc-mill", affine, program, circles * TAU);
        }
    }
}

#[test]
fn a_full_circle_after_another_k_begins_with_a_line() {
    // The offset of tool 2 is not the one that the control stands with.
    let wear = |tool| {
        [(1, 0.0), (2, 0.004)]
            .into_iter()
            .filter(move |(t, _)| *t == tool)
    };
    let terms = leadscrew_nc::terms::wear::Wear::new(
        "wear",
        [1, 2]
            .into_iter()
            .flat_map(wear)
            .map(|(tool, y)| {
                (
                    tool,
                    leadscrew_nc::coordinates::Coordinates::xyz(0.0, y, 0.0),
                )
            })
            .collect(),
    );
    let program = "T1 M6\nG0 X10 Y0\nT2 M6\nG3 I-10 J0 F100\n";
    turns_through("linuxcnc-mill", Terms::none().with(terms), program, TAU);
}

/// 10 µm of lost motion in one axis.
fn lost_motion(axis: Axis) -> Terms {
    let points = [(-100.0, 0.0, 0.01), (100.0, 0.0, 0.01)];
    Terms::none().with(ScrewMap::new("screw", axis, &points).unwrap())
}

#[test]
fn an_arc_that_ends_just_behind_a_turning_point_has_no_piece_without_length() {
    // The centre is 0.3 µm beside the end: Y turns round, on paper, by less than the width of an atom.
    let program = "G0X5.Y-5.\nG1X10.0003Y0.F100\nG3X0.Y10.I-10.J0.\n";
    turns_through("iso-mill", lost_motion(Y), program, PI / 2.0);
    let program = "G0X5.Y15.\nG1X0.Y10.F100\nG3X-10.Y0.I.0003J-10.\nG3X0.Y-10.I10.0003\n";
    for axis in [X, Y] {
        turns_through("iso-mill", lost_motion(axis), program, PI);
    }
}

#[test]
fn turns_beyond_the_first_are_not_run_again_by_a_piece() {
    let program = "G0 X50 Y0 Z0\nG3 X50 Y0 Z-3 I-50 J0 P3 F50\n";
    turns_through("linuxcnc-mill", slope(X, X, 0.001), program, 3.0 * TAU);
    turns_through("linuxcnc-mill", square(X, Y, 1e-5), program, 3.0 * TAU);
    turns_through("linuxcnc-mill", constant(&[(X, 0.1)]), program, 3.0 * TAU);
}

#[test]
fn a_line_before_a_block_knows_nothing_of_the_blocks_own_modes() {
    // X turns round where the arc begins: a line takes that up, and G91 is not in force for it yet.
    let program = "G0 X-1 Y0\nG1 X10 F100\nG91 G3 X-10 Y10 I-10 J0\n";
    let refusal = correct("linuxcnc-mill", lost_motion(X), program).unwrap_err();
    assert!(refusal.starts_with("3:8: "), "{refusal}");
    assert!(refusal.contains("a block of their own"), "{refusal}");
    let apart = program.replace("G91 ", "G91\n");
    let out = correct("linuxcnc-mill", lost_motion(X), &apart).unwrap();
    assert!(out.contains("G91\nG1 X-0.01"), "{out}");
    // What is in force already changes nothing.
    let same = program
        .replace("G91 ", "G90 G17 G21 ")
        .replace("X-10 Y10", "X0 Y10");
    assert!(correct("linuxcnc-mill", lost_motion(X), &same).is_ok());
}

#[test]
fn rounding_of_sums_turns_no_axis_round() {
    // 0.1 + 0.2 is not 0.3, and X does not move.
    let program = "G0 X-1\nX0\nG91\nG1 X0.1 F100\nX0.2\nG90\nX0.3 Y5\n";
    let out = correct("linuxcnc-mill", lost_motion(X), program).unwrap();
    assert_eq!(out, program.replace("X-1", "X-1.01"));
}
