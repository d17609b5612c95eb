//! `leadscrew sim`: a move there and back on a simulated machine.

mod report;
mod scenario;

use std::path::Path;

use leadscrew::axis::Outputs;
use leadscrew::estimator::Variances;
use leadscrew::params::ParamError;
use leadscrew::units::{RangeError, checked};
use leadscrew_hal_mock::drive::DriveParams;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::{MoveAndBack, ScenarioError};

use super::{
    MAX_TICKS, check_outputs, estimator, file_name, machine, print, print_json, tick_rate,
    write_file,
};
use crate::cli::SimArgs;
use crate::error::CommandError;
use crate::figures::{self, acceleration_points, panel, points, velocity_points};
use crate::machine_file;
use crate::plot::{Colour, Figure, Series};
use crate::progress::Progress;
use crate::report::CsvReport;
use crate::simulation::{Run, RunSpec};
use report::Report;

/// Longest move, mm.
const MAX_MOVE_MM: f64 = 1e6;

/// Columns of the CSV after the shared ones.
const FURTHER_COLUMNS: [&str; 10] = [
    "setpoint_d",
    "setpoint_velocity_d_per_tick",
    "setpoint_acceleration_d_per_tick2",
    "following_error_d",
    "command",
    "true_position_d",
    "true_velocity_d_per_tick",
    "true_acceleration_d_per_tick2",
    "carriage_d",
    "tachogenerator_d_per_tick",
];

/// Runs the command.
///
/// # Errors
/// Bad usage, a bad machine file, or a file that cannot be written.
pub fn run(args: &SimArgs) -> Result<(), CommandError> {
    if let Some(path) = &args.scenario {
        return scenario::command(args, path);
    }
    let (base, machine) = machine(&args.simulated.machine)?;
    if args.dump_machine {
        return print(&machine_file::dump(base, &machine));
    }
    check_outputs(&args.output, Some(Path::new(&args.simulated.machine)))?;
    let spec = spec(args, machine)?;
    let run = spec
        .run()
        .map_err(|error| blame_option(args, &spec.machine.drive, error))?;
    if let Some(path) = &args.output.csv {
        write_csv(path, &run)?;
    }
    if let Some(path) = &args.output.plot {
        let _drawing = Progress::endless("drawing");
        figure(&args.simulated.machine, &spec, &run).save(path)?;
    }
    let report = Report::new(&args.simulated.machine, &spec, &run);
    if args.output.json {
        print_json(&report)
    } else {
        print(&report.to_text())
    }
}

fn spec(args: &SimArgs, machine: MachineParams) -> Result<RunSpec<'static>, CommandError> {
    let tick_hz = tick_rate(args.simulated.rate.tick_hz)?;
    let move_mm = checked("--move-mm", args.move_mm, -MAX_MOVE_MM, MAX_MOVE_MM)
        .map_err(|error| CommandError::Usage(format!("{error} mm")))?;
    check_length(args)?;
    let scenario = MoveAndBack {
        move_mm,
        feed_mm_per_min: args.feed,
        ..MoveAndBack::standard(tick_hz)
    };
    Ok(RunSpec {
        machine,
        scenario,
        estimator: estimator(&args.estimator)?,
        seed: args.simulated.seed,
        map: None,
    })
}

/// Refuses a run that is too long to be kept; the ramps that it adds to this do not matter.
fn check_length(args: &SimArgs) -> Result<(), CommandError> {
    let cruise_ticks = 2.0 * (args.move_mm / args.feed).abs() * 60.0 * args.simulated.rate.tick_hz;
    if args.feed > 0.0 && cruise_ticks > MAX_TICKS as f64 {
        return Err(CommandError::Usage(format!(
            "{} mm at {} mm/min and back are {cruise_ticks:.0} ticks, more than the {MAX_TICKS} that are kept in \
             memory: shorten --move-mm, raise --feed or lower --tick-hz",
            args.move_mm, args.feed
        )));
    }
    Ok(())
}

/// An error of the scenario with the option, or the drive, that led to it: its parameters are named
/// otherwise.
fn blame_option(args: &SimArgs, drive: &DriveParams, error: ScenarioError) -> CommandError {
    let feed = format!("--feed {}", args.feed);
    let blamed = match &error {
        ScenarioError::Param(ParamError::FeedTooHigh { .. }) => feed,
        ScenarioError::Param(ParamError::Range(range)) => match range.name {
            "max_feed_mm_per_min" | "max_velocity_d_per_tick" => feed,
            // Right in m/s² and m/s³, too much in a tick this long or too little in one this short.
            "max_acceleration_d_per_tick2" | "max_jerk_d_per_tick3" => {
                format!("--tick-hz {}", args.simulated.rate.tick_hz)
            }
            _ => return error.into(),
        },
        ScenarioError::Param(ParamError::Law(range)) => return untunable(args, drive, range),
        ScenarioError::Plan(_) | ScenarioError::Queue(_) => format!("--move-mm {}", args.move_mm),
        ScenarioError::Param(ParamError::TravelReversed { .. })
        | ScenarioError::Planner(_)
        | ScenarioError::Travel(_)
        | ScenarioError::Refused(_)
        | ScenarioError::Autotune(_) => return error.into(),
        ScenarioError::NoSuchEstimator => format!("--estimator {}", args.estimator),
    };
    CommandError::Usage(format!("{blamed}: {error}"))
}

/// The controller's figures follow from the drive's, and only those are in a machine file.
fn untunable(args: &SimArgs, drive: &DriveParams, range: &RangeError) -> CommandError {
    CommandError::Data(format!(
        "{}: a loop cannot be tuned on this machine's drive at {} Hz: [drive] natural_period_s = {} and \
         damping = {} give no usable gain ({range}): make them smaller or change --tick-hz",
        args.simulated.machine, args.simulated.rate.tick_hz, drive.natural_period_s, drive.damping
    ))
}

fn write_csv(path: &Path, run: &Run) -> Result<(), CommandError> {
    let rows = run.ticks.iter().enumerate().map(|(index, tick)| {
        let outputs = &tick.outputs;
        let truth = run.truth.before(index, 0.0).unwrap_or_default();
        let further = vec![
            outputs.setpoint.position.to_num(),
            outputs.setpoint.velocity.to_num(),
            outputs.setpoint.acceleration.to_num(),
            outputs.following_error.to_num(),
            outputs.command.to_num(),
            truth.position,
            truth.velocity,
            truth.acceleration,
            tick.carriage,
            tick.tachogenerator,
        ];
        (*outputs, tick.variances, further)
    });
    write_csv_rows(path, run.tick_hz, &FURTHER_COLUMNS, rows)
}

/// Writes a row a tick: the shared columns, then `columns`.
fn write_csv_rows(
    path: &Path,
    tick_hz: f64,
    columns: &[&str],
    rows: impl ExactSizeIterator<Item = (Outputs, Variances, Vec<f64>)>,
) -> Result<(), CommandError> {
    write_file(path, |file| {
        let mut report = CsvReport::new(file, tick_hz, columns)?;
        let mut progress = Progress::new("writing", rows.len() as u64);
        for (index, (outputs, variances, further)) in rows.enumerate() {
            progress.step();
            let (count, estimate) = (outputs.count, &outputs.estimate);
            report.row(index as u64, count, estimate, &variances, &further)?;
        }
        report.finish()
    })
}

/// Velocity, acceleration and following error of a run, by the estimator in the loop.
fn figure(machine: &str, spec: &RunSpec<'_>, run: &Run) -> Figure {
    let name = spec.estimator.name();
    let estimates: Vec<_> = run.ticks.iter().map(|tick| tick.outputs.estimate).collect();
    let truth = run.true_states();
    let no_lag = |_: &_| 0.0;
    let true_velocity = points(&truth, run.tick_hz, no_lag, |state| state.velocity);
    let true_acceleration = points(&truth, run.tick_hz, no_lag, |state| state.acceleration);
    let error = points(
        &run.ticks,
        run.tick_hz,
        |_| 0.0,
        |tick| tick.outputs.following_error.to_num(),
    );
    Figure::new(
        format!(
            "{}: {} mm at {} mm/min and back, {} Hz",
            file_name(Path::new(machine)),
            spec.scenario.move_mm,
            spec.scenario.feed_mm_per_min,
            run.tick_hz
        ),
        vec![
            panel(
                figures::VELOCITY,
                vec![
                    Series::line(name, velocity_points(&estimates, run.tick_hz), Colour::Blue),
                    Series::dashed("true", true_velocity, Colour::Black),
                ],
            ),
            panel(
                figures::ACCELERATION,
                vec![
                    Series::line(
                        name,
                        acceleration_points(&estimates, run.tick_hz),
                        Colour::Blue,
                    ),
                    Series::dashed("true", true_acceleration, Colour::Black),
                ],
            ),
            panel(
                figures::FOLLOWING_ERROR,
                vec![Series::line(
                    format!("with {name}"),
                    error,
                    Colour::Vermillion,
                )],
            ),
        ],
    )
}
