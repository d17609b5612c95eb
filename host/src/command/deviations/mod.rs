//! `leadscrew deviations`: what the deviations of a machine's units do to the place of the tool on the workpiece.

mod picture;
mod report;

use std::io::Write;
use std::path::Path;

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::terms::grid::GridAxis;
use leadscrew_process::deviations::{self, BUILT_IN, Loaded, Machine};
use nalgebra::Vector3;

use self::report::Report;
use super::{check_outputs_of, print, print_json};
use crate::cli::DeviationsArgs;
use crate::error::CommandError;
use crate::text_file::{self, TextFileError};
use crate::whole_file;

/// Most places of a grid that is shown or drawn.
const MOST_PLACES: usize = 200_000;

/// What the command line asks for.
struct Asked {
    loaded: Loaded,
    /// Axes that stand still in the map, where they stand.
    rest: Coordinates,
    /// Axes of the map.
    over: Vec<GridAxis>,
}

/// Runs the command.
///
/// # Errors
/// A machine that cannot be read, a place beyond its ends, output that cannot be written.
pub fn run(args: &DeviationsArgs) -> Result<(), CommandError> {
    let input = Path::new(&args.machine);
    check_outputs_of(
        ("--corrections", args.corrections.as_deref()),
        ("--plot", args.plot.as_deref()),
        Some(input),
    )?;
    let asked = asked(args)?;
    let machine = &asked.loaded.machine;
    let map = machine.map(&asked.rest, asked.over.clone()).map_err(data)?;
    if let Some(path) = &args.plot {
        picture::figure(machine, &asked.rest, &map)?.save(path)?;
    }
    let left_mm = match &args.corrections {
        Some(path) => Some(write_corrections(args, &asked, path)?),
        None => None,
    };
    let point = match &args.at {
        Some(_) if !args.map && args.plot.is_none() && args.corrections.is_none() => {
            Some(machine.point(&asked.rest).map_err(data)?)
        }
        _ => None,
    };
    let report = Report::new(&asked.loaded, &map, point, args.map, left_mm).map_err(data)?;
    if args.json {
        print_json(&report)
    } else {
        print(&report.to_text())
    }
}

fn data(error: impl std::fmt::Display) -> CommandError {
    CommandError::Data(error.to_string())
}

/// The machine of that name, or of that file.
pub(super) fn load(name: &str) -> Result<Loaded, CommandError> {
    if let Some(text) = deviations::built_in(name) {
        return deviations::read(text).map_err(|error| data(format!("{name}:{error}")));
    }
    let path = Path::new(name);
    let text = text_file::read(path).map_err(|error| match error {
        TextFileError::Read { reason, .. } => {
            let known = BUILT_IN.map(|(known, _)| known).join(", ");
            data(format!(
                "{name}: cannot be read ({reason}): give a machine file, or one of {known}"
            ))
        }
        error @ TextFileError::Encoding { .. } => error.into(),
    })?;
    deviations::read(&text).map_err(CommandError::content(path))
}

fn asked(args: &DeviationsArgs) -> Result<Asked, CommandError> {
    let mut loaded = load(&args.machine)?;
    let mut machine = loaded.machine.clone();
    if let Some(tool) = &args.tool {
        if tool.iter().any(|mm| !mm.is_finite()) {
            return Err(CommandError::Usage(
                "--tool: three numbers are expected".into(),
            ));
        }
        machine = machine.with_tool(Vector3::from_column_slice(tool));
    }
    if args.drive_errors_elsewhere {
        machine = machine.without_drive_errors();
    }
    let named = args.at.clone().unwrap_or_default().0;
    for (axis, _) in &named {
        machine = placing(machine, *axis)?;
    }
    loaded.machine = machine;
    let machine = &loaded.machine;
    let at_rest: Vec<Axis> = machine
        .axes()
        .into_iter()
        .map(|(axis, _)| axis)
        .filter(|axis| axis.is_rotary() || named.iter().any(|(one, _)| one == axis))
        .collect();
    let over = machine.evenly(&at_rest, usize::from(args.steps));
    let count: usize = over.iter().map(|one| one.places.len()).product();
    if count > MOST_PLACES {
        return Err(CommandError::Usage(format!(
            "--steps {}: the grid has {count} places, {MOST_PLACES} at most are shown: ask for fewer, or let an axis stand by --at",
            args.steps
        )));
    }
    let rest = named.into_iter().collect();
    Ok(Asked { loaded, rest, over })
}

/// The machine with that axis placing its unit.
fn placing(machine: Machine, axis: Axis) -> Result<Machine, CommandError> {
    if machine.axes().iter().any(|(known, _)| *known == axis) {
        return Ok(machine);
    }
    let known: String = machine
        .axes()
        .iter()
        .map(|(axis, _)| axis.letter())
        .collect();
    let name = machine.name.clone();
    machine.placing(axis).ok_or_else(|| {
        CommandError::Usage(format!(
            "--at {axis}=…: machine \"{name}\" has no axis {axis}; it has {known}"
        ))
    })
}

/// Writes the table and gives the error between its nodes, mm.
fn write_corrections(
    args: &DeviationsArgs,
    asked: &Asked,
    path: &Path,
) -> Result<f64, CommandError> {
    let within_mm = 1e-3 * args.tool_error_um;
    if !(1e-6..=1.0).contains(&within_mm) {
        return Err(CommandError::Usage(format!(
            "--tool-error-um {}: 0.001 to 1000 um is expected",
            args.tool_error_um
        )));
    }
    let machine = &asked.loaded.machine;
    let grid = machine
        .corrections(&asked.rest, asked.over.clone(), within_mm)
        .map_err(data)?;
    let left_mm = machine
        .interpolation_error_mm(&asked.rest, &grid)
        .map_err(data)?;
    let text = toml::to_string(&grid).map_err(data)?;
    let origin = &machine.origin;
    whole_file::write(path, |file| {
        writeln!(
            file,
            "# Corrections of the positional deviations of {} ({origin}), by `leadscrew deviations`.",
            machine.name
        )?;
        file.write_all(text.as_bytes())
    })
    .map_err(CommandError::write(path))?;
    Ok(left_mm)
}
