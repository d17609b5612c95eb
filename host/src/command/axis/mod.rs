//! Commands that work on an axis behind a port. Ctrl-C stops the axis first.

mod autotune;
pub mod bode;
mod calibrate_encoder;
mod changes;
mod confirm;
pub mod counters;
pub mod faults;
mod identify;
pub mod identity;
mod interrupt;
pub mod monitor;
pub mod motion;
mod null_offset;
pub mod params;
mod person;
pub mod probe;
pub mod record;
pub mod recording;
pub mod run;
pub mod scope;
pub mod screw_table;
pub mod serve;
mod setup;
pub mod status;

use leadscrew::protocol::refusal::Refusal;
use leadscrew_client::{Axis, Error};

use crate::axis::{PortArgs, open};
use crate::cli::{AutotuneArgs, AxisCommand, CalibrateEncoderArgs, IdentifyArgs};
use crate::error::CommandError;

/// Runs a command on the axis.
///
/// # Errors
/// No axis, or what the command's job ends with.
pub fn run(port: &PortArgs, command: &AxisCommand) -> Result<(), CommandError> {
    let interrupted = interrupt::flag()?;
    // What is wrong with a script is told before any axis is switched on.
    let script = match command {
        AxisCommand::Run(args) => Some(crate::axis::script::Script::read(&args.script)?),
        AxisCommand::Serve(args) => return serve::run(port, args, &interrupted),
        AxisCommand::Move(args) => motion::check_move(args).map(|()| None)?,
        AxisCommand::Probe(args) => probe::check(args).map(|()| None)?,
        AxisCommand::Override(args) => motion::percent(args).map(|_| None)?,
        AxisCommand::Jog(args) => motion::time(args).map(|_| None)?,
        AxisCommand::Params(command) => params::check(command).map(|()| None)?,
        AxisCommand::ScrewTable(command) => screw_table::check(command).map(|_| None)?,
        _ => None,
    };
    let mut axis = open(port, &interrupted)?;
    let done = match (command, &script) {
        (AxisCommand::Run(args), Some(script)) => run::run(&mut axis, args, script),
        _ => on(&mut axis, command),
    };
    done.map_err(|error| off_between_commands(error, port))
}

fn on(axis: &mut Axis, command: &AxisCommand) -> Result<(), CommandError> {
    match command {
        AxisCommand::Status(args) => status::run(axis, args),
        AxisCommand::Identity(args) => identity::run(axis, args),
        AxisCommand::Faults(args) => faults::run(axis, args),
        AxisCommand::Clear(args) => faults::clear(axis, args),
        AxisCommand::Enable(args) => motion::enable(axis, args),
        AxisCommand::Disable(args) => motion::disable(axis, args),
        AxisCommand::Home(args) => motion::home(axis, args),
        AxisCommand::Move(args) => motion::go(axis, args),
        AxisCommand::Probe(args) => probe::run(axis, args),
        AxisCommand::Jog(args) => motion::jog(axis, args),
        AxisCommand::Hold(args) => motion::hold(axis, args),
        AxisCommand::Resume(args) => motion::resume(axis, args),
        AxisCommand::Stop(args) => motion::stop(axis, args),
        AxisCommand::Override(args) => motion::set_override(axis, args),
        AxisCommand::Counters(args) => counters::run(axis, args),
        AxisCommand::Restart(args) => motion::restart(axis, args),
        AxisCommand::Params(command) => params::run(axis, command),
        AxisCommand::ScrewTable(command) => screw_table::run(axis, command),
        AxisCommand::Setup(args) => setup::run(axis, args),
        AxisCommand::NullOffset(args) => null_offset::run(axis, args),
        AxisCommand::Scope(args) => scope::run(axis, args),
        AxisCommand::Record(args) => record::run(axis, args),
        AxisCommand::Monitor => monitor::run(axis),
        AxisCommand::Bode(args) => bode::run(axis, args),
        // Those that need more than an axis.
        AxisCommand::Run(_) | AxisCommand::Serve(_) => Ok(()),
    }
}

/// Tells who moves an axis that each command switches on anew, and finds it off, how to keep it on.
fn off_between_commands(error: CommandError, port: &PortArgs) -> CommandError {
    let Some(port @ ("sim" | "qemu")) = port.port.as_deref() else {
        return error;
    };
    match error {
        CommandError::Axis(Error::Refused(mut refused))
            if matches!(
                refused.refusal(),
                Some(Refusal::NotEnabled | Refusal::NotReady)
            ) =>
        {
            refused.detail = format!(
                "Every command with --port {port} switches its axis on anew: give orders in a script (`leadscrew run`), \
                 or to one that goes on running (`leadscrew serve`)."
            );
            CommandError::Axis(Error::Refused(refused))
        }
        error => error,
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
/// As of [`fn@run`].
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
