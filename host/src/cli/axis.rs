//! Commands that work on an axis behind `--port`.

use clap::Subcommand;

use super::JsonArgs;

/// What works on an axis.
#[derive(Debug, Subcommand)]
pub enum AxisCommand {
    /// Tells how the axis stands
    Status(JsonArgs),
}
