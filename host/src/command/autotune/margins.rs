//! Margins that are offered, for people and programs.

use leadscrew::tuning::autotune::{LEAST_GAIN_DB, LEAST_PHASE_DEG, Report, SPREAD};
use leadscrew::tuning::margins::Margins;
use serde::Serialize;

use crate::report::{figure_or_dash, text_table};

/// Margins of a loop, on the model and at the worst of its corners.
#[derive(Serialize)]
pub(in crate::command) struct MarginFigures {
    nominal: MarginPair,
    worst: MarginPair,
}

/// Margins, the gain's to either side; null where there is no limit.
#[derive(Serialize)]
struct MarginPair {
    gain_db: Option<f64>,
    reserve_db: Option<f64>,
    phase_deg: f64,
}

impl From<&Margins> for MarginPair {
    fn from(margins: &Margins) -> Self {
        let finite = |db: f64| db.is_finite().then_some(db);
        Self {
            gain_db: finite(margins.gain_db),
            reserve_db: finite(margins.reserve_db),
            phase_deg: margins.phase_deg,
        }
    }
}

impl From<&Report> for MarginFigures {
    fn from(report: &Report) -> Self {
        Self {
            nominal: (&report.nominal).into(),
            worst: (&report.worst).into(),
        }
    }
}

impl MarginFigures {
    /// The margins beside those asked for.
    pub(in crate::command) fn table(&self) -> String {
        let mut table = text_table(&["margins", "gain up, dB", "gain down, dB", "phase, °"]);
        let worst = format!("worst within ±{:.0} % of gain and period", 100.0 * SPREAD);
        let least = format!("{LEAST_GAIN_DB:.0}");
        for (name, pair) in [("model".to_owned(), &self.nominal), (worst, &self.worst)] {
            table.add_row([
                name,
                figure_or_dash(pair.gain_db, 1),
                figure_or_dash(pair.reserve_db, 1),
                format!("{:.0}", pair.phase_deg),
            ]);
        }
        table.add_row([
            "asked for".to_owned(),
            least.clone(),
            least,
            format!("{LEAST_PHASE_DEG:.0}"),
        ]);
        table.trim_fmt()
    }
}

/// A value with some five digits.
pub(in crate::command) fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if size >= 100.0 {
        format!("{value:.1}")
    } else if size >= 1.0 {
        format!("{value:.3}")
    } else {
        format!("{value:.6}")
    }
}
