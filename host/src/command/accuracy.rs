//! `leadscrew accuracy`: how well the estimators see, on the scenes of reference.

use serde::Serialize;

use super::{print, print_json};
use crate::accuracy::{COLUMNS, Column, Figures, Quantity, figures};
use crate::cli::AccuracyArgs;
use crate::error::CommandError;
use crate::progress::Progress;

/// The figures with what they are.
#[derive(Serialize)]
struct Report {
    schema: &'static str,
    units: Units,
    columns: Vec<ColumnReport>,
    #[serde(flatten)]
    figures: Figures,
}

#[derive(Serialize)]
struct Units {
    velocity: &'static str,
    acceleration: &'static str,
    lag: &'static str,
}

#[derive(Serialize)]
struct ColumnReport {
    quantity: &'static str,
    max_lag_ticks: f64,
    window_ticks: u32,
    answer: &'static str,
}

/// Runs the command.
///
/// # Errors
/// Standard output that cannot be written.
pub fn run(args: &AccuracyArgs) -> Result<(), CommandError> {
    let figures = {
        let _measuring = Progress::endless("measuring");
        figures().map_err(|error| CommandError::Data(error.to_string()))?
    };
    if args.json {
        print_json(&Report {
            schema: "leadscrew/accuracy/1",
            units: Units {
                velocity: "d/tick",
                acceleration: "d/tick^2",
                lag: "ticks",
            },
            columns: COLUMNS.iter().map(ColumnReport::from).collect(),
            figures,
        })
    } else {
        print(&figures.to_text())
    }
}

impl From<&Column> for ColumnReport {
    fn from(column: &Column) -> Self {
        Self {
            quantity: match column.quantity {
                Quantity::Velocity => "velocity",
                Quantity::Acceleration => "acceleration",
            },
            max_lag_ticks: column.max_lag,
            window_ticks: column.window,
            answer: column.answer_name(),
        }
    }
}
