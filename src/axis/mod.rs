//! The composition: one pure step from what a board saw to what it shall put out.

mod io;

pub use io::{Inputs, Outputs};

use core::fmt;

use crate::capture::{CaptureHealth, Unwrapper};
use crate::compensation::Compensation;
use crate::controller::Controller;
use crate::edges::EdgeReader;
use crate::encoder_map::EncoderMap;
use crate::encoder_map::tie::{MapHealth, MapState};
use crate::estimator::{Estimator, Evidence};
use crate::identification::experiment::{Experiment, Seen};
use crate::identification::program::Program;
use crate::output::Output;
use crate::params::AxisConfig;
use crate::setpoint::profile::Profile;
use crate::setpoint::sources::Sources;
use crate::setpoint::trajectory::QueueError;
use crate::supervisor::{Permit, Review, Situation, State, Supervisor};
use crate::units::Position;

/// An axis slower than this power of two below its largest speed is at rest: an offset of the drive moves it,
/// until it is identified.
const REST_SHIFT: u32 = 5;

/// One axis; `'m` is how long its encoder map lives.
#[derive(Clone, Debug)]
pub struct Axis<'m> {
    unwrapper: Unwrapper,
    edges: EdgeReader<'m>,
    estimator: Estimator,
    supervisor: Supervisor,
    sources: Sources,
    compensation: Compensation,
    controller: Controller,
    output: Output,
    experiment: Option<Experiment>,
    config: AxisConfig,
    /// The tick that comes next.
    tick: u32,
    /// What the last tick gave; before the first one an axis that is off.
    outputs: Outputs,
}

impl<'m> Axis<'m> {
    /// An axis that is not enabled, without an encoder map.
    #[must_use]
    pub fn new(config: AxisConfig) -> Self {
        Self {
            unwrapper: Unwrapper::new(),
            edges: EdgeReader::new(config.edges),
            estimator: Estimator::new(config.estimator),
            supervisor: Supervisor::new(),
            sources: Sources::new(),
            compensation: Compensation::default(),
            controller: Controller::new(config.controller),
            output: Output::new(config.output),
            experiment: None,
            config,
            tick: 0,
            outputs: Outputs::default(),
        }
    }

    /// One tick. Bounded time, no allocation, no panic; call once per sample, in order.
    pub fn step(&mut self, inputs: &Inputs<'_>) -> &Outputs {
        let tick = self.tick;
        self.tick = tick.wrapping_add(1);
        let observation = self.unwrapper.unwrap(&inputs.capture);
        self.edges.note(&observation);
        let position = observation.position();

        // Written in place: a structure of this size is not returned in registers.
        let outputs = &mut self.outputs;
        let was_enabled = outputs.enabled;
        outputs.tick = tick;
        outputs.count = observation.count;
        let command = was_enabled.then(|| self.output.command());
        outputs.estimate = self.estimator.update(&Evidence {
            observation: &observation,
            edges: &self.edges,
            command,
        });

        let permit = self.supervisor.permit(&Situation {
            enable: inputs.enable,
            lines: &inputs.lines,
        });
        let open_loop = self.is_open_loop();
        if open_loop || !(was_enabled && permit > Permit::ZeroVolts) {
            self.begin(position);
        }
        let outputs = &mut self.outputs;
        let commanded = self.sources.step(tick, &inputs.reference, permit);
        outputs.moving = self.sources.is_moving();
        outputs.setpoint = self.compensation.step(&commanded);
        let active = self.output.active_limits();
        let mut demand =
            self.controller
                .step(&outputs.setpoint, position, &outputs.estimate, active);
        outputs.following_error = demand.following_error;
        if let Some(experiment) = &mut self.experiment {
            demand.command = experiment.step(&Seen {
                observation: &observation,
                permit,
                demand: demand.command,
                in_force: self.output.command(),
            });
            outputs.moving |= experiment.ending().is_none();
        }

        let permit = self.supervisor.review(&Review {
            permit,
            moving: outputs.moving,
            trouble: self.sources.trouble(),
            open_loop,
        });
        if let Some(experiment) = &mut self.experiment {
            experiment.review(permit);
        }
        outputs.command = if permit > Permit::ZeroVolts {
            self.output.step(demand.command)
        } else {
            self.output.off()
        };
        outputs.limits = self.output.active_limits();
        outputs.enabled = permit > Permit::Off;
        outputs.brake_released = outputs.enabled;
        outputs.state = self.supervisor.state();
        outputs.fault = self.supervisor.fault();
        outputs.reported = position;
        outputs
    }

    /// Stands where the axis is, with nothing remembered: off, or about to come under control.
    #[cold]
    fn begin(&mut self, position: Position) {
        self.sources.hold(position);
        self.controller.reset();
    }

    /// Queues a planned move to start at tick `start`, counted as in [`Outputs::tick`].
    ///
    /// # Errors
    /// [`QueueError`]; the axis then goes on as it was.
    pub fn queue(&mut self, profile: &Profile, start: u32) -> Result<(), QueueError> {
        if !self.outputs.enabled {
            return Err(QueueError::Disabled);
        }
        self.sources
            .trajectory
            .queue(profile, start, self.tick.wrapping_sub(1))
    }

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
        let fastest = self.config.limits.max_velocity().to_bits().unsigned_abs();
        if speed > fastest >> REST_SHIFT {
            return Err(StartError::NotAtRest);
        }
        self.experiment = Some(Experiment::new(*program));
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
    }

    /// True while an experiment keeps the loop open.
    fn is_open_loop(&self) -> bool {
        let experiment = self.experiment.as_ref();
        experiment.is_some_and(Experiment::is_open_loop)
    }

    /// Takes a new configuration between two ticks. The output goes on without a step; another
    /// estimator starts as after a long motion at the velocity estimated last. The encoder map stays.
    pub fn reconfigure(&mut self, config: AxisConfig) {
        self.edges.reconfigure(config.edges);
        if config.estimator != self.config.estimator {
            self.estimator = Estimator::new(config.estimator);
            self.estimator.prime(self.outputs.estimate.velocity);
        }
        self.controller
            .reconfigure(config.controller, self.output.command());
        self.output.reconfigure(config.output);
        self.config = config;
    }

    /// Takes an encoder map between two ticks, or does without. It waits for the index, even if the one before
    /// was tied.
    pub fn set_map(&mut self, map: Option<EncoderMap<'m>>) {
        self.edges.set_map(map);
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

    /// The configuration in force.
    #[must_use]
    pub const fn config(&self) -> &AxisConfig {
        &self.config
    }

    /// The estimator in the loop.
    #[must_use]
    pub const fn estimator(&self) -> &Estimator {
        &self.estimator
    }

    /// What went wrong at the encoder so far.
    #[must_use]
    pub const fn capture_health(&self) -> CaptureHealth {
        self.unwrapper.health()
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
