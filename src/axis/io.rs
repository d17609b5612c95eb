//! What goes into a tick of the axis and what comes out.

use crate::controller::FollowingError;
use crate::estimator::Estimate;
use crate::hal::{Capture, Lines, Reference};
use crate::output::ActiveLimits;
use crate::setpoint::Setpoint;
use crate::supervisor::{Fault, FaultSet, State};
use crate::units::{Command, Position};

/// What a tick takes in.
#[derive(Clone, Copy, Debug, Default)]
pub struct Inputs<'a> {
    /// What the encoder inputs saw.
    pub capture: Capture<'a>,
    /// The axis is to be under control.
    pub enable: bool,
    /// Discrete inputs.
    pub lines: Lines,
    /// What an outer control or a second encoder gives.
    pub reference: Reference<'a>,
    /// What the output converter says it puts out, where it can be read back.
    pub readback: Option<Command>,
    /// Ticks that were missed since the last step.
    pub missed_ticks: u16,
}

impl<'a> Inputs<'a> {
    /// A capture at a machine where all is well and no outer control commands.
    #[must_use]
    pub fn of(capture: Capture<'a>, enable: bool) -> Self {
        Self {
            capture,
            enable,
            ..Self::default()
        }
    }
}

/// What a tick gives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Number of the tick, from 0; wraps.
    pub tick: u32,
    /// Count without wrap.
    pub count: i64,
    /// Command to the drive; zero while not under control.
    pub command: Command,
    /// The drive is to be enabled.
    pub enabled: bool,
    /// The brake is to be released.
    pub brake_released: bool,
    /// A motion is commanded.
    pub moving: bool,
    /// The tool is to be retracted: a pass of a thread nears its end.
    pub retract: bool,
    /// Where the supervisor stands.
    pub state: State,
    /// The fault that brought the axis to [`State::Fault`].
    pub fault: Option<Fault>,
    /// Warnings since they were last cleared.
    pub warnings: FaultSet,
    /// Enable is asked for anew and refused: a fault is latched.
    pub refused: bool,
    /// Limits that hold the command back.
    pub limits: ActiveLimits,
    /// Setpoint less measured position, d.
    pub following_error: FollowingError,
    /// Where the axis is, by the encoder.
    pub estimate: Estimate,
    /// Where it should be, by the encoder: compensation included.
    pub setpoint: Setpoint,
    /// Where the axis is for its users, d: from the origin, compensation taken out.
    pub reported: Position,
}
