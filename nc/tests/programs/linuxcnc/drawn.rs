//! Programs drawn at random.

use std::collections::BTreeMap;

use leadscrew_nc::coordinates::Coordinates;
use leadscrew_nc::corrector::{CorrectError, Reason};
use leadscrew_nc::path::PathError;
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;

use super::rs274::{self, Control};
use super::true_path::{Case, check, corrected};
use crate::cases::cases;
use crate::control;
use crate::random_programs::{Kinds, Op, Writer, ops};

const MILL: &str = r#"
dialect = "linuxcnc-mill"
tolerance_mm = 0.002
screw_map = "program"
[control]
start = { X = 0.0, Y = 0.0, Z = 0.0 }
tool = 0
tool_offset = 0
radius_tolerance_mm = 0.00127
[control.work_offsets]
active = "G54"
origins.G54 = { X = 5.0, Y = -7.0, Z = 11.0 }
[[terms.screw]]
axis = "X"
points = [
  { position_mm = -400, forward_um = 40, backward_um = 52 },
  { position_mm = -20, forward_um = -15, backward_um = -9 },
  { position_mm = 30, forward_um = 15, backward_um = 25 },
  { position_mm = 400, forward_um = -60, backward_um = -55 },
]
[[terms.affine]]
name = "lean and twist"
constant_mm = { X = 0.013, Y = -0.021, Z = 0.034 }
coefficient = [
  { corrects = "Y", by = "X", mm_per_mm = 3e-4 },
  { corrects = "Z", by = "X", over = "Y", places_mm = [-400, 400], mm_per_mm = [-6e-4, 6e-4] },
  { corrects = "X", by = "Z", mm_per_mm = -2e-4 },
]
"#;

const ORIGIN_MM: [f64; 3] = [5.0, -7.0, 11.0];
/// LinuxCNC's own, mm.
const RADIUS_TOLERANCE_MM: f64 = 0.00127;
const HEAD: &str = "G21 G17 G90 G91.1 G94 G40 G49 G54\nF100\n";
/// Apart from where the interpreter begins, which is what the path is compared from.
const FIRST: [&str; 2] = ["G0 X-70 Y-70 Z-50", "G1 X10 Y20 Z-5"];

/// The text of a program: written where a simple control stands that reads along.
fn program(kinds: Kinds, ops: &[Op]) -> String {
    let reading = control::Reading {
        lathe: false,
        steps: None,
        radius_tolerance_mm: RADIUS_TOLERANCE_MM,
    };
    let works = [(54, ORIGIN_MM)].into();
    let mut control = control::Control::new(reading, works, [].into(), Coordinates::ZERO);
    let mut text = HEAD.to_owned();
    let mut writer = Writer::new(kinds);
    let mut blocks: Vec<String> = FIRST.map(String::from).into();
    let mut rest = ops.iter();
    loop {
        for block in &blocks {
            // Rounded, an arc may be none for the control.
            if control.run(block).is_ok() {
                text += block;
                text.push('\n');
            }
        }
        let Some(op) = rest.next() else { break };
        blocks = writer.blocks(op, &control);
    }
    text + "G92.1\nM2\n"
}

/// Not in inches: the interpreter's output has too few digits then. Half of the programs in the coarse step of some posts.
#[test]
fn programs_drawn_at_random() {
    if !rs274::is_installed() {
        return;
    }
    let config = cases(16, 20);
    let mut runner = TestRunner::new(config.clone());
    let mut refused = BTreeMap::<&str, u32>::new();
    for number in 0..config.cases {
        let step = [1e-4, 1e-3][number as usize % 2];
        let kinds = Kinds {
            lathe: false,
            offsets: false,
            inches: false,
            steps: [step, 0.1 * step],
        };
        let ops = ops(kinds, 4..14).new_tree(&mut runner).unwrap().current();
        let case = Case {
            setup: MILL,
            files: |name| Err(name.to_owned()),
            program: program(kinds, &ops),
            control: Control {
                origin_mm: ORIGIN_MM,
                tools: "",
                start: Coordinates::ZERO,
            },
            cycles: &[],
        };
        let refusal = match corrected(&case) {
            Ok(_) => {
                check(&case);
                continue;
            }
            Err(CorrectError::Refused(refusal)) => refusal,
            Err(error) => panic!("{error}"),
        };
        // Only what rounding of the words can bring about.
        let why = match refusal.reason {
            Reason::RadiusForm { .. } => "R in whole steps",
            Reason::Path(PathError::Radii { .. }) => "radii",
            _ => panic!("{}{refusal}", case.program),
        };
        *refused.entry(why).or_default() += 1;
    }
    let count: u32 = refused.values().sum();
    println!("{} programs, refused: {refused:?}", config.cases);
    assert!(4 * count <= config.cases, "{refused:?}");
}
