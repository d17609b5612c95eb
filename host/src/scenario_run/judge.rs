//! Whether a run was what its file expects.

use leadscrew::probe::ProbeEnd;
use serde::Serialize;

use super::Figures;
use crate::fault_names::{fault_name, probe_end_name, state_name};
use crate::scenario_file::expect::{Bound, Expectations, POSITION_TOLERANCE_MM};

/// An expectation and what was found.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    /// The key in the file.
    pub name: &'static str,
    /// What was expected.
    pub expected: String,
    /// What was found.
    pub found: String,
    /// Whether it is met.
    pub met: bool,
}

/// Judges a run by every expectation of its file.
#[must_use]
pub fn judge(expect: &Expectations, figures: &Figures) -> Vec<Verdict> {
    let mut verdicts = Vec::new();
    let first = figures.stops.first().map(|stop| stop.fault);
    let named = |fault: Option<_>| fault.map_or("none", fault_name).to_owned();
    verdicts.push(Verdict {
        name: "fault",
        expected: named(expect.fault),
        found: named(first),
        met: first == expect.fault,
    });
    if let Some(violation) = figures.violation {
        verdicts.push(Verdict {
            name: "invariants",
            expected: "hold in every tick".to_owned(),
            found: violation.to_string(),
            met: false,
        });
    }
    if let Some(state) = expect.final_state {
        verdicts.push(Verdict {
            name: "final_state",
            expected: state_name(state).to_owned(),
            found: state_name(figures.final_state).to_owned(),
            met: figures.final_state == state,
        });
    }
    if let Some(end) = expect.probed {
        let named = |end: Option<ProbeEnd>| end.map_or("none", probe_end_name).to_owned();
        verdicts.push(Verdict {
            name: "probed",
            expected: named(end),
            found: named(figures.probe.end),
            met: figures.probe.end == end,
        });
    }
    for warning in &expect.warnings {
        let met = figures.warnings.contains(*warning);
        verdicts.push(Verdict {
            name: "warning",
            expected: fault_name(*warning).to_owned(),
            found: if met {
                fault_name(*warning)
            } else {
                "none of it"
            }
            .to_owned(),
            met,
        });
    }
    for (limit, value) in &expect.limits {
        let found = figures.value(limit.figure);
        let (sign, met): (_, fn(f64, f64) -> bool) = match limit.bound {
            Bound::AtMost => ("≤ ", |found, limit| found <= limit),
            Bound::Near => ("", |found, limit| {
                (found - limit).abs() <= POSITION_TOLERANCE_MM
            }),
            Bound::Exactly => ("", |found, limit| found == limit),
        };
        verdicts.push(Verdict {
            name: limit.key.name,
            expected: format!("{sign}{value}"),
            found: found.map_or_else(|| "nothing to measure".to_owned(), short),
            met: found.is_some_and(|found| met(found, *value)),
        });
    }
    verdicts
}

/// A figure to four digits behind the point at most.
#[must_use]
pub fn short(value: f64) -> String {
    let rounded = (value * 1e4).round() / 1e4;
    format!("{}", rounded + 0.0)
}
