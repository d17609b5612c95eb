//! The subcommands, a file each, and what they share.

pub mod accuracy;
pub mod autotune;
pub mod axis;
pub mod calibrate_axis;
pub mod calibrate_encoder;
pub mod calibrate_probe;
mod choice;
pub mod correct;
pub mod demo;
pub mod deviations;
pub mod identify;
mod map_figures;
pub mod measure;
pub mod plan;
pub mod prove_out;
pub mod replay;
pub mod sim;
pub mod sim_encoder;
mod span;
pub mod tracking;
pub mod tune_filter;

use std::io::{BufWriter, Write};
use std::path::Path;

use leadscrew::estimator::EstimatorConfig;
use leadscrew::units::{TICK_HZ, checked};
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::Base;

use crate::cli::OutputArgs;
use crate::error::CommandError;
use crate::machine_file;
use crate::plot::PlotError;

/// Most ticks of a run or a replay: what is kept of them takes some 500 bytes each.
const MAX_TICKS: u64 = 4_000_000;

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

/// The machine of `--machine`, and the built-in one that it is based on.
fn machine(name: &str) -> Result<(&str, MachineParams), CommandError> {
    if let Some(machine) = machine_file::built_in(name) {
        return Ok((name, machine));
    }
    let path = Path::new(name);
    if path
        .extension()
        .is_some_and(|extension| extension == "toml")
        || path.exists()
    {
        return Ok(("16k20f3", machine_file::read(path)?));
    }
    let known = Base::ALL.map(Base::name).join(", ");
    Err(CommandError::Usage(format!(
        "--machine {name}: expected one of {known}, or a file FILE.toml"
    )))
}

/// Checks a control rate.
fn tick_rate(tick_hz: f64) -> Result<f64, CommandError> {
    checked("--tick-hz", tick_hz, TICK_HZ.0, TICK_HZ.1)
        .map_err(|error| CommandError::Usage(format!("{error} Hz")))
}

/// The error of a recording that is too long to be kept.
fn too_long(file: &Path, ticks: u64, tick_hz: f64) -> CommandError {
    CommandError::Data(format!(
        "{}: lasts for {ticks} ticks at {tick_hz} Hz, more than the {MAX_TICKS} that are kept in memory: \
         lower --tick-hz or export a shorter range",
        file.display()
    ))
}

/// Refuses, before any work is done, output files that would destroy something.
fn check_outputs(output: &OutputArgs, input: Option<&Path>) -> Result<(), CommandError> {
    check_outputs_of(
        ("--csv", output.csv.as_deref()),
        ("--plot", output.plot.as_deref()),
        input,
    )
}

/// The same of a table and a plot with the names of their options.
fn check_outputs_of(
    table: (&str, Option<&Path>),
    plot: (&str, Option<&Path>),
    input: Option<&Path>,
) -> Result<(), CommandError> {
    if let (_, Some(path)) = plot
        && !is_picture(path)
    {
        return Err(PlotError::Extension { path: path.into() }.into());
    }
    for (option, path) in [table, plot] {
        let Some(path) = path else { continue };
        check_replaceable(option, path, input)?;
    }
    match (table, plot) {
        ((one, Some(csv)), (other, Some(plot))) if csv == plot || same_file(csv, plot) => {
            Err(CommandError::Usage(format!(
                "{one} and {other} are both {}: give two names",
                csv.display()
            )))
        }
        _ => Ok(()),
    }
}

/// Refuses a file to write that is the one that is read, or no ordinary file.
fn check_replaceable(option: &str, path: &Path, input: Option<&Path>) -> Result<(), CommandError> {
    let refuse = |why: &str| {
        let path = path.display();
        Err(CommandError::Usage(format!("{option} {path}: {why}")))
    };
    if input.is_some_and(|input| same_file(input, path)) {
        return refuse("is the file that is read: choose another name");
    }
    // A file is replaced as a whole, which is no way to treat a device or a pipe.
    if path.metadata().is_ok_and(|found| !found.is_file()) {
        return refuse("is not an ordinary file: choose the name of a file");
    }
    Ok(())
}

/// True for the formats of plots, so that another one is refused before the work and not after it.
fn is_picture(path: &Path) -> bool {
    path.extension().is_some_and(|extension| {
        extension.eq_ignore_ascii_case("svg") || extension.eq_ignore_ascii_case("png")
    })
}

/// True where both paths lead to one file that exists.
fn same_file(one: &Path, other: &Path) -> bool {
    match (one.canonicalize(), other.canonicalize()) {
        (Ok(one), Ok(other)) => one == other,
        _ => false,
    }
}

/// A file without its folder, for a title.
fn file_name(path: &Path) -> std::borrow::Cow<'_, str> {
    path.file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy()
}

/// Prints a report as JSON.
fn print_json(report: &impl serde::Serialize) -> Result<(), CommandError> {
    let text = serde_json::to_string_pretty(report)
        .map_err(|error| CommandError::Data(error.to_string()))?;
    print(&format!("{text}\n"))
}

/// Prints to standard output; a reader that went away is an error, not a panic.
fn print(text: &str) -> Result<(), CommandError> {
    let mut output = std::io::stdout();
    let printed = output.write_all(text.as_bytes());
    printed
        .and_then(|()| output.flush())
        .map_err(CommandError::Print)
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
