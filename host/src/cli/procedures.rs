//! Arguments of the guided procedures on an axis.

use std::path::PathBuf;

use clap::Args;

use crate::axis::setup::Step;

/// What needs no question.
#[derive(Clone, Copy, Debug, Args)]
pub struct YesArgs {
    /// Agree to all that is asked, motion and saving included: for scripts, with a free axis and a hand on the emergency stop
    #[arg(long)]
    pub yes: bool,
}

/// Where an axis may go that is not homed, or has no soft limits.
#[derive(Clone, Copy, Debug, Args)]
pub struct RoomArgs {
    /// On an axis that is not homed: free travel to the minus side of where it stands, mm
    #[arg(long, value_name = "MM")]
    pub room_minus: Option<f64>,
    /// The same to the plus side, mm
    #[arg(long, value_name = "MM")]
    pub room_plus: Option<f64>,
}

/// Arguments of `null-offset`.
#[derive(Debug, Args)]
pub struct NullOffsetArgs {
    /// What needs no question
    #[command(flatten)]
    pub yes: YesArgs,
    /// Where the axis may go
    #[command(flatten)]
    pub room: RoomArgs,
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `setup`.
#[derive(Debug, Args)]
pub struct SetupArgs {
    /// What needs no question
    #[command(flatten)]
    pub yes: YesArgs,
    /// Answers to the questions about the machine, NAME = NUMBER each; a question that is not answered there is asked, or with
    /// --yes takes its default
    #[arg(long, value_name = "FILE.toml")]
    pub answers: Option<PathBuf>,
    /// A single answer, over those of the file
    #[arg(long = "set", value_name = "NAME=NUMBER")]
    pub set: Vec<String>,
    /// Leave these steps out
    #[arg(long, value_name = "STEP,…", value_delimiter = ',', value_enum)]
    pub skip: Vec<Step>,
    /// Go on from this step: those before were made in an earlier session, which saved what they found
    #[arg(long, value_name = "STEP", value_enum)]
    pub from: Option<Step>,
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
}
