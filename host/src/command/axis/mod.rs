//! Commands that work on an axis behind a port. Ctrl-C stops the axis first.

mod interrupt;
pub mod status;

use crate::axis::{PortArgs, open};
use crate::cli::AxisCommand;
use crate::error::CommandError;

/// Runs a command on the axis.
///
/// # Errors
/// No axis, or what the command's job ends with.
pub fn run(port: &PortArgs, command: &AxisCommand) -> Result<(), CommandError> {
    let interrupted = interrupt::flag()?;
    let mut axis = open(port, &interrupted)?;
    match command {
        AxisCommand::Status(args) => status::run(&mut axis, args),
    }
}
