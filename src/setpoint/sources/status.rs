//! What the sources are doing.

use super::{Source, Sources};
use crate::setpoint::gearing::Gear;
use crate::setpoint::master::Master;
use crate::setpoint::thread::{SpindleTrouble, ThreadPhase};
use crate::supervisor::Fault;

impl Sources {
    /// True while a motion is commanded; a stop is one until it stands, a pass of a thread from its beginning to its end.
    #[must_use]
    pub const fn is_moving(&self) -> bool {
        if self.stopping {
            return !self.stop.is_at_rest();
        }
        match self.selected {
            Source::Trajectory => self.trajectory.is_moving() || self.is_threading(),
            Source::StepDir => self.step_dir.is_moving(),
            Source::Analog => self.analog.is_moving(),
            Source::Gearing => self.gearing.is_moving(),
        }
    }

    /// True while a pass of a thread is under way, its approach included.
    #[must_use]
    pub const fn is_threading(&self) -> bool {
        !matches!(self.thread.phase(), ThreadPhase::Idle)
    }

    /// True while another parameter would move the axis: in a pass of a thread, with a gear that is not open, and in motion by
    /// pulses or an analog command.
    #[must_use]
    pub const fn is_tied(&self) -> bool {
        match self.selected {
            Source::Trajectory => self.is_threading(),
            Source::Gearing => !matches!(self.gearing.gear(), Gear::Open),
            Source::StepDir | Source::Analog => self.is_moving(),
        }
    }

    /// True while a stop runs, or while it is not yet allowed to move after one.
    #[must_use]
    pub const fn is_stopping(&self) -> bool {
        self.stopping
    }

    /// Why the source cannot be followed any more, found in the last tick. A stop has then begun, and planned moves
    /// are selected.
    #[must_use]
    pub const fn trouble(&self) -> Option<Fault> {
        self.trouble
    }

    /// The source that is selected.
    #[must_use]
    pub const fn selected(&self) -> Source {
        self.selected
    }

    /// How far a pass of a thread has come.
    #[must_use]
    pub const fn thread_phase(&self) -> ThreadPhase {
        self.thread.phase()
    }

    /// What was wrong with the spindle in the last pass.
    #[must_use]
    pub const fn spindle_trouble(&self) -> Option<SpindleTrouble> {
        self.thread.trouble()
    }

    /// The tool is to be retracted.
    #[must_use]
    pub const fn retract(&self) -> bool {
        self.thread.retract()
    }

    /// How far the gear is engaged.
    #[must_use]
    pub const fn gear(&self) -> Gear {
        self.gearing.gear()
    }

    /// The second encoder.
    #[must_use]
    pub const fn master(&self) -> &Master {
        &self.master
    }
}
