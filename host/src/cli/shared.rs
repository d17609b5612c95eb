//! Arguments that several subcommands have.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::progress::Progress;
use crate::recording::{self, ChannelSelection, Recording, RecordingError};

/// The control rate.
#[derive(Debug, Args)]
pub struct RateArgs {
    /// Control rate, Hz (100 to 40000)
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1000.0,
        allow_negative_numbers = true
    )]
    pub tick_hz: f64,
}

/// A simulated machine.
#[derive(Debug, Args)]
pub struct SimulatedArgs {
    /// The machine: 16k20f3, 16k20f3-bare or a TOML file
    #[arg(long, value_name = "NAME|FILE.toml", default_value = "16k20f3")]
    pub machine: String,
    /// How often the core ticks
    #[command(flatten)]
    pub rate: RateArgs,
    /// Seed of everything random
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        allow_negative_numbers = true
    )]
    pub seed: u64,
}

/// Channels of a capture.
#[derive(Debug, Args)]
pub struct ChannelArgs {
    /// Channel A: its exact name, else its index from 0 [default: the first one-bit signal]
    #[arg(long, value_name = "CH")]
    pub a: Option<String>,
    /// Channel B [default: the second one-bit signal]
    #[arg(long, value_name = "CH")]
    pub b: Option<String>,
    /// Channel Z (index) [default: none]
    #[arg(long, value_name = "CH")]
    pub z: Option<String>,
    /// Sampling rate of a sigrok CSV that does not state it, Hz
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    pub samplerate: Option<u64>,
}

impl ChannelArgs {
    /// Reads the capture `file`.
    ///
    /// # Errors
    /// [`RecordingError`] for a file that is no capture or does not have the channels.
    pub fn read(&self, file: &Path) -> Result<Recording, RecordingError> {
        let channels = ChannelSelection {
            a: self.a.clone(),
            b: self.b.clone(),
            z: self.z.clone(),
        };
        let _reading = Progress::endless("reading");
        recording::read(file, &channels, self.samplerate)
    }
}

/// A simulated machine that is to be identified.
#[derive(Debug, Args)]
pub struct BenchArgs {
    /// The machine
    #[command(flatten)]
    pub simulated: SimulatedArgs,
    /// Travel within which all experiments stay, half to either side, mm (0.1 to 1000)
    #[arg(
        long,
        value_name = "MM",
        default_value_t = 20.0,
        allow_negative_numbers = true
    )]
    pub window_mm: f64,
    /// Feed at full command as it is thought to be before it is measured, mm/min
    #[arg(
        long,
        value_name = "MM_PER_MIN",
        default_value_t = 9600.0,
        allow_negative_numbers = true
    )]
    pub nominal_feed: f64,
    /// Exchange the wires of the command, to see the wrong polarity found
    #[arg(long)]
    pub reverse_drive: bool,
}

/// Where results go.
#[derive(Debug, Args)]
pub struct OutputArgs {
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
    /// Write one row a tick to FILE
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Draw velocity and acceleration to FILE.svg or FILE.png
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
}

/// The one option of a command that only reports.
#[derive(Debug, Args)]
pub struct JsonArgs {
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
}
