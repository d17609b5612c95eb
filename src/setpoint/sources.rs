//! The sources of setpoints of an axis, of which one is followed at a time.

use super::Setpoint;
use super::trajectory::Trajectory;
use crate::hal::Reference;
use crate::supervisor::{Fault, Permit};
use crate::units::Position;

/// All sources.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    /// Planned moves.
    pub trajectory: Trajectory,
}

impl Sources {
    /// Sources that stand at 0 d.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Ends all motion and stands at `position`: for an axis that is not under control.
    pub fn hold(&mut self, position: Position) {
        self.trajectory.hold(position);
    }

    /// True while a motion is commanded.
    #[must_use]
    pub const fn is_moving(&self) -> bool {
        self.trajectory.is_moving()
    }

    /// Why the source cannot be followed any more, found in the last tick.
    #[must_use]
    pub const fn trouble(&self) -> Option<Fault> {
        None
    }

    /// The setpoint of tick `tick`, as far as `permit` lets a source move the axis.
    pub fn step(&mut self, tick: u32, _reference: &Reference<'_>, _permit: Permit) -> Setpoint {
        self.trajectory.step(tick)
    }
}
