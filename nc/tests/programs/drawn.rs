//! Random programs, corrected and read again by a control apart: every block ends where it is meant to plus K, and the way to it
//! is the true one.

use std::collections::BTreeMap;

use leadscrew_nc::coordinates::Axis;
use leadscrew_nc::corrector::Reason;
use leadscrew_nc::dialect::Dialect;
use leadscrew_nc::path::PathError;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use super::cases::cases;
use super::control::LINEAR;
use super::polynomial::Polynomial;
use super::random_programs::{Kinds, Op, Writer, ops};
use super::shop;
use super::side_by_side::{Outcome, SideBySide};

const TOLERANCE_MM: f64 = 0.003;

fn terms() -> impl Strategy<Value = Vec<Polynomial>> {
    let one = (
        0..3_usize,
        0..3_usize,
        -0.05..0.05_f64,
        -1e-3..1e-3_f64,
        -2e-5..2e-5_f64,
        0..4_u8,
    );
    let one = one.prop_map(|(corrects, over, k0, k1, k2, shape)| Polynomial {
        corrects: LINEAR[corrects],
        over: LINEAR[over],
        k0,
        k1: if shape > 0 { k1 } else { 0.0 },
        k2: if shape > 2 { k2 } else { 0.0 },
    });
    proptest::collection::vec(one, 1..4)
}

fn pair(dialect: &str, polynomials: &[Polynomial], radii_mm: Option<f64>) -> SideBySide {
    let mut state = shop::state(&Dialect::named(dialect).unwrap());
    state.radius_tolerance_mm = radii_mm;
    shop::side_by_side(dialect, &state, polynomials, TOLERANCE_MM)
}

/// How programs fared.
#[derive(Debug, Default)]
struct Tally {
    programs: u32,
    blocks: u32,
    whole: u32,
    refused: BTreeMap<&'static str, u32>,
}

impl Tally {
    /// A refusal of a program that is right by itself: only what rounding of its words can bring about.
    fn refuse(&mut self, reason: &Reason, block: &str) {
        let why = match reason {
            // Near half a turn the last digit of R moves the centre by more than the tolerance.
            Reason::RadiusForm { .. } => "R in whole steps",
            Reason::Path(PathError::Radii { .. }) => "radii",
            _ => panic!("{block} should not be refused: {reason}"),
        };
        *self.refused.entry(why).or_default() += 1;
    }

    fn run(&mut self, mut pair: SideBySide, kinds: Kinds, ops: &[Op]) {
        self.programs += 1;
        let mut writer = Writer::new(kinds);
        let first = "G0 X0 Y0 Z0".to_owned();
        let mut blocks = vec![first];
        let mut rest = ops.iter();
        loop {
            for block in blocks {
                self.blocks += 1;
                match pair.run(&block) {
                    Outcome::Compared => {}
                    Outcome::Refused(refusal) => return self.refuse(&refusal.reason, &block),
                    Outcome::Unknown(what) => panic!("{block}: {what}"),
                }
            }
            let Some(op) = rest.next() else { break };
            blocks = writer.blocks(op, &pair.meant);
        }
        self.whole += 1;
    }
}

/// Draws programs and runs them; at least so many of a hundred must come through whole.
fn drawn(dialect: &str, kinds: Kinds, radii_mm: Option<f64>, count: u32, whole_percent: u32) {
    let config = cases(count, 20);
    let mut runner = TestRunner::new(config.clone());
    let mut tally = Tally::default();
    for _ in 0..config.cases {
        let drawn = (terms(), ops(kinds, 1..60)).new_tree(&mut runner).unwrap();
        let (polynomials, ops) = drawn.current();
        tally.run(pair(dialect, &polynomials, radii_mm), kinds, &ops);
    }
    println!("{dialect}: {tally:?}");
    assert!(
        100 * tally.whole >= whole_percent * tally.programs,
        "{tally:?}"
    );
    assert!(tally.blocks > 5 * tally.programs, "{tally:?}");
}

#[test]
fn every_block_of_a_milling_program_ends_at_its_target_plus_k() {
    let kinds = Kinds {
        lathe: false,
        offsets: true,
        inches: true,
        steps: [1e-4, 1e-5],
    };
    drawn("linuxcnc-mill", kinds, None, 96, 90);
}

const TURNING: Kinds = Kinds {
    lathe: true,
    offsets: false,
    inches: false,
    steps: [1e-3, 1e-4],
};

#[test]
fn every_block_of_a_turning_program_ends_at_its_target_plus_k() {
    drawn("iso-lathe", TURNING, None, 96, 80);
}

/// Rounded to the words' step, centre and ends of an arc differ in radius by about as much as this control allows: what it would
/// refuse is not written.
#[test]
fn what_is_written_is_an_arc_for_a_control_that_allows_little() {
    drawn("iso-lathe", TURNING, Some(0.0012), 96, 10);
}

#[test]
fn ways_do_not_drift_over_thousands_of_moves() {
    let polynomial = Polynomial {
        corrects: Axis::X,
        over: Axis::X,
        k0: 0.0,
        k1: 3.3e-4,
        k2: 0.0,
    };
    let across = Polynomial {
        corrects: Axis::Z,
        over: Axis::X,
        k0: 0.0123,
        k1: -1.7e-4,
        k2: 0.0,
    };
    let mut pair = pair("linuxcnc-mill", &[polynomial, across], None);
    pair.run("G91");
    for number in 0..5_000_i64 {
        let way = (number * 7919 % 2003 - 1001) as f64 / 1000.0;
        let block = format!("G1 X{way:.3} Y{:.3} F100", -way / 2.0);
        assert!(matches!(pair.run(&block), Outcome::Compared), "{block}");
    }
}
