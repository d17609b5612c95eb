//! Random programs, corrected and read again by a control apart: every block ends where it is meant to plus K.

#[path = "support/control.rs"]
mod control;
#[path = "support/polynomial.rs"]
mod polynomial;

use std::collections::BTreeMap;
use std::fmt::Write as _;

use control::{Control, Event, Place};
use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::corrector::Corrector;
use leadscrew_nc::dialect::Dialect;
use leadscrew_nc::machine_state::{MachineState, Places, Tool};
use leadscrew_nc::path::Tolerance;
use leadscrew_nc::terms::{Circumstances, Terms};
use polynomial::Polynomial;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const TOLERANCE: Tolerance = Tolerance {
    mm: 0.003,
    degrees: 0.003,
};
const LINEAR: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

/// Something that a program does. Numbers are thousandths.
#[derive(Clone, Debug)]
enum Op {
    Move {
        rapid: bool,
        axes: u8,
        by_letter: u8,
        to: [i32; 3],
    },
    Arc {
        clockwise: bool,
        centre: [i32; 2],
        quarters: u8,
        climb: Option<i32>,
    },
    Drill {
        again: bool,
        to: [i32; 2],
        bottom: i32,
        retract: bool,
    },
    Incremental(bool),
    Inches(bool),
    Work(u32),
    Shift {
        axes: u8,
        to: [i32; 3],
    },
    ShiftOff,
    Length(u32),
}

fn op(mill: bool) -> BoxedStrategy<Op> {
    let value = -40_000..40_000_i32;
    let values = [value.clone(), value.clone(), value.clone()];
    let moves = (any::<bool>(), 1..8_u8, 0..8_u8, values.clone()).prop_map(
        |(rapid, axes, by_letter, to)| Op::Move {
            rapid,
            axes,
            by_letter,
            to,
        },
    );
    if !mill {
        return moves.boxed();
    }
    let arc = (
        any::<bool>(),
        [value.clone(), value.clone()],
        1..5_u8,
        proptest::option::of(-999..999_i32),
    )
        .prop_filter("a radius", |(_, [i, j], _, _)| i.abs() + j.abs() > 1000)
        .prop_map(|(clockwise, centre, quarters, climb)| Op::Arc {
            clockwise,
            centre,
            quarters,
            climb,
        });
    let drill = (
        any::<bool>(),
        [value.clone(), value.clone()],
        value,
        any::<bool>(),
    )
        .prop_map(|(again, to, bottom, retract)| Op::Drill {
            again,
            to,
            bottom,
            retract,
        });
    prop_oneof![
        8 => moves,
        2 => arc,
        2 => drill,
        2 => any::<bool>().prop_map(Op::Incremental),
        1 => any::<bool>().prop_map(Op::Inches),
        1 => (54..56_u32).prop_map(Op::Work),
        1 => (1..8_u8, values).prop_map(|(axes, to)| Op::Shift { axes, to }),
        1 => Just(Op::ShiftOff),
        1 => (0..3_u32).prop_map(Op::Length),
    ]
    .boxed()
}

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

/// The blocks of an operation, as a person would write them where the control stands.
fn blocks(op: &Op, control: &Control, drilled: bool, lathe: bool) -> Vec<String> {
    let mm = |value: i32| f64::from(value) / 1000.0;
    let unit = if control.is_inches() { 25.4 } else { 1.0 };
    let said = |value: f64| format!("{:.4}", value / unit);
    match op {
        Op::Move {
            rapid,
            axes,
            by_letter,
            to,
        } => {
            let mut block = String::from(if *rapid { "G0" } else { "G1" });
            for axis in (0..3).filter(|axis| axes & (1 << axis) != 0) {
                let way = lathe && by_letter & (1 << axis) != 0;
                let letter = [['X', 'Y', 'Z'], ['U', 'V', 'W']][usize::from(way)][axis];
                let _ = write!(block, " {letter}{}", said(mm(to[axis])));
            }
            vec![block + if *rapid { "" } else { " F100" }]
        }
        Op::Arc {
            clockwise,
            centre: [i, j],
            quarters,
            climb,
        } => {
            let (i, j) = (mm(*i), mm(*j));
            let mut out = [-i, -j];
            let turns = if *clockwise { 4 - quarters } else { *quarters };
            for _ in 0..turns {
                out = [-out[1], out[0]];
            }
            let way = [i + out[0], j + out[1]];
            let mut block = String::from(if *clockwise { "G2" } else { "G3" });
            for (axis, letter) in ['X', 'Y']
                .into_iter()
                .enumerate()
                .filter(|_| *quarters != 4)
            {
                let from = if control.is_incremental() {
                    0.0
                } else {
                    control.program(axis) * unit
                };
                let _ = write!(block, " {letter}{}", said(from + way[axis]));
            }
            if let Some(climb) = climb {
                let _ = write!(block, " Z{}", said(mm(*climb)));
            }
            let _ = write!(block, " I{} J{}", said(i), said(j));
            vec![block]
        }
        Op::Drill {
            again,
            to: [x, y],
            bottom,
            retract,
        } => {
            let hole = format!("X{} Y{}", said(mm(*x)), said(mm(*y)));
            if *again && drilled {
                return vec![hole];
            }
            let height = if *retract { "G99" } else { "G98" };
            let bottom = mm(*bottom);
            let cycle = format!(
                "{height} G81 {hole} Z{} R{} F50",
                said(bottom),
                said(bottom + 5.0)
            );
            vec!["G90".into(), cycle]
        }
        Op::Incremental(on) => vec![String::from(if *on { "G91" } else { "G90" })],
        Op::Inches(on) => vec![String::from(if *on { "G20" } else { "G21" })],
        Op::Work(work) => vec![format!("G{work}")],
        Op::Shift { axes, to } => {
            let mut block = String::from("G92");
            for axis in (0..3).filter(|axis| axes & (1 << axis) != 0) {
                let _ = write!(block, " {}{}", ['X', 'Y', 'Z'][axis], said(mm(to[axis])));
            }
            vec![block]
        }
        Op::ShiftOff => vec!["G92.1".into()],
        Op::Length(0) => vec!["G49".into()],
        Op::Length(tool) => vec![format!("G43 H{tool}")],
    }
}

fn works() -> BTreeMap<u32, Place> {
    [(54, [10.0, -20.0, 30.0]), (55, [-100.5, 7.25, 0.0])].into()
}

fn tools() -> BTreeMap<u32, Place> {
    [(1, [0.0, 0.0, 55.5]), (2, [1.0, 0.0, 80.0])].into()
}

fn places(place: Place) -> Places {
    LINEAR.into_iter().zip(place).collect()
}

fn state() -> MachineState {
    let mut state = MachineState {
        start: places([0.0; 3]),
        ..MachineState::default()
    };
    for axis in [Axis::A, Axis::B, Axis::C, Axis::U, Axis::V, Axis::W] {
        state.start.insert(axis, 0.0);
    }
    for (work, place) in works() {
        state
            .work_offsets
            .origins
            .insert(format!("G{work}"), places(place));
    }
    for (tool, place) in tools() {
        state.tools.insert(
            tool,
            Tool {
                offset: places(place),
                radius_mm: None,
            },
        );
    }
    state
}

/// Both programs side by side.
struct Pair {
    terms: Terms,
    step_mm: f64,
    step_inch: f64,
    meant: Control,
    real: Control,
    corrector: Corrector,
}

impl Pair {
    fn new(dialect: &str, polynomials: &[Polynomial], lathe: bool) -> Self {
        let terms = || {
            polynomials
                .iter()
                .fold(Terms::none(), |terms, one| terms.with(*one))
        };
        let mut meant = Control::new(works(), tools());
        meant.diameter = lathe;
        meant.ways_by_letter = lathe;
        let dialect = Dialect::named(dialect).unwrap();
        Self {
            terms: terms(),
            step_mm: dialect.numbers().increment_mm,
            step_inch: dialect.numbers().increment_inch.unwrap() * 25.4,
            real: meant.clone(),
            meant,
            corrector: Corrector::new(dialect, &state(), terms(), TOLERANCE).unwrap(),
        }
    }

    fn with_k(&self, place: Place) -> Place {
        let at = Coordinates::xyz(place[0], place[1], place[2]);
        let k = self
            .terms
            .correction(&at, &Circumstances::default())
            .unwrap();
        [
            place[0] + k[Axis::X],
            place[1] + k[Axis::Y],
            place[2] + k[Axis::Z],
        ]
    }

    /// Runs a block through both and compares.
    fn run(&mut self, block: &str) {
        let from = self.meant.machine;
        let wanted = self.meant.run(block);
        let mut out = Vec::new();
        let text = format!("{block}\n");
        if let Err(refusal) = self.corrector.block(text.as_bytes(), &mut out) {
            panic!("{block}: {refusal}");
        }
        let out = String::from_utf8(out).unwrap();
        let mut got = None;
        for line in out.lines() {
            got = self.real.run(line).or(got);
            if let (Some(Event::Stand(place, _)), Some(Event::Stand(to, centre))) = (got, wanted) {
                self.is_on_the_way(place, from, to, centre, &out);
            }
        }
        let step = if self.meant.is_inches() {
            self.step_inch
        } else {
            self.step_mm
        };
        match (wanted, got) {
            (None, None) => {}
            (Some(Event::Stand(wanted, _)), Some(Event::Stand(got, _)))
            | (Some(Event::Hole(wanted)), Some(Event::Hole(got))) => {
                let wanted = self.with_k(wanted);
                for axis in 0..3 {
                    let unit = self.meant.unit(axis) / self.meant.unit(1);
                    let off = (wanted[axis] - got[axis]).abs();
                    assert!(
                        off <= 0.5001 * step * unit + 1e-9,
                        "{block} -> {out}{wanted:?} but {got:?}"
                    );
                }
            }
            (wanted, got) => panic!("{block} -> {out}: {wanted:?} but {got:?}"),
        }
    }

    /// Pieces lie on the way: taken back by K, a place is on the line or on the circle.
    fn is_on_the_way(
        &self,
        place: Place,
        from: Place,
        to: Place,
        centre: Option<[f64; 2]>,
        out: &str,
    ) {
        let mut back = place;
        for _ in 0..20 {
            let there = self.with_k(back);
            for axis in 0..3 {
                back[axis] -= there[axis] - place[axis];
            }
        }
        let off = match centre {
            Some(centre) => {
                let radius = |place: Place| (place[0] - centre[0]).hypot(place[1] - centre[1]);
                // Written in few decimals the radii at both ends differ.
                let (one, other) = (radius(from), radius(to));
                let back = radius(back);
                (one.min(other) - back).max(back - one.max(other))
            }
            None => beside(back, from, to),
        };
        // Rounding of the words.
        assert!(off < 2e-3, "{off} beside the way: {out}");
    }
}

/// Distance of a place from a line.
fn beside(place: Place, from: Place, to: Place) -> f64 {
    let sub = |a: Place, b: Place| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let dot = |a: Place, b: Place| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (way, there) = (sub(to, from), sub(place, from));
    let length = dot(way, way);
    let t = if length > 0.0 {
        (dot(way, there) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let rest = sub(there, [way[0] * t, way[1] * t, way[2] * t]);
    dot(rest, rest).sqrt()
}

fn cases(count: u32) -> ProptestConfig {
    let long = std::env::var_os("LEADSCREW_LONG").is_some();
    ProptestConfig {
        cases: if long { 20 * count } else { count },
        rng_seed: RngSeed::Fixed(4),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(cases(96))]

    #[test]
    fn every_block_of_a_milling_program_ends_at_its_target_plus_k(
        polynomials in terms(),
        ops in proptest::collection::vec(op(true), 1..60),
    ) {
        let mut pair = Pair::new("linuxcnc-mill", &polynomials, false);
        let mut drilled = false;
        pair.run("G0 X0 Y0 Z0");
        for op in &ops {
            for block in blocks(op, &pair.meant, drilled, false) {
                pair.run(&block);
            }
            // A hole again only right behind a hole: other words of axes would be holes too.
            drilled = matches!(op, Op::Drill { .. });
        }
    }

    #[test]
    fn every_block_of_a_turning_program_ends_at_its_target_plus_k(
        polynomials in terms(),
        ops in proptest::collection::vec(op(false), 1..60),
    ) {
        let mut pair = Pair::new("iso-lathe", &polynomials, true);
        for op in &ops {
            for block in blocks(op, &pair.meant, false, true) {
                pair.run(&block);
            }
        }
    }
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
    let mut pair = Pair::new("linuxcnc-mill", &[polynomial, across], false);
    pair.run("G91");
    for number in 0..20_000_i64 {
        let way = (number * 7919 % 2003 - 1001) as f64 / 1000.0;
        pair.run(&format!("G1 X{way:.3} Y{:.3} F100", -way / 2.0));
    }
}

proptest! {
    #![proptest_config(cases(256))]

    #[test]
    fn any_text_is_corrected_or_refused(
        text in prop_oneof![
            "[GXYZMNIJKRT0-9. \n+-]{0,200}",
            "((G(0|1|2|3|81|90|91|92|41|40|28|53)|X|Y|Z|I|J|R)(-?[0-9]{1,3}(\\.[0-9]{0,3})?)? ?\n?){0,60}",
        ],
        polynomials in terms(),
        dialect in 0..5_usize,
    ) {
        let terms = polynomials.iter().fold(Terms::none(), |terms, one| terms.with(*one));
        let dialect = Dialect::named(Dialect::names().nth(dialect).unwrap()).unwrap();
        let mut state = state();
        if dialect.work_offsets().is_empty() {
            state.work_offsets.origins.clear();
        }
        let mut corrector = Corrector::new(dialect, &state, terms, TOLERANCE).unwrap();
        for block in text.split_inclusive('\n') {
            let mut out = Vec::new();
            if let Err(refusal) = corrector.block(block.as_bytes(), &mut out) {
                prop_assert!(refusal.column <= block.len() + 1);
                prop_assert!(out.is_empty());
                break;
            }
        }
    }
}
