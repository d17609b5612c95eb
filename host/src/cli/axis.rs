//! Commands that work on an axis behind `--port`.

use clap::Subcommand;

use super::{JsonArgs, NullOffsetArgs, SetupArgs};

/// What works on an axis.
#[derive(Debug, Subcommand)]
pub enum AxisCommand {
    /// Tells how the axis stands
    Status(JsonArgs),
    /// Commissions the axis from factory settings, step by step: polarity, direction, index, drive, loop, encoder, offset
    Setup(SetupArgs),
    /// Measures the offset of the drive and sets the loop against it
    NullOffset(NullOffsetArgs),
}
