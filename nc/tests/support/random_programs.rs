//! Programs at random, as a person or a post would write them: lines, arcs in all forms and planes, holes, ways, inches, offsets.
//! They are drawn as operations and written where a control stands.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;

use proptest::prelude::*;

use leadscrew_nc::coordinates::Axis;

use super::control::Control;

/// Something that a program does. Lengths are thousandths of a mm.
#[derive(Clone, Debug)]
pub enum Op {
    Move {
        rapid: bool,
        axes: u8,
        by_letter: u8,
        to: [i32; 3],
    },
    Arc(Arc),
    Drill {
        again: bool,
        to: [i32; 2],
        bottom: i32,
        retract: bool,
    },
    Plane(u8),
    Incremental(bool),
    CentreAbsolute(bool),
    Inches(bool),
    Work(u32),
    Shift {
        axes: u8,
        to: [i32; 3],
    },
    ShiftOff,
    Length(u32),
    Dwell,
}

/// An arc as it is drawn.
#[derive(Clone, Debug)]
pub struct Arc {
    clockwise: bool,
    in_r: bool,
    /// From its start, in its plane.
    centre: [i32; 2],
    /// Angle turned through, rad: a turn is a full circle.
    turned: f64,
    climb: Option<i32>,
}

/// What programs are made of.
#[derive(Clone, Copy, Debug)]
pub struct Kinds {
    /// X and U are diameters, U, V, W ways; one plane, no modes.
    pub lathe: bool,
    /// Holes, work offsets and tool lengths as well.
    pub offsets: bool,
    pub inches: bool,
    /// Step of the words, mm and inches.
    pub steps: [f64; 2],
}

fn value() -> std::ops::Range<i32> {
    -40_000..40_000
}

fn arc() -> impl Strategy<Value = Op> {
    let turned = prop_oneof![
        4 => (1..4_u8).prop_map(|quarters| f64::from(quarters) * PI / 2.0),
        3 => 0.3..5.9_f64,
        1 => 0.05..0.15_f64,
        1 => (PI - 2e-4)..(PI + 2e-4),
        2 => Just(TAU),
    ];
    let centre = prop_oneof![
        [value(), value()],
        [-5_000..5_000_i32, -5_000..5_000_i32],
        [-500..500_i32, -500..500_i32]
    ];
    let climb = proptest::option::of(-999..999_i32);
    (any::<bool>(), any::<bool>(), centre, turned, climb)
        .prop_filter("a radius", |(_, _, [i, j], _, _)| i.abs() + j.abs() > 200)
        .prop_map(|(clockwise, in_r, centre, turned, climb)| {
            Op::Arc(Arc {
                clockwise,
                // A full circle has no R form.
                in_r: in_r && turned != TAU,
                centre,
                turned,
                climb,
            })
        })
}

fn op(kinds: Kinds) -> BoxedStrategy<Op> {
    let values = [value(), value(), value()];
    let moves = (any::<bool>(), 1..8_u8, 0..8_u8, values.clone()).prop_map(
        |(rapid, axes, by_letter, to)| Op::Move {
            rapid,
            axes,
            by_letter,
            to,
        },
    );
    let common = prop_oneof![10 => moves, 4 => arc(), 1 => Just(Op::Dwell)];
    if kinds.lathe {
        return common.boxed();
    }
    let drill = (any::<bool>(), [value(), value()], value(), any::<bool>());
    let drill = drill.prop_map(|(again, to, bottom, retract)| Op::Drill {
        again,
        to,
        bottom,
        retract,
    });
    let modes = prop_oneof![
        any::<bool>().prop_map(Op::Incremental),
        any::<bool>().prop_map(Op::CentreAbsolute),
        (0..3_u8).prop_map(Op::Plane),
        (1..8_u8, values).prop_map(|(axes, to)| Op::Shift { axes, to }),
        Just(Op::ShiftOff),
    ];
    let offsets = prop_oneof![
        2 => drill,
        1 => (54..56_u32).prop_map(Op::Work),
        1 => (0..3_u32).prop_map(Op::Length),
    ];
    let inches = any::<bool>().prop_map(Op::Inches);
    let with_offsets = u32::from(kinds.offsets);
    prop_oneof![
        15 => common,
        7 => modes,
        4 * with_offsets => offsets,
        u32::from(kinds.inches) => inches,
    ]
    .boxed()
}

/// What programs of some kinds do.
pub fn ops(kinds: Kinds, count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Op>> {
    proptest::collection::vec(op(kinds), count)
}

/// Writes operations as blocks.
#[derive(Clone, Copy, Debug)]
pub struct Writer {
    kinds: Kinds,
    /// The block before was a hole: one may be added by its place alone.
    drilled: bool,
}

impl Writer {
    pub fn new(kinds: Kinds) -> Self {
        Self {
            kinds,
            drilled: false,
        }
    }

    /// The blocks of an operation where the control stands; none where it cannot be written there.
    pub fn blocks(&mut self, op: &Op, control: &Control) -> Vec<String> {
        let drilled = std::mem::replace(&mut self.drilled, matches!(op, Op::Drill { .. }));
        let mm = |value: i32| f64::from(value) / 1000.0;
        match op {
            Op::Move {
                rapid,
                axes,
                by_letter,
                to,
            } => vec![self.movement(*rapid, *axes, *by_letter, to.map(mm), control)],
            Op::Arc(arc) => self.arc(arc, control).into_iter().collect(),
            Op::Drill {
                again,
                to: [x, y],
                bottom,
                retract,
            } => {
                let word = |letter, axis, value: i32| self.word(letter, mm(value), axis, control).0;
                let hole = format!("{}{}", word('X', 0, *x), word('Y', 1, *y));
                if *again && drilled {
                    return vec![hole];
                }
                let height = if *retract { "G99" } else { "G98" };
                let z = word('Z', 2, *bottom);
                let r = word('R', 2, *bottom + 5000);
                vec!["G17 G90".into(), format!("{height} G81{hole}{z}{r} F50")]
            }
            Op::Plane(plane) => vec![["G17", "G18", "G19"][usize::from(*plane)].into()],
            Op::Incremental(on) => vec![String::from(if *on { "G91" } else { "G90" })],
            Op::CentreAbsolute(on) => vec![String::from(if *on { "G90.1" } else { "G91.1" })],
            Op::Inches(on) => vec![String::from(if *on { "G20" } else { "G21" })],
            Op::Work(work) => vec![format!("G{work}")],
            Op::Shift { axes, to } => {
                let words = (0..3).filter(|axis| axes & (1 << axis) != 0);
                let words = words.map(|axis| {
                    self.word(['X', 'Y', 'Z'][axis], mm(to[axis]), axis, control)
                        .0
                });
                vec![format!("G92{}", words.collect::<String>())]
            }
            Op::ShiftOff => vec!["G92.1".into()],
            Op::Length(0) => vec!["G49".into()],
            Op::Length(tool) => vec![format!("G43 H{tool}")],
            Op::Dwell => vec!["G4 P0".into()],
        }
    }

    fn step(&self, control: &Control) -> f64 {
        self.kinds.steps[usize::from(control.is_inches())]
    }

    /// A word of an axis, and the value that it has, rounded to what can be written.
    fn word(&self, letter: char, mm: f64, axis: usize, control: &Control) -> (String, f64) {
        let (step, unit) = (self.step(control), control.unit(axis));
        let steps = (mm / unit / step).round();
        let decimals = -step.log10().round() as usize;
        (
            format!(" {letter}{:.decimals$}", steps * step),
            steps * step * unit,
        )
    }

    fn movement(
        &self,
        rapid: bool,
        axes: u8,
        by_letter: u8,
        to: [f64; 3],
        control: &Control,
    ) -> String {
        let mut block = String::from(if rapid { "G0" } else { "G1" });
        for axis in (0..3).filter(|axis| axes & (1 << axis) != 0) {
            let way = self.kinds.lathe && by_letter & (1 << axis) != 0;
            let letter = [['X', 'Y', 'Z'], ['U', 'V', 'W']][usize::from(way)][axis];
            block += &self.word(letter, to[axis], axis, control).0;
        }
        block + if rapid { "" } else { " F100" }
    }

    /// An arc from where the control stands: none where rounding leaves no end apart from the start.
    fn arc(&self, arc: &Arc, control: &Control) -> Option<String> {
        let plane = control.plane();
        let [first, second] = plane.axes().map(Axis::index);
        let from: [f64; 3] = std::array::from_fn(|axis| control.program_mm(axis));
        let sign = if arc.clockwise { -1.0 } else { 1.0 };
        let [i, j] = arc.centre.map(|value| f64::from(value) / 1000.0);
        let radius = i.hypot(j);
        let begun = (-j).atan2(-i);
        let ended = begun + sign * arc.turned;
        let is_full = arc.turned == TAU;
        let mut block = String::from(if arc.clockwise { "G2" } else { "G3" });
        let mut goal = from;
        (goal[first], goal[second]) = (
            from[first] + i + radius * ended.cos(),
            from[second] + j + radius * ended.sin(),
        );
        let across = plane.across().index();
        goal[across] += arc.climb.map_or(0.0, |climb| f64::from(climb) / 1000.0);
        let mut way = [0.0; 3];
        for axis in 0..3 {
            let stays = (axis == across && arc.climb.is_none()) || (is_full && axis != across);
            if stays {
                continue;
            }
            let base = if control.is_incremental() {
                from[axis]
            } else {
                0.0
            };
            let (word, said) = self.word(['X', 'Y', 'Z'][axis], goal[axis] - base, axis, control);
            block += &word;
            way[axis] = base + said - from[axis];
        }
        let half = way[first].hypot(way[second]) / 2.0;
        if half < self.step(control) * control.centre_unit() && !is_full {
            return None;
        }
        if arc.in_r {
            // Rounded up, the end can be reached.
            let unit = self.step(control) * control.centre_unit();
            let reach = (radius.max(half) / unit).ceil() * unit;
            let signed = if arc.turned > PI { -reach } else { reach };
            block += &self.centre_word('R', signed, control);
            return Some(block);
        }
        for (axis, centre) in [(first, i), (second, j)] {
            let base = if control.is_centre_absolute() {
                from[axis]
            } else {
                0.0
            };
            block += &self.centre_word(['I', 'J', 'K'][axis], base + centre, control);
        }
        Some(block)
    }

    /// A word that is a radius on a lathe too.
    fn centre_word(&self, letter: char, mm: f64, control: &Control) -> String {
        let step = self.step(control);
        let decimals = -step.log10().round() as usize;
        let mut text = String::new();
        let value = (mm / control.centre_unit() / step).round() * step;
        let _ = write!(text, " {letter}{value:.decimals$}");
        text
    }
}
