//! The machine that random programs run on: two work offsets, two tools, its axes at the origin.

use std::sync::OnceLock;

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::corrector::Corrector;
use leadscrew_nc::dialect::{Dialect, Integers};
use leadscrew_nc::machine_state::{MachineState, Places, Tool};
use leadscrew_nc::path::Tolerance;
use leadscrew_nc::terms::Terms;

use super::control::{Control, LINEAR, Place, Reading};
use super::polynomial::Polynomial;
use super::side_by_side::SideBySide;

const WORKS: [(u32, Place); 2] = [(54, [10.0, -20.0, 30.0]), (55, [-100.5, 7.25, 0.0])];
const TOOLS: [(u32, Place); 2] = [(1, [0.0, 0.0, 55.5]), (2, [1.0, 0.0, 80.0])];

fn places(place: Place) -> Places {
    LINEAR.into_iter().zip(place).collect()
}

/// What the corrector is told of it.
pub fn state(dialect: &Dialect) -> MachineState {
    let mut state = MachineState {
        start: Axis::ALL.into_iter().map(|axis| (axis, 0.0)).collect(),
        block_delete: Some(false),
        ..MachineState::default()
    };
    for (work, place) in WORKS {
        let name = format!("G{work}");
        if !dialect.work_offsets().is_empty() {
            state.work_offsets.origins.insert(name, places(place));
        }
    }
    for (tool, place) in TOOLS {
        let tool_of = Tool {
            offset: places(place),
            radius_mm: Some(0.5),
        };
        state.tools.insert(tool, tool_of);
    }
    state
}

/// A dialect that comes with the crate; each is read once, for they are asked for often.
pub fn dialect(name: &str) -> Dialect {
    static ALL: OnceLock<Vec<Dialect>> = OnceLock::new();
    let all = ALL.get_or_init(|| Dialect::names().filter_map(Dialect::named).collect());
    let found = all.iter().find(|dialect| dialect.name() == name);
    found.unwrap_or_else(|| panic!("{name}")).clone()
}

/// The sum of some polynomials.
pub fn terms(polynomials: &[Polynomial]) -> Terms {
    let sum = |terms: Terms, one: &Polynomial| terms.with(*one);
    polynomials.iter().fold(Terms::none(), sum)
}

/// A program in a dialect on this machine, beside what the corrector makes of it.
pub fn side_by_side(
    dialect: &str,
    state: &MachineState,
    polynomials: &[Polynomial],
    tolerance_mm: f64,
) -> SideBySide {
    let dialect = self::dialect(dialect);
    let numbers = *dialect.numbers();
    let inch = numbers.increment_inch.unwrap_or(f64::NAN);
    let steps = [numbers.increment_mm, inch];
    let reading = Reading {
        lathe: dialect.diameter_at_start(),
        steps: (numbers.integers == Integers::Increments).then_some(steps),
        radius_tolerance_mm: state.radius_tolerance_mm.unwrap_or(0.01),
    };
    let start = LINEAR.map(|axis| state.start[&axis]);
    let start = Coordinates::xyz(start[0], start[1], start[2]);
    let control = Control::new(reading, WORKS.into(), TOOLS.into(), start);
    let tolerance = Tolerance {
        mm: tolerance_mm,
        degrees: tolerance_mm,
    };
    SideBySide {
        terms: terms(polynomials),
        meant: control.clone(),
        real: control,
        corrector: Corrector::new(dialect, state, terms(polynomials), tolerance).unwrap(),
        tolerance_mm,
        steps_mm: [steps[0], steps[1] * 25.4],
    }
}
