//! Arguments of `probe` and `calibrate-probe`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::JsonArgs;

/// Arguments of `probe`.
#[derive(Debug, Args)]
pub struct ProbeArgs {
    /// How far to go for a touch, mm from the origin; from where the encoder counts while none is known
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub towards: f64,
    /// Feed until the touch, mm/min
    #[arg(long, value_name = "MM_PER_MIN", allow_negative_numbers = true)]
    pub feed: f64,
    /// How far back after a touch, mm
    #[arg(
        long,
        value_name = "MM",
        default_value_t = 1.0,
        allow_negative_numbers = true
    )]
    pub retract: f64,
    /// Touch so many times
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=10_000))]
    pub repeat: u16,
    /// Enable the axis before, and disable it after
    #[arg(long)]
    pub enable: bool,
    /// Write a row a touch to FILE, for `calibrate-probe delay`
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// How it is told
    #[command(flatten)]
    pub output: JsonArgs,
}

/// What of a probe is calibrated.
#[derive(Debug, Subcommand)]
pub enum CalibrateProbeCommand {
    /// Trigger delay, from touches of one surface at two speeds or more
    Delay {
        /// Tables with velocity_mm_per_min and position_mm, as `probe --csv` writes them
        #[arg(required = true, value_name = "FILE.csv")]
        files: Vec<PathBuf>,
        /// How
        #[command(flatten)]
        how: FitArgs,
    },
    /// Effective radius and pre-travel by direction, from touches of a ring, a boss or a sphere
    Stylus {
        /// Table with x_mm, y_mm and, for a sphere, z_mm: the middle of the stylus at each trigger
        #[arg(value_name = "FILE.csv")]
        file: PathBuf,
        /// Diameter of the ring that is touched within, mm
        #[arg(long, value_name = "MM", required_unless_present_any = ["boss", "sphere"], conflicts_with_all = ["boss", "sphere"], allow_negative_numbers = true)]
        ring: Option<f64>,
        /// Diameter of the boss that is touched from outside, mm
        #[arg(
            long,
            value_name = "MM",
            conflicts_with = "sphere",
            allow_negative_numbers = true
        )]
        boss: Option<f64>,
        /// Diameter of the sphere, mm
        #[arg(long, value_name = "MM", allow_negative_numbers = true)]
        sphere: Option<f64>,
        /// Highest order of the lobes that is sought, 2 to 12; 0 for a radius alone
        #[arg(long, value_name = "K", default_value_t = 3)]
        orders: u32,
        /// Radius of the stylus's ball, mm, for the pre-travel in the table
        #[arg(long, value_name = "MM", allow_negative_numbers = true)]
        ball_radius: Option<f64>,
        /// How
        #[command(flatten)]
        how: FitArgs,
    },
    /// Run-out of the stylus, from touches before and after the spindle is turned by 180°
    RunOut {
        /// Table with along (x or y), angle_deg, position_mm and maybe surface
        #[arg(value_name = "FILE.csv")]
        file: PathBuf,
        /// How
        #[command(flatten)]
        how: FitArgs,
    },
}

/// How a calibration is fitted and told.
#[derive(Debug, Args)]
pub struct FitArgs {
    /// Leave touches out that do not fit the others; they are named either way
    #[arg(long)]
    pub without_outliers: bool,
    /// How it is told
    #[command(flatten)]
    pub output: JsonArgs,
}
