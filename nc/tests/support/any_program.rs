//! Any bytes as a program. For the tests and for the fuzzer.

use leadscrew_nc::coordinates::Axis;
use leadscrew_nc::corrector::{CorrectError, Corrector, correct};
use leadscrew_nc::dialect::Dialect;
use leadscrew_nc::machine_state::MachineState;
use leadscrew_nc::path::Tolerance;
use leadscrew_nc::terms::Terms;

use super::polynomial::Polynomial;

fn state(dialect: &Dialect) -> MachineState {
    let zero: std::collections::BTreeMap<_, _> =
        Axis::ALL.into_iter().map(|axis| (axis, 0.0)).collect();
    let mut state = MachineState {
        start: zero.clone(),
        block_delete: Some(false),
        ..MachineState::default()
    };
    if !dialect.work_offsets().is_empty() {
        state.work_offsets.origins.insert("G54".into(), zero);
    }
    state
}

fn run(dialect: &str, terms: Terms, program: &[u8]) -> (Vec<u8>, Option<CorrectError>) {
    let dialect = Dialect::named(dialect).unwrap_or_else(|| panic!("{dialect}"));
    let state = state(&dialect);
    let tolerance = Tolerance {
        mm: 0.01,
        degrees: 0.01,
    };
    let mut corrector =
        Corrector::new(dialect, &state, terms, tolerance).unwrap_or_else(|error| panic!("{error}"));
    let mut out = Vec::new();
    let error = correct(program, &mut out, &mut corrector).err();
    (out, error)
}

/// Nothing panics; without a correction, and with one of nothing, what comes out is what went in, up to the block refused; a
/// refusal is within its block.
pub fn check(bytes: &[u8]) {
    let term = |k0, k1, k2| {
        let one = Polynomial {
            corrects: Axis::Y,
            over: Axis::X,
            k0,
            k1,
            k2,
        };
        Terms::none().with(one).with(Polynomial {
            corrects: Axis::X,
            over: Axis::Z,
            ..one
        })
    };
    for name in Dialect::names() {
        let (same, error) = run(name, Terms::none(), bytes);
        assert!(error.is_none() && same == bytes);
        let (same, error) = run(name, term(0.0, 0.0, 0.0), bytes);
        assert!(bytes.starts_with(&same) && (error.is_some() || same.len() == bytes.len()));
        for (k0, k1, k2) in [(0.1, 0.0, 0.0), (0.1, 1e-3, 0.0), (0.1, 1e-3, 1e-5)] {
            if let (_, Some(CorrectError::Refused(refusal))) = run(name, term(k0, k1, k2), bytes) {
                assert!(
                    refusal.block >= 1 && refusal.column >= 1 && refusal.column <= bytes.len() + 1
                );
            }
        }
    }
}
