//! The program of P4, Table 1, its scan faults put right: `X4-020500` of N016 and the five digits of R in N017.

use leadscrew_nc::coordinates::Axis::{B, X, Y, Z};
use leadscrew_nc::machine_state::MachineState;

use super::known_terms::{constant, slope};
use super::{correct, correct_by, refused};

const PROGRAM: &str = include_str!("../data/p4_table_1.nc");

#[test]
fn every_block_is_corrected() {
    let terms = constant(&[(X, 0.010), (Z, -0.005), (B, 0.036)]);
    let out = correct_by("micrometre", &MachineState::default(), terms, PROGRAM).unwrap();
    let expected = PROGRAM
        .replace("X-116000", "X-115990")
        .replace("B+250000", "B+250100")
        .replace("Z-002475", "Z-002480")
        .replace("X+055000", "X+055010")
        .replace("Z+002000", "Z+001995")
        .replace("X-095000", "X-094990")
        .replace("Z-002500", "Z-002505")
        .replace("X+092000", "X+092010")
        .replace("X-020500", "X-020490")
        .replace("Z-001600", "Z-001605")
        .replace("B+500000", "B+500100")
        .replace("X-027000", "X-026990")
        .replace("Z-004300", "Z-004305")
        .replace("X-037000", "X-036990")
        .replace("Z-002400", "Z-002405");
    assert_eq!(out, expected);
    assert_eq!(PROGRAM.lines().count(), 25, "a % and 24 blocks");
}

#[test]
fn words_of_other_axes_are_added_in_their_width() {
    // Y leans by 0.1 mm over a metre of X.
    let out = correct("micrometre", slope(Y, X, 1e-4), PROGRAM);
    let lines: Vec<_> = out.lines().collect();
    assert_eq!(lines[1], "N001G64X-116000Y-000012T01");
    assert_eq!(lines[4], "N004G60Y+064988Z-002475");
    assert_eq!(lines[6], "N006G67X+055000Y+065006M10");
    assert_eq!(lines[16], "N016X-020500Y+064998");
    assert_eq!(lines[22], "N022G80X-037000Y+022996");
}

#[test]
fn the_scan_as_it_is_is_refused_at_its_columns() {
    let terms = || constant(&[(X, 0.010)]);
    let raw = PROGRAM.replace("N016X-020500", "N016X4-020500");
    assert_eq!(
        refused("micrometre", terms(), &raw),
        "17:5: `X4-020500` is no number: mend the block, or choose the dialect it is written in"
    );
    let raw = PROGRAM.replace("Z-001600R002500", "Z-001600R02500");
    assert_eq!(
        refused("micrometre", terms(), &raw),
        "18:16: R has 5 digits, 6 are expected"
    );
    assert_eq!(
        correct("micrometre", constant(&[(X, 0.0)]), PROGRAM),
        PROGRAM
    );
}
