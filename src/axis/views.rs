//! What can be asked of an axis between two ticks.

use super::{Axis, Outputs};
use crate::capture::CaptureHealth;
use crate::encoder_map::tie::{MapHealth, MapState};
use crate::estimator::{Estimator, Variances};
use crate::params::AxisConfig;
use crate::supervisor::Supervisor;
use crate::units::Command;

impl Axis<'_> {
    /// The supervisor: the first fault and its context, warnings, the peak of the following error.
    #[must_use]
    pub const fn supervisor(&self) -> &Supervisor {
        &self.supervisor
    }

    /// The same, to report faults found between ticks and to reset warnings and peak.
    pub const fn supervisor_mut(&mut self) -> &mut Supervisor {
        &mut self.supervisor
    }

    /// How far the encoder map can be used; `None` without one.
    #[must_use]
    pub fn map_state(&self) -> Option<MapState> {
        self.edges.map_state()
    }

    /// What the indexes showed since the map was set.
    #[must_use]
    pub fn map_health(&self) -> MapHealth {
        self.edges.map_health()
    }

    /// What the last tick gave.
    #[must_use]
    pub const fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// How uncertain the estimate of the last tick is.
    #[must_use]
    pub fn variances(&self) -> Variances {
        self.estimators.variances(self.edges.noise())
    }

    /// Ticks from queueing a motion from rest to its start, at least 1, that the drive needs to be ready for it: its delay,
    /// and the dead time of a reversal. A motion that is queued later starts as well, but breaks away late.
    #[must_use]
    pub const fn notice_ticks(&self) -> u32 {
        self.config.controller.notice_ticks()
    }

    /// What of the last command an observer of the nominal drive is not told: see
    /// [`Controller::withheld`](crate::controller::Controller::withheld).
    #[must_use]
    pub const fn withheld(&self) -> Command {
        self.controller.withheld()
    }

    /// By which shares the drive asks for more of the feedforward's terms of v, a and j than they give, as learned in motion.
    #[must_use]
    pub fn learned(&self) -> [f64; 3] {
        self.controller.learned()
    }

    /// The configuration in force.
    #[must_use]
    pub const fn config(&self) -> &AxisConfig {
        &self.config
    }

    /// The first estimator.
    #[must_use]
    pub const fn estimator(&self) -> &Estimator {
        self.estimators.first()
    }

    /// What went wrong at the encoder so far.
    #[must_use]
    pub const fn capture_health(&self) -> CaptureHealth {
        self.unwrapper.health()
    }
}
