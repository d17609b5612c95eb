//! Arguments of `calibrate-axis` and `screw-table`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::JsonArgs;

/// Arguments of `calibrate-axis`.
#[derive(Debug, Args)]
pub struct CalibrateAxisArgs {
    /// The readings, CSV: target_mm,direction,run and reading_mm or deviation_um, perhaps temperature_c
    #[arg(value_name = "RUNS.csv")]
    pub file: PathBuf,
    /// Pitch of the screw, mm, or another period that targets must not follow
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub pitch: Option<f64>,
    /// Take targets at multiples of the pitch, which do not see its error
    #[arg(long, requires = "pitch")]
    pub accept_aliased: bool,
    /// Take fewer than 5 runs each way, or than 5 targets (2 of each at least): no test after the standard
    #[arg(long)]
    pub accept_few: bool,
    /// Expansion of the axis's scale or screw, µm/(m·K)
    #[arg(
        long,
        value_name = "UM_PER_M_K",
        default_value_t = 11.5,
        allow_negative_numbers = true
    )]
    pub expansion: f64,
    /// Expansion of the instrument, if its readings are not true lengths, µm/(m·K)
    #[arg(
        long,
        value_name = "UM_PER_M_K",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    pub instrument_expansion: f64,
    /// Place that temperature does not move: where the instrument was set to zero, mm
    #[arg(
        long,
        value_name = "MM",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    pub datum: f64,
    /// Temperature of readings that have none, °C
    #[arg(
        long,
        value_name = "C",
        default_value_t = 20.0,
        allow_negative_numbers = true
    )]
    pub temperature: f64,
    /// What the measurement is uncertain by
    #[command(flatten)]
    pub uncertainty: UncertaintyArgs,
    /// Write the errors as a table for `screw-table write`
    #[arg(long, value_name = "FILE.csv")]
    pub table: Option<PathBuf>,
    /// Write the errors as a COMP_FILE of LinuxCNC
    #[arg(long, value_name = "FILE")]
    pub linuxcnc: Option<PathBuf>,
    /// Its COMP_FILE_TYPE: 0 places, 1 trims
    #[arg(long, value_name = "N", default_value_t = 0, requires = "linuxcnc", value_parser = clap::value_parser!(u8).range(0..=1))]
    pub linuxcnc_type: u8,
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
    /// Draw means and twice the scatter of both directions to FILE.svg or FILE.png
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
}

/// What a measurement is uncertain by.
#[derive(Debug, Args)]
pub struct UncertaintyArgs {
    /// Uncertainty of the instrument by its certificate (k = 2), µm/m
    #[arg(
        long,
        value_name = "UM_PER_M",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    pub device: f64,
    /// Offset of the beam over the length that is measured, mm
    #[arg(
        long,
        value_name = "MM",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    pub misalignment: f64,
    /// Range within which the thermometer may be off, K
    #[arg(
        long,
        value_name = "K",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    pub thermometer: f64,
    /// Range within which the expansion is known, µm/(m·K)
    #[arg(
        long,
        value_name = "UM_PER_M_K",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    pub expansion_range: f64,
    /// Range of the drift at rest in the time of the test, µm
    #[arg(
        long,
        value_name = "UM",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    pub drift: f64,
}

/// What is done with the screw table of an axis.
#[derive(Debug, Subcommand)]
pub enum ScrewTableCommand {
    /// Checks a table and saves it on the axis, while it is off; it is in use after a restart, where compensation.screw_table is 1
    Write {
        /// The table, CSV: position_mm,forward_um,backward_um
        #[arg(value_name = "FILE.csv")]
        file: PathBuf,
        /// How it is told
        #[command(flatten)]
        output: JsonArgs,
    },
    /// Reads the table that is saved on the axis
    Read {
        /// The file to write
        #[arg(value_name = "FILE.csv")]
        file: PathBuf,
        /// How it is told
        #[command(flatten)]
        output: JsonArgs,
    },
    /// Erases the table that is saved on the axis, while it is off
    Erase {
        /// Do not ask
        #[arg(long)]
        yes: bool,
        /// How it is told
        #[command(flatten)]
        output: JsonArgs,
    },
}
