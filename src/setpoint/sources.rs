//! The sources of setpoints of an axis, of which one is followed at a time.

mod params;
mod refusal;
mod status;

pub use params::{Config, SourceParams};
pub use refusal::{GearError, SelectError};

use super::Setpoint;
use super::analog::Analog;
use super::follower::{Config as FollowerConfig, Follower};
use super::gearing::{Gear, Gearing};
use super::master::Master;
use super::plan::Plan;
use super::profile::Limits;
use super::step_dir::StepDir;
use super::thread::{Standing, Thread, ThreadFigures, ThreadOrder, ThreadRefusal};
use super::trajectory::{QueueError, Trajectory};
use super::travel::TravelLimits;
use crate::hal::{Capture, Reference};
use crate::supervisor::{Fault, Permit};
use crate::units::{Position, Velocity};

/// Which source is followed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Source {
    /// Planned moves, and passes of threads.
    #[default]
    Trajectory,
    /// Pulses of an outer control.
    StepDir,
    /// The analog velocity command of a legacy control.
    Analog,
    /// A master, by an exact ratio.
    Gearing,
}

/// All sources.
// What every tick needs comes first, as in the axis.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Sources {
    last: Setpoint,
    selected: Source,
    /// A stop runs, or the axis stands after one; no source is followed until it stands and may.
    stopping: bool,
    trouble: Option<Fault>,
    /// Planned moves.
    pub trajectory: Trajectory,
    thread: Thread,
    config: Config,
    limits: Limits,
    step_dir: StepDir,
    analog: Analog,
    gearing: Gearing,
    /// The second encoder.
    master: Master,
    /// Stops whatever moves.
    stop: Follower,
    travel: Option<TravelLimits>,
}

impl Sources {
    /// Sources that stand at 0 d and stop within `limits`.
    #[must_use]
    pub fn new(limits: &Limits, config: &Config) -> Self {
        Self {
            trajectory: Trajectory::new(),
            config: *config,
            limits: *limits,
            selected: Source::Trajectory,
            step_dir: StepDir::new(config.step_dir),
            analog: Analog::new(config.analog, limits),
            gearing: Gearing::new(config.gearing, limits),
            thread: Thread::new(),
            master: Master::new(config.master),
            stop: Follower::new(FollowerConfig::new(limits)),
            stopping: false,
            trouble: None,
            travel: None,
            last: Setpoint::default(),
        }
    }

    /// Takes other limits for what is not planned, and other parameters, which change while the axis stands: a source
    /// that they concern begins anew where it stands.
    pub fn reconfigure(&mut self, limits: &Limits, config: &Config) {
        self.stop.reconfigure(FollowerConfig::new(limits));
        self.analog.reconfigure(config.analog, limits);
        let is_same = *limits == self.limits;
        if !is_same || config.step_dir != self.config.step_dir {
            self.step_dir = StepDir::new(config.step_dir);
            self.step_dir.start(self.last.position);
        }
        if !is_same || config.gearing != self.config.gearing {
            self.gearing = Gearing::new(config.gearing, limits);
            self.gearing.start(self.last.position);
        }
        self.master.reconfigure(config.master);
        (self.config, self.limits) = (*config, *limits);
    }

    /// Takes soft limits of travel, or does without.
    pub const fn set_travel(&mut self, travel: Option<TravelLimits>) {
        self.travel = travel;
    }

    /// The soft limits of travel in force.
    #[must_use]
    pub const fn travel(&self) -> Option<TravelLimits> {
        self.travel
    }

    /// Queues a plan; see [`Trajectory::queue`].
    ///
    /// # Errors
    /// [`QueueError`]; what runs goes on.
    pub fn queue(&mut self, plan: &Plan, start: u32, now: u32) -> Result<(), QueueError> {
        if self.selected != Source::Trajectory {
            return Err(QueueError::OtherSource);
        }
        if self.stopping {
            return Err(QueueError::Stopping);
        }
        let end = self.trajectory.end_of(plan);
        if self.travel.is_some_and(|travel| !travel.contains(end)) {
            return Err(QueueError::BeyondTravel);
        }
        self.trajectory.queue(plan, start, now)
    }

    /// Ends all motion and stands at `position`: for an axis that is not under control.
    pub fn hold(&mut self, position: Position) {
        self.trajectory.hold(position);
        self.thread.end();
        self.stop.stand(position);
        self.stopping = false;
        self.last = Setpoint {
            position,
            ..Setpoint::default()
        };
        self.start();
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

    /// The source that is selected stands where the axis stands.
    fn start(&mut self) {
        let position = self.last.position;
        match self.selected {
            Source::Trajectory => self.trajectory.hold(position),
            Source::StepDir => self.step_dir.start(position),
            Source::Analog => self.analog.start(position),
            Source::Gearing => self.gearing.start(position),
        }
    }

    /// Takes what the second encoder's inputs saw, in every tick and before [`Self::step`].
    #[inline]
    pub fn read_master(&mut self, capture: Option<&Capture<'_>>, is_lost: bool) {
        self.master.step(capture, is_lost);
    }

    /// Follows another source from where the axis stands.
    ///
    /// # Errors
    /// [`SelectError`] while the axis moves or a gear is engaged; what is followed stays.
    pub fn select(&mut self, source: Source) -> Result<(), SelectError> {
        if self.is_moving() || self.stopping {
            return Err(SelectError::Moving);
        }
        if self.selected == Source::Gearing && self.gearing.gear() != Gear::Open {
            return Err(SelectError::Engaged);
        }
        self.selected = source;
        self.start();
        Ok(())
    }

    /// Engages or disengages the gear.
    ///
    /// # Errors
    /// [`GearError`]; the gear stays as it is.
    pub fn engage(&mut self, engaged: bool) -> Result<(), GearError> {
        if self.selected != Source::Gearing {
            return Err(GearError::NotSelected);
        }
        if !self.master.is_present() {
            return Err(GearError::NoSignal);
        }
        if self.stopping || !self.gearing.engage(engaged, &self.master, &self.limits) {
            return Err(GearError::Busy);
        }
        Ok(())
    }

    /// Plans a pass of a thread and begins its approach with the tick after `now`; `origin` is where its users count from.
    ///
    /// # Errors
    /// [`ThreadRefusal`]; nothing moves then.
    pub fn arm_thread(
        &mut self,
        order: &ThreadOrder,
        origin: Position,
        now: u32,
    ) -> Result<ThreadFigures, ThreadRefusal> {
        if self.is_moving() || self.stopping {
            return Err(ThreadRefusal::Moving);
        }
        if self.selected != Source::Trajectory {
            return Err(ThreadRefusal::OtherSource);
        }
        let standing = Standing {
            position: self.last.position,
            origin,
            travel: self.travel,
        };
        let (plan, figures) = self.config.thread.plan(order, &self.master, &standing)?;
        self.trajectory
            .queue(plan.first_leg(), now.wrapping_add(1), now)
            .map_err(|_| ThreadRefusal::Moving)?;
        self.thread.arm(&plan);
        Ok(figures)
    }

    /// The setpoint of tick `tick`, as far as `permit` lets a source move the axis. A stop begins in the tick in
    /// which it is ordered, or in which the source is found lost, from the setpoint before, and goes on to its end whatever is
    /// ordered then, except to hold, which ends it where it is; all sources are dropped by it.
    pub fn step(&mut self, tick: u32, reference: &Reference<'_>, permit: Permit) -> Setpoint {
        self.advance(tick, reference, permit);
        self.last
    }

    /// The same, with the setpoint left in [`Self::last`]; gives true while a motion is commanded.
    // Planned moves first, and short: the others have budgets of their own.
    #[inline(always)]
    pub(crate) fn advance(&mut self, tick: u32, reference: &Reference<'_>, permit: Permit) -> bool {
        let is_planned = self.selected == Source::Trajectory && !self.is_threading();
        if permit == Permit::Follow && !self.stopping && is_planned {
            self.trouble = None;
            self.last = self.trajectory.step(tick);
            self.trajectory.is_moving()
        } else {
            self.advance_else(tick, reference, permit);
            self.is_moving()
        }
    }

    /// The same, where it is likely anything but a planned move that goes on.
    #[inline(never)]
    pub(crate) fn advance_else(&mut self, tick: u32, reference: &Reference<'_>, permit: Permit) {
        self.trouble = None;
        self.last = if permit != Permit::Follow || self.stopping {
            self.stop(tick, reference, permit)
        } else {
            match self.follow(tick, reference) {
                Ok(setpoint) => setpoint,
                Err(fault) => self.lose(tick, fault),
            }
        };
    }

    #[inline(never)]
    fn follow(&mut self, tick: u32, reference: &Reference<'_>) -> Result<Setpoint, Fault> {
        let (setpoint, is_lost) = match self.selected {
            Source::Trajectory if self.is_threading() => {
                return self
                    .thread
                    .step(tick, &self.master, &mut self.trajectory)
                    .map(|setpoint| self.after_thread(setpoint))
                    .ok_or(Fault::SpindleLost);
            }
            Source::Trajectory => (self.trajectory.step(tick), false),
            Source::StepDir => {
                let setpoint = self.step_dir.step(reference.steps);
                (setpoint, self.step_dir.is_lost())
            }
            Source::Analog => (self.analog.step(reference.analog), false),
            Source::Gearing => {
                let setpoint = self.gearing.step(&self.master);
                (setpoint, self.gearing.is_lost())
            }
        };
        if is_lost {
            return Err(Fault::SetpointLost);
        }
        match &self.travel {
            // A plan was refused if it ends beyond.
            Some(travel) if self.selected != Source::Trajectory => {
                travel.guard(self.stop.config(), setpoint)
            }
            _ => Ok(setpoint),
        }
    }

    /// Planned moves go on from where a pass of a thread ended.
    #[inline]
    fn after_thread(&mut self, setpoint: Setpoint) -> Setpoint {
        if !self.is_threading() {
            self.trajectory.hold(setpoint.position);
        }
        setpoint
    }

    /// What is lost is not followed again until it is selected anew.
    #[cold]
    fn lose(&mut self, tick: u32, fault: Fault) -> Setpoint {
        self.trouble = Some(fault);
        self.selected = Source::Trajectory;
        self.stop(tick, &Reference::default(), Permit::Stop)
    }

    #[cold]
    fn stop(&mut self, tick: u32, reference: &Reference<'_>, permit: Permit) -> Setpoint {
        if permit <= Permit::Hold {
            self.hold(self.last.position);
            return self.last;
        }
        if !self.stopping {
            self.stop.take_over(&self.last);
            self.stopping = true;
            self.thread.end();
        } else if permit == Permit::Follow && self.stop.is_at_rest() {
            self.hold(self.last.position);
            return self.follow(tick, reference).unwrap_or(self.last);
        }
        self.stop.step(Velocity::ZERO)
    }
}
