//! Arguments of `sim`.

use std::path::PathBuf;

use clap::Args;

use super::{OutputArgs, SimulatedArgs, estimator_names};

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
