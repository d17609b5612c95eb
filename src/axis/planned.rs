//! Requests about planned motion and travel, between two ticks.

use super::Axis;
use crate::setpoint::Setpoint;
use crate::setpoint::plan::Plan;
use crate::setpoint::trajectory::QueueError;
use crate::setpoint::travel::TravelLimits;

impl Axis<'_> {
    /// Queues a plan to start at tick `start`, counted as in [`Outputs::tick`](super::Outputs::tick). A plan from a
    /// state of motion is dropped at its start unless that is the state then; see [`Self::dropped_plans`].
    ///
    /// # Errors
    /// [`QueueError`]; the axis then goes on as it was.
    pub fn queue(&mut self, plan: &Plan, start: u32) -> Result<(), QueueError> {
        if !self.supervisor.is_following() {
            return Err(QueueError::Disabled);
        }
        if self.homing.is_active() || self.probe.is_active() || self.sources.is_threading() {
            return Err(QueueError::Busy);
        }
        self.sources.queue(plan, start, self.tick.wrapping_sub(1))
    }

    /// Plans that were dropped at their start, since the axis was made; wraps.
    #[must_use]
    pub const fn dropped_plans(&self) -> u32 {
        self.sources.trajectory.dropped()
    }

    /// The setpoint of the last tick before compensation: a planner begins at its position.
    #[must_use]
    pub const fn commanded(&self) -> &Setpoint {
        self.sources.last()
    }

    /// Takes soft limits of travel in raw encoder d between two ticks, or does without. They are given up with the
    /// origin: when homing begins, and when the place of the axis is lost.
    pub const fn set_travel(&mut self, travel: Option<TravelLimits>) {
        self.sources.set_travel(travel);
    }

    /// The soft limits of travel in force.
    #[must_use]
    pub const fn travel(&self) -> Option<TravelLimits> {
        self.sources.travel()
    }
}
