//! Where the axis should be: sources of setpoints.
//!
//! [`plan`] plans a motion outside the tick, [`trajectory`] evaluates the plan in the tick.
//! [`follower`] goes to a velocity within limits of acceleration and jerk without a plan: for stops and for sources
//! that others move. [`sources`] chooses.

pub mod analog;
pub mod follower;
pub mod gearing;
pub mod limits;
pub mod master;
pub mod plan;
pub mod planner;
pub mod profile;
pub mod ratio;
pub mod run_up;
pub mod sources;
pub mod step_dir;
pub mod thread;
pub mod trajectory;
pub mod travel;

use crate::units::{Acceleration, Jerk, Position, Velocity};

/// Where the axis should be at a tick, with the derivatives that the feedforward needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Setpoint {
    /// Position, d.
    pub position: Position,
    /// Velocity, d/tick.
    pub velocity: Velocity,
    /// Acceleration, d/tick².
    pub acceleration: Acceleration,
    /// Jerk in force from this tick to the next, d/tick³; saturates at the range of its format.
    pub jerk: Jerk,
    /// What comes after that jerk.
    pub turn: Turn,
}

/// When the jerk of a setpoint changes next, as far as its source knows: a command acts some ticks after it is given,
/// and is meant for the motion of then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turn {
    /// Ticks for which the jerk stays as it is.
    pub ticks: u32,
    /// The jerk after them, d/tick³.
    pub jerk: Jerk,
}

impl Turn {
    /// Farthest that a source need look ahead, ticks.
    pub const HORIZON: u32 = 64;
    /// Not before the horizon, or not known.
    pub const NONE: Self = Self {
        ticks: u32::MAX,
        jerk: Jerk::ZERO,
    };
}

impl Default for Turn {
    fn default() -> Self {
        Self::NONE
    }
}
