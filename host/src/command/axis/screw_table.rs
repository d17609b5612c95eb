//! `leadscrew screw-table`: the screw error table that an axis keeps.

use std::path::Path;

use leadscrew_client::{Axis, Kind};
use leadscrew_process::axis_calibration::ErrorTable;
use serde::Serialize;

use super::confirm::confirm;
use crate::axis::values::named_request;
use crate::cli::{JsonArgs, ScrewTableCommand};
use crate::command::{check_replaceable, print, print_json, write_file};
use crate::error::CommandError;
use crate::text_file;

/// What was done.
#[derive(Serialize)]
struct Report {
    schema: &'static str,
    what: &'static str,
    file: Option<String>,
    points: usize,
    bytes: usize,
    /// Whether the axis is set to use a table.
    is_used: bool,
}

/// What can be told to be wrong before an axis is asked: the table of `write`.
///
/// # Errors
/// A file that cannot be read or written, or holds no table.
pub fn check(command: &ScrewTableCommand) -> Result<Option<ErrorTable>, CommandError> {
    match command {
        ScrewTableCommand::Write { file, .. } => read_file(file).map(Some),
        ScrewTableCommand::Read { file, .. } => {
            check_replaceable("FILE.csv", file, None).map(|()| None)
        }
        ScrewTableCommand::Erase { .. } => Ok(None),
    }
}

/// Runs the command.
///
/// # Errors
/// A table that the axis does not take; the axis is on, or lost.
pub fn run(axis: &mut Axis, command: &ScrewTableCommand) -> Result<(), CommandError> {
    match command {
        ScrewTableCommand::Write { file, output } => write(axis, file, output),
        ScrewTableCommand::Read { file, output } => read(axis, file, output),
        ScrewTableCommand::Erase { yes, output } => erase(axis, *yes, output),
    }
}

fn read_file(file: &Path) -> Result<ErrorTable, CommandError> {
    ErrorTable::read(&text_file::read(file)?).map_err(CommandError::content(file))
}

fn write(axis: &mut Axis, file: &Path, output: &JsonArgs) -> Result<(), CommandError> {
    let table = read_file(file)?;
    let counts_per_mm = axis.scale()?.counts_per_mm;
    let bytes = table
        .to_stored(counts_per_mm)
        .map_err(|message| CommandError::Data(format!("{}: {message}", file.display())))?;
    let asked = format!("Saving the screw table of {}", file.display());
    axis.write_stored(Kind::ScrewTable, &bytes)
        .map_err(|error| named_request(error, &asked))?;
    tell(
        axis,
        "written",
        Some(file),
        table.points.len(),
        bytes.len(),
        output,
    )
}

fn read(axis: &mut Axis, file: &Path, output: &JsonArgs) -> Result<(), CommandError> {
    if axis.stored(Kind::ScrewTable)?.length == 0 {
        return Err(CommandError::Data(
            "no screw table is saved on this axis: write one by leadscrew screw-table write"
                .to_owned(),
        ));
    }
    let bytes = axis.read_stored(Kind::ScrewTable)?;
    let counts_per_mm = axis.scale()?.counts_per_mm;
    let table = ErrorTable::of_stored(&bytes, counts_per_mm).map_err(CommandError::Data)?;
    write_file(file, |out| out.write_all(table.to_csv().as_bytes()))?;
    tell(
        axis,
        "read",
        Some(file),
        table.points.len(),
        bytes.len(),
        output,
    )
}

fn erase(axis: &mut Axis, yes: bool, output: &JsonArgs) -> Result<(), CommandError> {
    confirm(
        "The screw table that is saved on the axis is erased. Go on?",
        yes,
    )?;
    axis.erase(Some(Kind::ScrewTable))?;
    tell(axis, "erased", None, 0, 0, output)
}

fn tell(
    axis: &mut Axis,
    what: &'static str,
    file: Option<&Path>,
    points: usize,
    bytes: usize,
    output: &JsonArgs,
) -> Result<(), CommandError> {
    let used = axis.parameter("compensation.screw_table")?.number();
    let is_used = used.is_some_and(|used| used >= 0.5);
    let file = file.map(|file| file.display().to_string());
    if output.json {
        return print_json(&Report {
            schema: "leadscrew/screw-table/1",
            what,
            file,
            points,
            bytes,
            is_used,
        });
    }
    let of = file.map_or_else(String::new, |file| {
        format!(" {file}: {points} points, {bytes} bytes")
    });
    let then = match (what, is_used) {
        ("written", true) => "\nit is in use after `leadscrew restart` and homing",
        ("written", false) => {
            "\nit is in use after `leadscrew params set compensation.screw_table=1 --save`, `leadscrew restart` and homing"
        }
        ("erased", _) => "\nthe one that is in use is so until `leadscrew restart`",
        _ => "",
    };
    print(&format!("{what}{of}{then}\n"))
}
