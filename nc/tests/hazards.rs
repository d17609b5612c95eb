//! What a correction of programs can do wrong, one by one.

#[path = "support/known_terms.rs"]
mod known_terms;

#[path = "hazards/additions.rs"]
mod additions;
#[path = "hazards/arc_ends.rs"]
mod arc_ends;
#[path = "hazards/arcs.rs"]
mod arcs;
#[path = "hazards/cycles.rs"]
mod cycles;
#[path = "hazards/numbers.rs"]
mod numbers;
#[path = "hazards/offsets.rs"]
mod offsets;
#[path = "hazards/paper.rs"]
mod paper;
#[path = "hazards/refusals.rs"]
mod refusals;
#[path = "hazards/reversals.rs"]
mod reversals;
#[path = "hazards/splitting.rs"]
mod splitting;
#[path = "hazards/tool_length.rs"]
mod tool_length;
#[path = "hazards/turning.rs"]
mod turning;

use leadscrew_nc::corrector::Corrector;
use leadscrew_nc::dialect::Dialect;
use leadscrew_nc::machine_state::{MachineState, Places};
use leadscrew_nc::path::Tolerance;
use leadscrew_nc::terms::Terms;

const TOLERANCE: Tolerance = Tolerance {
    mm: 0.002,
    degrees: 0.002,
};

/// A control with its origin of G54 in that of the machine, its axes there too, and two tools.
fn control() -> MachineState {
    use leadscrew_nc::coordinates::Axis;
    let zero: Places = Axis::ALL.into_iter().map(|axis| (axis, 0.0)).collect();
    let mut state = MachineState {
        start: zero.clone(),
        ..MachineState::default()
    };
    state.work_offsets.origins.insert("G54".into(), zero);
    state
}

/// Corrects a program whose blocks are lines; the first refusal as text.
fn correct_by(
    dialect: &str,
    state: &MachineState,
    terms: Terms,
    program: &str,
) -> Result<String, String> {
    let dialect = Dialect::named(dialect).unwrap();
    let mut state = state.clone();
    if dialect.work_offsets().is_empty() {
        state.work_offsets.origins.clear();
    }
    let state = &state;
    let mut corrector = Corrector::new(dialect, state, terms, TOLERANCE).unwrap();
    let mut out = Vec::new();
    for block in program.split_inclusive('\n') {
        corrector
            .block(block.as_bytes(), &mut out)
            .map_err(|refusal| refusal.to_string())?;
    }
    Ok(String::from_utf8(out).unwrap())
}

fn correct(dialect: &str, terms: Terms, program: &str) -> String {
    correct_by(dialect, &control(), terms, program)
        .unwrap_or_else(|refusal| panic!("{program}\n{refusal}"))
}

fn refused(dialect: &str, terms: Terms, program: &str) -> String {
    match correct_by(dialect, &control(), terms, program) {
        Err(refusal) => refusal,
        Ok(out) => panic!("not refused:\n{out}"),
    }
}
