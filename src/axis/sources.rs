//! Requests about sources of setpoints, between two ticks.

use super::Axis;
use crate::setpoint::gearing::Gear;
use crate::setpoint::master::Master;
use crate::setpoint::sources::{GearError, SelectError, Source};
use crate::setpoint::thread::{
    SpindleTrouble, ThreadFigures, ThreadOrder, ThreadPhase, ThreadRefusal,
};
use crate::units::Position;

impl Axis<'_> {
    /// Follows another source of setpoints from where the axis stands; it stays selected while the axis is off.
    ///
    /// # Errors
    /// [`SelectError`] while the axis moves or a gear is engaged; what is followed stays.
    pub fn select(&mut self, source: Source) -> Result<(), SelectError> {
        if self.outputs.moving {
            return Err(SelectError::Moving);
        }
        self.sources.select(source)
    }

    /// The source that is followed. One that was lost has given way to planned moves.
    #[must_use]
    pub const fn source(&self) -> Source {
        self.sources.selected()
    }

    /// Engages the gear while the master turns or stands, or disengages it. It locks at the phase that comes of the moment:
    /// see [`gearing`](crate::setpoint::gearing).
    ///
    /// # Errors
    /// [`GearError`]; the gear stays as it is.
    pub fn engage_gear(&mut self, engaged: bool) -> Result<(), GearError> {
        if !self.supervisor.is_following() {
            return Err(GearError::Disabled);
        }
        self.sources.engage(engaged)
    }

    /// How far the gear is engaged.
    #[must_use]
    pub const fn gear(&self) -> Gear {
        self.sources.gear()
    }

    /// Plans a pass of a thread by the spindle as it turns now, and begins to go to its start. Its positions count from the
    /// origin, from 0 d where none is known.
    ///
    /// # Errors
    /// [`ThreadRefusal`] with its figures; nothing moves then.
    pub fn arm_thread(&mut self, order: &ThreadOrder) -> Result<ThreadFigures, ThreadRefusal> {
        if !self.supervisor.is_following() {
            return Err(ThreadRefusal::Disabled);
        }
        if self.outputs.moving {
            return Err(ThreadRefusal::Moving);
        }
        let origin = self.homing.origin().unwrap_or(Position::ZERO);
        let now = self.tick.wrapping_sub(1);
        self.sources.arm_thread(order, origin, now)
    }

    /// How far a pass of a thread has come.
    #[must_use]
    pub const fn thread_phase(&self) -> ThreadPhase {
        self.sources.thread_phase()
    }

    /// What was wrong with the spindle in the last pass.
    #[must_use]
    pub const fn spindle_trouble(&self) -> Option<SpindleTrouble> {
        self.sources.spindle_trouble()
    }

    /// The second encoder.
    #[must_use]
    pub const fn master(&self) -> &Master {
        self.sources.master()
    }
}
