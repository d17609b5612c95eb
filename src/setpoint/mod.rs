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
}
