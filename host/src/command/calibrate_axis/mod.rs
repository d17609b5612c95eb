//! `leadscrew calibrate-axis`: an axis measured, after ISO 230-2.

mod figure;
mod text;

use std::path::Path;

use leadscrew_process::axis_calibration::linuxcnc::CompType;
use leadscrew_process::axis_calibration::{
    Alias, Calibration, ErrorTable, Expansion, Runs, Sources, Uncertainty,
};
use serde::Serialize;

use super::{check_outputs_of, check_replaceable, print, print_json, write_file};
use crate::cli::CalibrateAxisArgs;
use crate::error::CommandError;
use crate::text_file;

/// What was found.
#[derive(Serialize)]
struct Report<'r> {
    schema: &'static str,
    file: String,
    expansion: Expansion,
    calibration: &'r Calibration,
    sources: Sources,
    uncertainty: Uncertainty,
    alias: Option<Alias>,
    is_after_the_standard: bool,
}

/// Runs the command.
///
/// # Errors
/// Bad usage, readings that cannot be used, a file that cannot be written.
pub fn run(args: &CalibrateAxisArgs) -> Result<(), CommandError> {
    check_files(args)?;
    let usage = |error: leadscrew::units::RangeError| CommandError::Usage(error.to_string());
    let expansion = Expansion {
        machine_um_per_m_k: args.expansion,
        instrument_um_per_m_k: args.instrument_expansion,
        datum_mm: args.datum,
        temperature_c: args.temperature,
    };
    let expansion = expansion.check().map_err(usage)?;
    let runs =
        Runs::read(&text_file::read(&args.file)?).map_err(CommandError::content(&args.file))?;
    let calibration = Calibration::of(&runs, &expansion, !args.accept_few)
        .map_err(|error| unfit(&args.file, &error.to_string(), "--accept-few"))?;
    let alias = alias(args, &calibration)?;
    let sources = Sources {
        device_um_per_m: args.uncertainty.device,
        misalignment_mm: args.uncertainty.misalignment,
        thermometer_range_k: args.uncertainty.thermometer,
        expansion_range_um_per_m_k: args.uncertainty.expansion_range,
        drift_um: args.uncertainty.drift,
    };
    let uncertainty = sources
        .of(&calibration, args.expansion, expansion.warmest(&runs))
        .map_err(usage)?;
    write_tables(args, &ErrorTable::of(&calibration))?;
    if let Some(file) = &args.plot {
        figure::of(&calibration, &super::file_name(&args.file)).save(file)?;
    }
    let report = Report {
        schema: "leadscrew/calibrate-axis/1",
        file: args.file.display().to_string(),
        expansion,
        calibration: &calibration,
        sources,
        uncertainty,
        alias,
        is_after_the_standard: !args.accept_few,
    };
    if args.json {
        print_json(&report)
    } else {
        print(&text::of(&report, args.pitch))
    }
}

fn check_files(args: &CalibrateAxisArgs) -> Result<(), CommandError> {
    let (table, linuxcnc) = (args.table.as_deref(), args.linuxcnc.as_deref());
    let file = Some(args.file.as_path());
    check_outputs_of(("--table", table), ("--plot", args.plot.as_deref()), file)?;
    if let Some(linuxcnc) = linuxcnc {
        check_replaceable("--linuxcnc", linuxcnc, file)?;
        if Some(linuxcnc) == table || Some(linuxcnc) == args.plot.as_deref() {
            let linuxcnc = linuxcnc.display();
            return Err(CommandError::Usage(format!(
                "--linuxcnc is {linuxcnc}, as another output: give two names"
            )));
        }
    }
    Ok(())
}

fn unfit(file: &Path, message: &str, option: &str) -> CommandError {
    let file = file.display();
    CommandError::Data(format!(
        "{file}: {message}; or take them as they are by {option}"
    ))
}

/// What the targets do not see, if that is accepted.
fn alias(
    args: &CalibrateAxisArgs,
    calibration: &Calibration,
) -> Result<Option<Alias>, CommandError> {
    let Some(pitch) = args.pitch else {
        return Ok(None);
    };
    leadscrew::units::checked("--pitch", pitch, 1e-3, 1e4)
        .map_err(|error| CommandError::Usage(format!("{error} mm")))?;
    let targets: Vec<_> = calibration
        .targets
        .iter()
        .map(|target| target.target_mm)
        .collect();
    match Alias::of(&targets, pitch) {
        Some(alias) if !args.accept_aliased => {
            Err(unfit(&args.file, &alias.to_string(), "--accept-aliased"))
        }
        alias => Ok(alias),
    }
}

fn write_tables(args: &CalibrateAxisArgs, table: &ErrorTable) -> Result<(), CommandError> {
    if let Some(file) = &args.table {
        let text = table.to_csv();
        // What `screw-table write` would refuse is told now.
        ErrorTable::read(&text).map_err(CommandError::content(file))?;
        write_file(file, |out| out.write_all(text.as_bytes()))?;
    }
    if let Some(file) = &args.linuxcnc {
        let comp_type = match args.linuxcnc_type {
            0 => CompType::Places,
            _ => CompType::Trims,
        };
        let text = table.to_linuxcnc(comp_type);
        write_file(file, |out| out.write_all(text.as_bytes()))?;
    }
    Ok(())
}
