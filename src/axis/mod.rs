//! The composition: one pure step from what a board saw to what it shall put out.

mod io;
mod reconfigure;

pub use io::{Inputs, Outputs};
pub use reconfigure::ReconfigureError;

use crate::capture::{CaptureHealth, Unwrapper};
use crate::compensation::Compensation;
use crate::controller::Controller;
use crate::edges::EdgeReader;
use crate::encoder_map::EncoderMap;
use crate::encoder_map::tie::{MapHealth, MapState};
use crate::estimator::paths::Estimators;
use crate::estimator::{Estimator, Evidence};
use crate::output::Output;
use crate::params::AxisConfig;
use crate::setpoint::profile::Profile;
use crate::setpoint::sources::Sources;
use crate::setpoint::trajectory::QueueError;
use crate::supervisor::{Permit, Review, Situation, Supervisor};
use crate::units::{Command, Position};

/// One axis; `'m` is how long its encoder map lives.
#[derive(Clone, Debug)]
pub struct Axis<'m> {
    unwrapper: Unwrapper,
    edges: EdgeReader<'m>,
    estimators: Estimators,
    supervisor: Supervisor,
    sources: Sources,
    compensation: Compensation,
    controller: Controller,
    output: Output,
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
            estimators: Estimators::new(&config.estimators),
            supervisor: Supervisor::new(),
            sources: Sources::new(),
            compensation: Compensation::default(),
            controller: Controller::new(config.controller),
            output: Output::new(config.output),
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

        // Written in place: a structure of this size is not returned in registers.
        let outputs = &mut self.outputs;
        let was_enabled = outputs.enabled;
        outputs.tick = tick;
        outputs.count = observation.count;
        // What goes against friction does not move the drive that an observer counts on.
        let command =
            was_enabled.then(|| (self.output.command()).saturating_sub(self.controller.friction()));
        let mut evidence = Evidence {
            observation: &observation,
            edges: &self.edges,
            sample: None,
            command,
        };
        self.estimators.update(&mut evidence, &mut outputs.estimate);
        let (_, position) = self
            .estimators
            .feedback(&outputs.estimate, observation.position());

        let permit = self.supervisor.permit(&Situation {
            enable: inputs.enable,
            lines: &inputs.lines,
        });
        if !(was_enabled && permit > Permit::ZeroVolts) {
            self.begin(position);
        }
        let outputs = &mut self.outputs;
        let commanded = self.sources.step(tick, &inputs.reference, permit);
        outputs.moving = self.sources.is_moving();
        outputs.setpoint = self.compensation.step(&commanded);
        let active = self.output.active_limits();
        let (estimate, position) = self.estimators.feedback(&outputs.estimate, position);
        let demand = self
            .controller
            .step(&outputs.setpoint, position, estimate, active);
        outputs.following_error = demand.following_error;

        let permit = self.supervisor.review(&Review {
            permit,
            moving: outputs.moving,
            trouble: self.sources.trouble(),
        });
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

    /// Takes a new configuration between two ticks. The output goes on without a step, what jumps is let in by
    /// the controller's transfer term; another estimator starts as after a long motion at the velocity
    /// estimated last. The encoder map stays.
    ///
    /// # Errors
    /// [`ReconfigureError`] for what would move the axis while it is in motion under control; nothing is changed then.
    pub fn reconfigure(&mut self, config: AxisConfig) -> Result<(), ReconfigureError> {
        if self.outputs.enabled && self.outputs.moving {
            ReconfigureError::check(&self.config, &config)?;
        }
        self.edges.reconfigure(config.edges);
        if config.estimators != self.config.estimators {
            self.estimators = Estimators::new(&config.estimators);
            self.estimators.prime(self.outputs.estimate.velocity);
        }
        self.controller
            .reconfigure(config.controller, self.output.command());
        self.output.reconfigure(config.output);
        self.config = config;
        Ok(())
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

    /// What of the last command goes against friction.
    #[must_use]
    pub const fn friction(&self) -> Command {
        self.controller.friction()
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
