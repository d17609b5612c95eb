//! Arguments of `identify` and `autotune`.

use std::path::PathBuf;

use clap::Args;

use super::{BenchArgs, RoomArgs, YesArgs};

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
