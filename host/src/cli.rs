//! The command line: the commands here, the arguments of each, or of those that belong together, in a file of their own.

mod axis;
mod calibration;
mod correct;
mod deviations;
mod drive;
mod encoder;
mod figures;
mod look;
mod measure;
mod place;
mod plan;
mod probe;
mod procedures;
mod prove_out;
mod replay;
mod shared;
mod sim;

use clap::builder::PossibleValuesParser;
use clap::{Parser, Subcommand};
use leadscrew::estimator::EstimatorConfig;

pub use self::axis::{
    AxisCommand, JogArgs, MoveArgs, OverrideArgs, ParamsCommand, RunArgs, ServeArgs,
};
pub use self::calibration::{CalibrateAxisArgs, ScrewTableCommand, UncertaintyArgs};
pub use self::correct::CorrectArgs;
pub use self::deviations::DeviationsArgs;
pub use self::drive::{AutotuneArgs, IdentifyArgs};
pub use self::encoder::{CalibrateEncoderArgs, MapForm, SimEncoderArgs};
pub use self::figures::{AccuracyArgs, TrackingArgs};
pub use self::look::{BodeArgs, RecordArgs, RecordingArgs, ScopeArgs, SignalList};
pub use self::measure::MeasureArgs;
pub use self::plan::{PlanArgs, PlanFigure};
pub use self::probe::{CalibrateProbeCommand, FitArgs, ProbeArgs};
pub use self::procedures::{NullOffsetArgs, RoomArgs, SetupArgs, YesArgs};
pub use self::prove_out::ProveOutArgs;
pub use self::replay::ReplayArgs;
pub use self::shared::{BenchArgs, ChannelArgs, JsonArgs, OutputArgs, RateArgs, SimulatedArgs};
pub use self::sim::SimArgs;

use crate::axis::PortArgs;
use crate::command::tune_filter::TuneFilterArgs;

const EXIT_CODES: &str = "Exit codes: 0 done, 1 the job failed, 2 bad usage, 3 the axis was lost";

fn estimator_names() -> PossibleValuesParser {
    PossibleValuesParser::new(EstimatorConfig::NAMES)
}

/// Motion control of one machine-tool axis: simulate it, replay captures of its encoder.
///
/// Without a subcommand: a demonstration on a simulated lathe, plots under target/leadscrew of
/// the current directory.
#[derive(Debug, Parser)]
#[command(name = "leadscrew", version, about, after_help = EXIT_CODES)]
pub struct Cli {
    /// Where the axis is, for what works on one
    #[command(flatten)]
    pub port: PortArgs,
    /// What to do.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Moves a simulated axis there and back, or runs a scenario, and reports how well it went
    Sim(SimArgs),
    /// Decodes a logic-analyser capture of an encoder and runs the estimators on it
    Replay(ReplayArgs),
    /// Learns where the edges of an encoder really lie: from captures of steady feeds, or with --port on the axis itself
    CalibrateEncoder(CalibrateEncoderArgs),
    /// Accuracy and repeatability of an axis after ISO 230-2 from what a laser reads, and the table that undoes its errors
    CalibrateAxis(CalibrateAxisArgs),
    /// Writes a capture of the simulated encoder on steady feeds, to try the others on
    SimEncoder(SimEncoderArgs),
    /// Tries every estimator with many parameters and finds the best trade of lag for noise
    TuneFilter(TuneFilterArgs),
    /// Measures the estimators on the scenes of reference: the tables of accuracy
    Accuracy(AccuracyArgs),
    /// Finds out by small experiments what a drive does, beginning with its sign: on the axis at --port, else on a simulated
    /// machine
    Identify(IdentifyArgs),
    /// Identifies a drive and offers the parameters of a loop for it: on the axis at --port, else on a simulated machine
    Autotune(AutotuneArgs),
    /// Plans encoder, feeds and control cycle of a machine from a catalogue
    Plan(PlanArgs),
    /// Moves simulated axes and measures how well they follow, beside LinuxCNC's pid: the tables of tracking
    Tracking(TrackingArgs),
    /// Tells what the deviations of a machine's units do to the place of the tool, and the corrections against it
    Deviations(DeviationsArgs),
    /// Corrects an NC program by named terms: tables of deviations, screw maps, growth, wear, how the workpiece lies
    Correct(CorrectArgs),
    /// Proves a program out on a simulated machine: machines a part, probes it, corrects the program, machines again
    ProveOut(ProveOutArgs),
    /// Calibrates a touch probe from tables of touches: trigger delay, stylus, run-out
    #[command(subcommand)]
    CalibrateProbe(CalibrateProbeCommand),
    /// Computes the features of a part from touches of a probe, or writes the program that makes these
    Measure(MeasureArgs),
    /// What works on an axis
    #[command(flatten)]
    Axis(AxisCommand),
}
