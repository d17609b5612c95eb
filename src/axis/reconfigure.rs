//! Another configuration, and what of it cannot change while the axis moves.

use core::fmt;

use super::Axis;
use crate::estimator::observer::Gains;
use crate::params::AxisConfig;

impl Axis<'_> {
    /// Takes a new configuration between two ticks. The output goes on without a step, what jumps is let in by
    /// the controller's transfer term; another estimator starts as after a long motion at the velocity
    /// estimated last. The encoder map stays. Solves for an observer's gains, which takes longer than a tick.
    ///
    /// # Errors
    /// [`ReconfigureError`] for what would move the axis while it is in motion under control; nothing is changed then.
    pub fn reconfigure(&mut self, config: &AxisConfig) -> Result<(), ReconfigureError> {
        self.reconfigure_with(config, &config.estimators.gains())
    }

    /// The same in the tick, with the [gains](crate::estimator::paths::Config::gains) that were solved for before.
    ///
    /// # Errors
    /// As [`Self::reconfigure`].
    pub fn reconfigure_with(
        &mut self,
        config: &AxisConfig,
        gains: &Gains,
    ) -> Result<(), ReconfigureError> {
        if self.outputs.enabled && self.outputs.moving {
            ReconfigureError::check(&self.config, config)?;
        }
        if self.sources.is_tied() && config.sources != self.config.sources {
            return Err(ReconfigureError::Sources);
        }
        self.edges.reconfigure(config.edges);
        if config.estimators != self.config.estimators {
            let velocity = self.outputs.estimate.velocity;
            self.estimators
                .reconfigure(&config.estimators, gains, velocity);
        }
        self.controller
            .reconfigure(config.controller, self.output.command());
        self.output.reconfigure(config.output);
        self.supervisor.reconfigure(config.supervisor);
        self.sources.reconfigure(&config.limits, &config.sources);
        self.compensation.reconfigure(config.compensation);
        self.homing.reconfigure(config.homing);
        self.probe.reconfigure(config.probe);
        let is_travel_new = config.travel != self.config.travel;
        self.config = *config;
        if is_travel_new {
            self.count_from(self.homing.origin());
        }
        Ok(())
    }
}

/// A change that was refused because the axis moves: stop it first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReconfigureError {
    /// Counts in a mm or ticks in a second: the move that runs was planned in others.
    Scale,
    /// The edge timer: times in one clock would be taken for times in another.
    EdgeTimer,
    /// Which estimators there are and which paths they serve: the fed back position would jump.
    Estimators,
    /// Ratios, the second encoder or the limits of what follows them: the setpoint would jump.
    Sources,
}

impl ReconfigureError {
    /// Compares what is in force with what is to come.
    ///
    /// # Errors
    /// The first difference that cannot be made in motion.
    pub(super) fn check(now: &AxisConfig, next: &AxisConfig) -> Result<(), Self> {
        if now.scale != next.scale {
            Err(Self::Scale)
        } else if now.edges.scale != next.edges.scale {
            Err(Self::EdgeTimer)
        } else if now.estimators.differs_in_kind(&next.estimators) {
            Err(Self::Estimators)
        } else {
            Ok(())
        }
    }
}

impl fmt::Display for ReconfigureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self {
            Self::Scale => "counts_per_mm and tick_hz",
            Self::EdgeTimer => "timer_hz",
            Self::Estimators => "the estimators and their paths",
            Self::Sources => "sources of setpoints and the limits of motion",
        };
        write!(
            f,
            "{what} cannot change while the axis moves: stop it first"
        )
    }
}

impl core::error::Error for ReconfigureError {}
