//! The command line.

mod axis;
mod calibration;
mod correct;
mod deviations;
mod look;
mod measure;
mod place;
mod plan;
mod probe;
mod procedures;
mod prove_out;
mod shared;

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use leadscrew::estimator::EstimatorConfig;

pub use self::axis::{
    AxisCommand, JogArgs, MoveArgs, OverrideArgs, ParamsCommand, RunArgs, ServeArgs,
};
pub use self::calibration::{CalibrateAxisArgs, ScrewTableCommand, UncertaintyArgs};
pub use self::correct::CorrectArgs;
pub use self::deviations::DeviationsArgs;
pub use self::look::{BodeArgs, RecordArgs, RecordingArgs, ScopeArgs, SignalList};
pub use self::measure::MeasureArgs;
pub use self::plan::{PlanArgs, PlanFigure};
pub use self::probe::{CalibrateProbeCommand, FitArgs, ProbeArgs};
pub use self::procedures::{NullOffsetArgs, RoomArgs, SetupArgs, YesArgs};
pub use self::prove_out::ProveOutArgs;
pub use self::shared::{BenchArgs, ChannelArgs, JsonArgs, OutputArgs, SimulatedArgs};

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

/// Arguments of `identify`.
#[derive(Debug, Args)]
pub struct IdentifyArgs {
    /// The machine, and within what it may be moved
    #[command(flatten)]
    pub bench: BenchArgs,
    /// On an axis: what needs no question
    #[command(flatten)]
    pub yes: YesArgs,
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
    /// Draw measured and modelled velocity and their difference in position to FILE.svg or FILE.png
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
}

/// Arguments of `autotune`.
#[derive(Debug, Args)]
pub struct AutotuneArgs {
    /// The machine, and within what it may be moved
    #[command(flatten)]
    pub bench: BenchArgs,
    /// On an axis: what needs no question
    #[command(flatten)]
    pub yes: YesArgs,
    /// On an axis: where it may go
    #[command(flatten)]
    pub room: RoomArgs,
    /// Largest feed of the axis, mm/min, at most 95 % of what is identified at full command; without it 9000, or what
    /// the drive gives if that is less
    #[arg(long, value_name = "MM_PER_MIN", allow_negative_numbers = true)]
    pub max_feed: Option<f64>,
    /// Write the parameters that are offered to FILE; without it they are only shown
    #[arg(long, value_name = "FILE.toml")]
    pub out: Option<PathBuf>,
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `accuracy`.
#[derive(Debug, Args)]
pub struct AccuracyArgs {
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `tracking`.
#[derive(Debug, Args)]
pub struct TrackingArgs {
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
    /// Search the gains of the hand-tuned peer anew, print them and stop (a minute or two)
    #[arg(long, conflicts_with = "json")]
    pub tune_linuxcnc: bool,
}

/// Arguments of `sim`.
#[derive(Debug, Args)]
pub struct SimArgs {
    /// The machine
    #[command(flatten)]
    pub simulated: SimulatedArgs,
    /// Run what FILE says instead of a move there and back, and fail unless all that it expects comes true
    #[arg(
        long,
        value_name = "FILE.toml",
        conflicts_with_all = ["machine", "move_mm", "feed", "tick_hz", "estimator", "seed", "dump_machine"]
    )]
    pub scenario: Option<PathBuf>,
    /// Distance of the move, mm; negative to start the other way
    #[arg(
        long,
        value_name = "X",
        default_value_t = 300.0,
        allow_negative_numbers = true
    )]
    pub move_mm: f64,
    /// Feed of the move, mm/min, at most 95 % of the machine's at full command
    #[arg(
        long,
        value_name = "MM_PER_MIN",
        default_value_t = 9000.0,
        allow_negative_numbers = true
    )]
    pub feed: f64,
    /// Estimator in the loop, in the CSV and in the plot
    #[arg(long, value_name = "NAME", default_value = "exponential", value_parser = estimator_names())]
    pub estimator: String,
    /// Print the machine as TOML, with units and comments, and stop
    #[arg(long, conflicts_with_all = ["json", "csv", "plot"])]
    pub dump_machine: bool,
    /// Where results go
    #[command(flatten)]
    pub output: OutputArgs,
}

/// Arguments of `replay`.
#[derive(Debug, Args)]
pub struct ReplayArgs {
    /// The capture: VCD, sigrok CSV or Saleae Logic 2 CSV; or a recording of `scope` or `record`, whose core is run again
    pub file: PathBuf,
    /// Control rate at which the core samples the capture, Hz (100 to 40000)
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1000.0,
        allow_negative_numbers = true
    )]
    pub tick_hz: f64,
    /// Its channels
    #[command(flatten)]
    pub channels: ChannelArgs,
    /// Only this estimator [default: all in the report, exponential in the CSV]
    #[arg(long, value_name = "NAME", value_parser = estimator_names())]
    pub estimator: Option<String>,
    /// Window of that estimator, ticks: 1 to 64 for simple, 4 to 64 for polynomial [default: 15]
    #[arg(
        long,
        value_name = "W",
        requires = "estimator",
        allow_negative_numbers = true
    )]
    pub window: Option<u32>,
    /// Instant that polynomial answers for: its window's centre or the newest sample [default: newest]
    #[arg(long, value_name = "INSTANT", requires = "estimator", value_parser = ["centre", "newest"])]
    pub answer: Option<String>,
    /// The encoder's map; all of it but its phases is tied to the index, which --z names
    #[arg(long, value_name = "FILE")]
    pub map: Option<PathBuf>,
    /// Start of the span over which acceleration is fitted, s [default: after warm-up]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub from_s: Option<f64>,
    /// End of that span, s [default: the end]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub to_s: Option<f64>,
    /// Where results go
    #[command(flatten)]
    pub output: OutputArgs,
}

/// How much a map knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MapForm {
    /// Every edge
    Full,
    /// The long waves of a revolution and the four phases
    Coarse,
    /// The four phases alone
    Phases,
}

/// Arguments of `calibrate-encoder`.
#[derive(Debug, Args)]
pub struct CalibrateEncoderArgs {
    /// Captures, each VCD, sigrok CSV or Saleae Logic 2 CSV: of steady feeds both ways at two speeds, 17 revolutions
    /// each or more; none with --port
    pub files: Vec<PathBuf>,
    /// Edges of a revolution: 4 times the lines (512 to 65536); an axis knows them
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub edges_per_rev: Option<u32>,
    /// Where the map goes; that of an axis is kept by it
    #[arg(long, value_name = "MAP")]
    pub out: Option<PathBuf>,
    /// On an axis: what needs no question
    #[command(flatten)]
    pub yes: YesArgs,
    /// On an axis: where it may go
    #[command(flatten)]
    pub room: RoomArgs,
    /// On an axis: revolutions that a run averages over, 12 or more; fewer are taken where there is no room
    #[arg(long, value_name = "N", default_value_t = 40, value_parser = clap::value_parser!(u32).range(12..=1000))]
    pub revolutions: u32,
    /// On an axis: the two feeds, mm/min, a fifth apart or more [default: 500 and 400 rpm of the encoder]
    #[arg(long, value_name = "FAST,SLOW", value_delimiter = ',', num_args = 2)]
    pub feeds: Option<Vec<f64>>,
    /// How much the map is to know
    #[arg(long, value_name = "FORM", value_enum, default_value = "full")]
    pub form: MapForm,
    /// Their channels
    #[command(flatten)]
    pub channels: ChannelArgs,
    /// Control rate at which the core samples the captures, Hz (100 to 40000)
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1000.0,
        allow_negative_numbers = true
    )]
    pub tick_hz: f64,
    /// The captures are of a free flywheel that slows down
    #[arg(long)]
    pub coast: bool,
    /// Take runs in one direction; the hysteresis stays unknown
    #[arg(long)]
    pub accept_one_direction: bool,
    /// Take runs at one speed; nothing then shows a motion that trembles in step with the shaft
    #[arg(long)]
    pub accept_one_speed: bool,
    /// Most that runs may differ in a wave, and an edge of the map may be uncertain by, d
    #[arg(
        long,
        value_name = "D",
        default_value_t = 0.01,
        allow_negative_numbers = true
    )]
    pub tolerance: f64,
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
    /// Draw the errors before and after along the revolution to FILE.svg or FILE.png, and by wavelength beside
    /// it to FILE-waves
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
}

/// Arguments of `sim-encoder`.
#[derive(Debug, Args)]
pub struct SimEncoderArgs {
    /// Where the capture goes: VCD with the signals A, B, Z, in ns
    #[arg(long, value_name = "FILE.vcd")]
    pub out: PathBuf,
    /// Velocities of the runs, d/ms; negative backward
    #[arg(
        long,
        value_name = "V,…",
        value_delimiter = ',',
        default_value = "83.3,-83.3,66.7,-66.7",
        allow_negative_numbers = true
    )]
    pub velocities: Vec<f64>,
    /// Length of each run, revolutions
    #[arg(
        long,
        value_name = "N",
        default_value_t = 44.0,
        allow_negative_numbers = true
    )]
    pub revolutions: f64,
    /// Edges of a revolution: 4 times the lines (512 to 16384)
    #[arg(
        long,
        value_name = "N",
        default_value_t = 10_000,
        allow_negative_numbers = true
    )]
    pub edges_per_rev: u32,
    /// Seed of the encoder's errors and of all noise
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        allow_negative_numbers = true
    )]
    pub seed: u64,
    /// Feeds without the wobble and the drift of a real axis
    #[arg(long)]
    pub steady: bool,
}
