//! Commands that work on an axis behind a port. Ctrl-C stops the axis first.

mod autotune;
mod calibrate_encoder;
mod changes;
mod identify;
mod interrupt;
mod null_offset;
mod person;
mod setup;
pub mod status;

use crate::axis::{PortArgs, open};
use crate::cli::{AutotuneArgs, AxisCommand, CalibrateEncoderArgs, IdentifyArgs};
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
        AxisCommand::Setup(args) => setup::run(&mut axis, args),
        AxisCommand::NullOffset(args) => null_offset::run(&mut axis, args),
    }
}

/// A command that works without an axis as well.
#[derive(Clone, Copy, Debug)]
pub enum OnAxis<'a> {
    /// `identify`.
    Identify(&'a IdentifyArgs),
    /// `autotune`.
    Autotune(&'a AutotuneArgs),
    /// `calibrate-encoder`.
    CalibrateEncoder(&'a CalibrateEncoderArgs),
}

/// Runs such a command on the axis.
///
/// # Errors
/// As of [`run`].
pub fn run_on_axis(port: &PortArgs, command: OnAxis<'_>) -> Result<(), CommandError> {
    let interrupted = interrupt::flag()?;
    let mut axis = open(port, &interrupted)?;
    let name = port.port.as_deref().unwrap_or_default();
    match command {
        OnAxis::Identify(args) => identify::run(&mut axis, name, args),
        OnAxis::Autotune(args) => autotune::run(&mut axis, name, args),
        OnAxis::CalibrateEncoder(args) => calibrate_encoder::run(&mut axis, args),
    }
}
