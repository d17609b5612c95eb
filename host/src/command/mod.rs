//! The subcommands, a file each, and what they share.

pub mod demo;
pub mod replay;
pub mod sim;

use std::io::{BufWriter, Write};
use std::path::Path;

use leadscrew::estimator::EstimatorConfig;
use leadscrew::units::{TICK_HZ, checked};

use crate::error::CommandError;

/// The estimator of that name.
fn estimator(name: &str) -> Result<EstimatorConfig, CommandError> {
    let found =
        EstimatorConfig::by_name(name).map_err(|error| CommandError::Usage(error.to_string()))?;
    found.ok_or_else(|| {
        let known = EstimatorConfig::NAMES.join(", ");
        CommandError::Usage(format!(
            "--estimator {name}: there is no such estimator; choose one of {known}"
        ))
    })
}

/// Checks a control rate.
fn tick_rate(tick_hz: f64) -> Result<f64, CommandError> {
    checked("--tick-hz", tick_hz, TICK_HZ.0, TICK_HZ.1)
        .map_err(|error| CommandError::Usage(format!("{error} Hz")))
}

/// Prints a report as JSON.
fn print_json(report: &impl serde::Serialize) -> Result<(), CommandError> {
    let text = serde_json::to_string_pretty(report)
        .map_err(|error| CommandError::Data(error.to_string()))?;
    print(&format!("{text}\n"))
}

/// Prints to standard output; a reader that went away is an error, not a panic.
fn print(text: &str) -> Result<(), CommandError> {
    std::io::stdout()
        .write_all(text.as_bytes())
        .map_err(CommandError::write(Path::new("standard output")))
}

/// Writes a file that appears whole or not at all.
fn write_file(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<(), CommandError> {
    crate::whole_file::write(path, |file| {
        let mut buffered = BufWriter::new(file);
        fill(&mut buffered)?;
        buffered.flush()
    })
    .map_err(CommandError::write(path))
}
