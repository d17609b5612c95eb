//! Experiments of identification on the axis, between two ticks.

use core::fmt;

use super::Axis;
use crate::capture::Observation;
use crate::identification::experiment::{Experiment, Seen};
use crate::identification::program::Program;
use crate::supervisor::{Permit, State};
use crate::units::Command;

/// An axis slower than this power of two below its largest speed is at rest: an offset of the drive moves it,
/// until it is identified.
const REST_SHIFT: u32 = 5;

impl Axis<'_> {
    /// Begins an experiment with the next tick, in place of one that has ended.
    ///
    /// # Errors
    /// [`StartError`]; the axis then goes on as it was.
    pub fn start_experiment(&mut self, program: &Program) -> Result<(), StartError> {
        let running = |experiment: &Experiment| experiment.ending().is_none();
        if self.experiment.as_ref().is_some_and(running) {
            return Err(StartError::Running);
        }
        if self.outputs.moving {
            return Err(StartError::Moving);
        }
        // A state that still says moving is that of a motion whose last tick this was.
        let is_ready = matches!(self.outputs.state, State::Ready | State::Moving);
        if !(self.outputs.enabled && is_ready) {
            return Err(StartError::NotReady);
        }
        let speed = self.outputs.estimate.velocity.to_bits().unsigned_abs();
        let fastest = self.config.limits.velocity().to_bits().unsigned_abs();
        if speed > fastest >> REST_SHIFT {
            return Err(StartError::NotAtRest);
        }
        self.experiment = Some(Experiment::new(*program));
        self.has_experiment = true;
        Ok(())
    }

    /// The experiment under way, or the one that ended and was not released yet.
    #[must_use]
    pub const fn experiment(&self) -> Option<&Experiment> {
        self.experiment.as_ref()
    }

    /// Ends an experiment with the next tick: an open loop's command goes to zero and stays there.
    pub const fn abort_experiment(&mut self) {
        if let Some(experiment) = &mut self.experiment {
            experiment.abort();
        }
    }

    /// Gives the axis back to its loop, which holds it where it stands. One under way is dropped.
    pub fn release_experiment(&mut self) {
        self.experiment = None;
        self.has_experiment = false;
    }

    /// A tick of the experiment: it says what the drive is told instead of `command`, or with it.
    #[inline(never)]
    pub(super) fn step_experiment(
        &mut self,
        observation: &Observation<'_>,
        permit: Permit,
        command: &mut Command,
    ) {
        if let Some(experiment) = &mut self.experiment {
            *command = experiment.step(&Seen {
                observation,
                errors: self.edges.last_errors(),
                permit,
                demand: *command,
                in_force: self.output.command(),
            });
            self.outputs.moving |= experiment.ending().is_none();
        }
    }

    /// Ends the experiment where its permit was taken back.
    #[inline(never)]
    pub(super) fn review_experiment(&mut self, permit: Permit) {
        if let Some(experiment) = &mut self.experiment {
            experiment.review(permit);
        }
    }

    /// True while an experiment keeps the loop open.
    pub(super) fn is_open_loop(&self) -> bool {
        let experiment = self.experiment.as_ref();
        experiment.is_some_and(Experiment::is_open_loop)
    }
}

/// Why an experiment was not begun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartError {
    /// The axis is not enabled and ready.
    NotReady,
    /// A motion is commanded.
    Moving,
    /// The axis moves at zero command.
    NotAtRest,
    /// Another experiment runs.
    Running,
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotReady => "the axis is not ready: enable it, clear its fault",
            Self::Moving => "the axis moves: stop it first",
            Self::NotAtRest => {
                "the axis moves at zero command: set the offset of the drive so that it stands"
            }
            Self::Running => "another experiment runs: wait for its end, or abort it",
        })
    }
}

impl core::error::Error for StartError {}
