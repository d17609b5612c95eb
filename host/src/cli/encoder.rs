//! Arguments of `calibrate-encoder` and `sim-encoder`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{ChannelArgs, RateArgs, RoomArgs, YesArgs};

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
    /// How often the core ticks
    #[command(flatten)]
    pub rate: RateArgs,
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
