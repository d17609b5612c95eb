//! What the supervisor is asked, and what it answers.

use super::fault::Fault;
use crate::capture::Observation;
use crate::estimator::Estimate;
use crate::hal::Lines;
use crate::output::ActiveLimits;
use crate::setpoint::Setpoint;
use crate::units::Command;

/// State of the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum State {
    /// The drive is off.
    #[default]
    Disabled = 0,
    /// The drive is enabled, but not ready yet, or the brake not yet released.
    Enabling = 1,
    /// Under control, at rest.
    Ready = 2,
    /// Under control, in motion.
    Moving = 3,
    /// In a controlled stop, or between the brake and the end of enable.
    Stopping = 4,
    /// Stopped by a fault, until it is cleared.
    Fault = 5,
}

/// What the axis may do in a tick, from the least to the most.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Permit {
    /// Drive off.
    #[default]
    Off,
    /// 0 V to an enabled drive, which brakes by its own loop; ours is open.
    ZeroVolts,
    /// The loop holds the axis where it stands.
    Hold,
    /// The loop follows a controlled stop, and holds from its end.
    Stop,
    /// The loop follows its source.
    Follow,
}

/// What the supervisor knows before the setpoint of a tick.
#[derive(Clone, Copy, Debug)]
pub struct Situation<'a> {
    /// The tick.
    pub tick: u32,
    /// The axis is to be under control.
    pub enable: bool,
    /// Discrete inputs.
    pub lines: &'a Lines,
    /// Illegal transitions of the encoder in this tick.
    pub illegal: u16,
    /// Ticks missed before this one.
    pub missed_ticks: u16,
    /// What the converter says it puts out.
    pub readback: Option<Command>,
    /// What it was told last.
    pub told: Command,
}

/// What the converter was told, and what it says it puts out.
#[derive(Clone, Copy, Debug)]
pub struct Loopback {
    /// What it says.
    pub readback: Option<Command>,
    /// What it was told.
    pub told: Command,
}

/// What the supervisor knows after the loop of a tick.
#[derive(Clone, Copy, Debug)]
pub struct Review<'a> {
    /// What was permitted before.
    pub permit: Permit,
    /// The tick.
    pub tick: u32,
    /// A motion is commanded.
    pub moving: bool,
    /// What a source of setpoints cannot go on for.
    pub trouble: Option<Fault>,
    /// Discrete inputs.
    pub lines: &'a Lines,
    /// The count and the index.
    pub observation: &'a Observation<'a>,
    /// Where the axis is.
    pub estimate: &'a Estimate,
    /// Where it should be.
    pub setpoint: &'a Setpoint,
    /// Setpoint less position, Q15.16 d.
    pub following_error: i32,
    /// The command of the tick before.
    pub told: Command,
    /// The limits that held it back.
    pub active: ActiveLimits,
    /// An experiment keeps the loop open: the setpoint stands where the axis is, and whether the axis moves against its
    /// command is for the experiment to find out, within its own bounds.
    pub open_loop: bool,
}

/// What the monitors judge, of a [`Review`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Judged<'a> {
    pub permit: Permit,
    pub tick: u32,
    pub trouble: Option<Fault>,
    pub lines: &'a Lines,
    pub observation: &'a Observation<'a>,
    /// Estimated, Q11.20 d/tick.
    pub velocity: i32,
    /// Of the setpoint, Q11.20 d/tick.
    pub commanded: i32,
    /// Q15.16 d.
    pub following_error: i32,
    /// Q.30 of full command.
    pub told: i32,
    pub active: ActiveLimits,
    pub open_loop: bool,
}
