//! `leadscrew sim --scenario`: a run from a file, judged by what the file expects.

mod figure;
mod report;

use std::path::Path;

use super::write_csv_rows;
use crate::cli::SimArgs;
use crate::command::{MAX_TICKS, check_outputs, print, print_json};
use crate::error::CommandError;
use crate::progress::Progress;
use crate::scenario_file;
use crate::scenario_run::{Event, Figures, Record, RunError, judge, run};
use report::Report;

/// Columns of the CSV after the shared ones.
const FURTHER_COLUMNS: [&str; 11] = [
    "setpoint_d",
    "setpoint_velocity_d_per_tick",
    "setpoint_acceleration_d_per_tick2",
    "following_error_d",
    "command",
    "true_position_d",
    "true_velocity_d_per_tick",
    "true_acceleration_d_per_tick2",
    "carriage_d",
    "state",
    "fault",
];

/// Runs the command on the scenario file `path`.
///
/// # Errors
/// A bad file, a run that cannot be, a file that cannot be written, or expectations that are not met.
pub fn command(args: &SimArgs, path: &Path) -> Result<(), CommandError> {
    check_outputs(&args.output, Some(path))?;
    let file = scenario_file::read(path)?;
    let scenario = file.scenario();
    let ticks = scenario.duration_s * scenario.tick_hz;
    if ticks > MAX_TICKS as f64 {
        return Err(CommandError::Data(format!(
            "{}: {ticks:.0} ticks are more than the {MAX_TICKS} that are kept in memory: lower duration_s or tick_hz",
            path.display()
        )));
    }
    let of_file = |error: RunError| CommandError::Data(format!("{}: {error}", path.display()));
    let record = run(&scenario).map_err(of_file)?;
    let figures = Figures::new(&record, scenario.timeline);
    let events = Event::all(&record);
    if let Some(path) = &args.output.csv {
        write_csv(path, &record)?;
    }
    if let Some(picture) = &args.output.plot {
        let _drawing = Progress::endless("drawing");
        figure::figure(path, &file, &record, &events).save(picture)?;
    }
    let verdicts = judge(&file.expect, &figures);
    let unmet = verdicts.iter().filter(|verdict| !verdict.met).count();
    let report = Report::new(path, &file, &record, &events, &figures, verdicts);
    if args.output.json {
        print_json(&report)?;
    } else {
        print(&report.to_text())?;
    }
    if unmet > 0 {
        return Err(CommandError::Data(format!(
            "{}: {unmet} of the expectations {} not met",
            path.display(),
            if unmet == 1 { "is" } else { "are" }
        )));
    }
    Ok(())
}

fn write_csv(path: &Path, record: &Record) -> Result<(), CommandError> {
    let rows = record.ticks.iter().map(|tick| {
        let outputs = &tick.outputs;
        let further = vec![
            outputs.setpoint.position.to_num(),
            outputs.setpoint.velocity.to_num(),
            outputs.setpoint.acceleration.to_num(),
            outputs.following_error.to_num(),
            outputs.command.to_num(),
            tick.shaft.position,
            tick.shaft.velocity,
            tick.shaft.acceleration,
            tick.carriage,
            f64::from(outputs.state as u8),
            outputs.fault.map_or(0.0, |fault| f64::from(fault as u8)),
        ];
        (*outputs, tick.variances, further)
    });
    write_csv_rows(path, record.tick_hz, &FURTHER_COLUMNS, rows)
}
