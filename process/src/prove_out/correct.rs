//! The program corrected by the terms, block by block.

use leadscrew_nc::coordinates::Axis;
use leadscrew_nc::corrector::{Corrector, correct};
use leadscrew_nc::dialect::Dialect;
use leadscrew_nc::machine_state::{MachineState, Places, Tool, WorkOffsets};
use leadscrew_nc::path::Tolerance;
use leadscrew_nc::terms::Terms;

use super::ProveOutError;
use super::part::{TOOLS, work_offset};

/// How far the written path may be from the truly corrected one, mm: below what the probe sees.
const TOLERANCE_MM: f64 = 1e-4;
/// Where the axes stand at the start and at a tool change, machine coordinates, mm: clear of the part.
const HOME_MM: [f64; 3] = [0.0, 200.0, -100.0];

/// The program with K in it.
///
/// # Errors
/// A block that is refused, or a state of the machine that does not fit its dialect.
pub(super) fn corrected(program: &str, terms: Terms) -> Result<String, ProveOutError> {
    let wrong = |error: &dyn std::fmt::Display| ProveOutError::Correction(error.to_string());
    let dialect = Dialect::named("linuxcnc-mill")
        .ok_or_else(|| wrong(&"there is no dialect linuxcnc-mill"))?;
    let tolerance = Tolerance {
        mm: TOLERANCE_MM,
        degrees: TOLERANCE_MM,
    };
    let mut corrector =
        Corrector::new(dialect, &control(), terms, tolerance).map_err(|error| wrong(&error))?;
    let mut out = Vec::new();
    correct(program.as_bytes(), &mut out, &mut corrector).map_err(|error| wrong(&error))?;
    String::from_utf8(out).map_err(|error| wrong(&error))
}

/// What the control knows and the program does not say.
fn control() -> MachineState {
    let [x, y, z] = work_offset();
    let origin = Places::from([(Axis::X, x), (Axis::Y, y), (Axis::Z, z)]);
    let home = Places::from([
        (Axis::X, HOME_MM[0]),
        (Axis::Y, HOME_MM[1]),
        (Axis::Z, HOME_MM[2]),
        (Axis::B, 0.0),
    ]);
    let tools = TOOLS.iter().map(|tool| {
        let offset = Places::from([(Axis::Z, tool.length_mm)]);
        (
            tool.number,
            Tool {
                offset,
                radius_mm: None,
            },
        )
    });
    MachineState {
        start: home,
        work_offsets: WorkOffsets {
            active: Some("G54".to_owned()),
            origins: [("G54".to_owned(), origin)].into(),
            ..WorkOffsets::default()
        },
        tools: tools.collect(),
        ..MachineState::default()
    }
}
