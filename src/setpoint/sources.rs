//! The sources of setpoints of an axis, of which one is followed at a time.

use super::Setpoint;
use super::follower::{Config as FollowerConfig, Follower};
use super::profile::Limits;
use super::trajectory::Trajectory;
use crate::hal::Reference;
use crate::supervisor::{Fault, Permit};
use crate::units::{Position, Velocity};

/// All sources.
#[derive(Clone, Debug)]
pub struct Sources {
    /// Planned moves.
    pub trajectory: Trajectory,
    /// Stops whatever moves.
    stop: Follower,
    /// A stop runs, or the axis stands after one; no source is followed until it stands and may.
    stopping: bool,
    last: Setpoint,
}

impl Sources {
    /// Sources that stand at 0 d and stop within `limits`.
    #[must_use]
    pub fn new(limits: &Limits) -> Self {
        Self {
            trajectory: Trajectory::new(),
            stop: Follower::new(FollowerConfig::new(limits)),
            stopping: false,
            last: Setpoint::default(),
        }
    }

    /// Takes other limits for what is not planned.
    pub fn reconfigure(&mut self, limits: &Limits) {
        self.stop.reconfigure(FollowerConfig::new(limits));
    }

    /// Ends all motion and stands at `position`: for an axis that is not under control.
    pub fn hold(&mut self, position: Position) {
        self.trajectory.hold(position);
        self.stop.stand(position);
        self.stopping = false;
        self.last = Setpoint {
            position,
            ..Setpoint::default()
        };
    }

    /// The setpoint of the last tick.
    #[must_use]
    pub const fn last(&self) -> &Setpoint {
        &self.last
    }

    /// The last setpoint came from elsewhere, in motion or at rest: what comes next goes on from there.
    pub fn take_over(&mut self, last: &Setpoint) {
        self.hold(last.position);
        self.last = *last;
    }

    /// True while a motion is commanded; a stop is one until it stands.
    #[must_use]
    pub const fn is_moving(&self) -> bool {
        if self.stopping {
            !self.stop.is_at_rest()
        } else {
            self.trajectory.is_moving()
        }
    }

    /// True while a stop runs, or while it is not yet allowed to move after one.
    #[must_use]
    pub const fn is_stopping(&self) -> bool {
        self.stopping
    }

    /// Why the source cannot be followed any more, found in the last tick.
    #[must_use]
    pub const fn trouble(&self) -> Option<Fault> {
        None
    }

    /// The setpoint of tick `tick`, as far as `permit` lets a source move the axis. A stop begins in the tick in
    /// which it is ordered, from the setpoint before, and goes on to its end whatever is ordered then, except to
    /// hold, which ends it where it is; all sources are dropped by it.
    pub fn step(&mut self, tick: u32, _reference: &Reference<'_>, permit: Permit) -> Setpoint {
        self.last = if permit == Permit::Follow && !self.stopping {
            self.trajectory.step(tick)
        } else {
            self.stop(tick, permit)
        };
        self.last
    }

    #[cold]
    fn stop(&mut self, tick: u32, permit: Permit) -> Setpoint {
        if permit <= Permit::Hold {
            self.hold(self.last.position);
            return self.last;
        }
        if !self.stopping {
            self.stop.take_over(&self.last);
            self.stopping = true;
        } else if permit == Permit::Follow && self.stop.is_at_rest() {
            self.hold(self.last.position);
            return self.trajectory.step(tick);
        }
        self.stop.step(Velocity::ZERO)
    }
}
