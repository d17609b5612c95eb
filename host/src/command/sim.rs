//! `leadscrew sim`: a move there and back on a simulated machine.

use std::path::Path;

use leadscrew::estimator::EstimatorConfig;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::MoveAndBack;
use serde::Serialize;
use std::collections::BTreeMap;

use super::{estimator, print, print_json, tick_rate, write_file};
use crate::cli::SimArgs;
use crate::error::CommandError;
use crate::figures::{self, acceleration_points, panel, points, velocity_points};
use crate::machine_file;
use crate::plot::{Colour, Figure, Series};
use crate::report::{CsvReport, LagFigures};
use crate::simulation::{Accuracy, Run, RunSpec};
use crate::statistics::Spread;

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
    let (base, machine) = machine(&args.machine)?;
    if args.dump_machine {
        return print(&machine_file::dump(base, &machine));
    }
    let spec = spec(args, machine)?;
    let run = spec.run()?;
    if let Some(path) = &args.output.csv {
        write_csv(path, &spec, &run)?;
    }
    if let Some(path) = &args.output.plot {
        figure(&spec, &run).save(path)?;
    }
    let report = Report::new(args, &spec, &run);
    if args.output.json {
        print_json(&report)
    } else {
        print(&report.to_text())
    }
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
    let known = machine_file::BASES.map(|(name, _)| name).join(", ");
    Err(CommandError::Usage(format!(
        "--machine {name}: expected one of {known}, or a file FILE.toml"
    )))
}

fn spec(args: &SimArgs, machine: MachineParams) -> Result<RunSpec, CommandError> {
    let scenario = MoveAndBack {
        move_mm: args.move_mm,
        feed_mm_per_min: args.feed,
        ..MoveAndBack::standard(tick_rate(args.tick_hz)?)
    };
    Ok(RunSpec {
        machine,
        scenario,
        estimator: estimator(&args.estimator)?,
        seed: args.seed,
    })
}

fn write_csv(path: &Path, spec: &RunSpec, run: &Run) -> Result<(), CommandError> {
    write_file(path, |file| {
        let mut report = CsvReport::new(file, run.tick_hz, spec.estimator, &FURTHER_COLUMNS)?;
        for (index, tick) in run.ticks.iter().enumerate() {
            let outputs = &tick.outputs;
            let truth = run.truth.before(index, 0.0).unwrap_or_default();
            let further = [
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
            report.row(index as u64, outputs.count, &outputs.estimate, &further)?;
        }
        report.finish()
    })
}

/// Velocity, acceleration and following error of a run, by the estimator in the loop.
fn figure(spec: &RunSpec, run: &Run) -> Figure {
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
            "{} mm at {} mm/min and back",
            spec.scenario.move_mm, spec.scenario.feed_mm_per_min
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
                vec![Series::line(name, error, Colour::Vermillion)],
            ),
        ],
    )
}

/// Figures of a run, for people and programs.
#[derive(Serialize)]
struct Report {
    schema: &'static str,
    machine: String,
    move_mm: f64,
    feed_mm_per_min: f64,
    tick_hz: f64,
    seed: u64,
    estimator: &'static str,
    ticks: usize,
    digest: String,
    units: Units,
    following_error: FollowingError,
    estimators: BTreeMap<&'static str, EstimatorFigures>,
}

#[derive(Serialize)]
struct Units {
    position: &'static str,
    velocity: &'static str,
    acceleration: &'static str,
    lag: &'static str,
}

#[derive(Serialize)]
struct FollowingError {
    peak: f64,
    rms: f64,
    at_end: f64,
}

/// Errors of an estimator against the truth at its own instant, while a move runs.
#[derive(Serialize)]
struct EstimatorFigures {
    velocity_error_rms: f64,
    acceleration_error_rms: f64,
    tachogenerator_difference_rms: f64,
    #[serde(flatten)]
    lags: LagFigures,
}

impl EstimatorFigures {
    fn new(config: &EstimatorConfig, accuracy: &Accuracy) -> Self {
        Self {
            velocity_error_rms: accuracy.velocity.rms(),
            acceleration_error_rms: accuracy.acceleration.rms(),
            tachogenerator_difference_rms: accuracy.against_tachogenerator.rms(),
            lags: config.into(),
        }
    }
}

impl Report {
    fn new(args: &SimArgs, spec: &RunSpec, run: &Run) -> Self {
        let error: Spread = run.following_error();
        let at_end = run
            .ticks
            .last()
            .map_or(0.0, |tick| tick.outputs.following_error.to_num());
        let figures = |listener: &crate::simulation::Listener| {
            (
                listener.config.name(),
                EstimatorFigures::new(&listener.config, &run.accuracy(listener)),
            )
        };
        Self {
            schema: "leadscrew/sim/1",
            machine: args.machine.clone(),
            move_mm: spec.scenario.move_mm,
            feed_mm_per_min: spec.scenario.feed_mm_per_min,
            tick_hz: spec.scenario.tick_hz,
            seed: spec.seed,
            estimator: spec.estimator.name(),
            ticks: run.ticks.len(),
            digest: format!("{:016x}", run.digest),
            units: Units {
                position: "d",
                velocity: "d/tick",
                acceleration: "d/tick²",
                lag: "tick",
            },
            following_error: FollowingError {
                peak: error.peak(),
                rms: error.rms(),
                at_end,
            },
            estimators: run.listeners.iter().map(figures).collect(),
        }
    }

    fn to_text(&self) -> String {
        let mut text = format!(
            "{}: {} mm at {} mm/min and back, {} Hz, {} in the loop, seed {}\n\
             {} ticks, digest {}\n\
             following error, d: peak {:.1}, rms {:.2}, at the end {:.1}\n",
            self.machine,
            self.move_mm,
            self.feed_mm_per_min,
            self.tick_hz,
            self.estimator,
            self.seed,
            self.ticks,
            self.digest,
            self.following_error.peak,
            self.following_error.rms,
            self.following_error.at_end,
        );
        for (name, figures) in &self.estimators {
            text += &format!(
                "{name:12} σ_v {:.4} d/tick, σ_a {:.4} d/tick², lags {:.2} {:.2} {:.2} ticks\n",
                figures.velocity_error_rms,
                figures.acceleration_error_rms,
                figures.lags.lag_x_ticks,
                figures.lags.lag_v_ticks,
                figures.lags.lag_a_ticks,
            );
        }
        text
    }
}
