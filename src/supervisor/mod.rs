//! What the axis may do, and when it must stop.
//!
//! The supervisor is asked twice a tick: [`Supervisor::permit`] before the setpoint, from what the board
//! reports, and [`Supervisor::review`] after the loop, from what the tick came to. What it says last holds for the
//! output of that very tick.

pub mod fault;

pub use fault::{Fault, Reaction};

use crate::hal::Lines;

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
    /// The axis is to be under control.
    pub enable: bool,
    /// Discrete inputs.
    pub lines: &'a Lines,
}

/// What the supervisor knows after the loop of a tick.
#[derive(Clone, Copy, Debug)]
pub struct Review {
    /// What was permitted before.
    pub permit: Permit,
    /// A motion is commanded.
    pub moving: bool,
    /// What a source of setpoints cannot go on for.
    pub trouble: Option<Fault>,
    /// An experiment keeps the loop open: there is no following error, and the bounds are the experiment's own.
    pub open_loop: bool,
}

/// The supervisor.
#[derive(Clone, Debug, Default)]
pub struct Supervisor {
    state: State,
    fault: Option<Fault>,
}

impl Supervisor {
    /// Disabled, without a fault.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Where it stands.
    #[must_use]
    pub const fn state(&self) -> State {
        self.state
    }

    /// The fault that is latched.
    #[must_use]
    pub const fn fault(&self) -> Option<Fault> {
        self.fault
    }

    /// What may be done in this tick.
    pub fn permit(&mut self, situation: &Situation<'_>) -> Permit {
        if situation.enable {
            self.state = State::Ready;
            Permit::Follow
        } else {
            self.state = State::Disabled;
            Permit::Off
        }
    }

    /// Looks at what the tick came to, and may take back what was permitted.
    pub fn review(&mut self, review: &Review) -> Permit {
        if review.moving && self.state == State::Ready {
            self.state = State::Moving;
        }
        review.permit
    }
}
