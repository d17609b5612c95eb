//! The composition: one pure step from what a board saw to what it shall put out.
//!
//! The step is here; `planned`, `sources`, `place`, `probing` and `experiment` are what else moves the axis or gives it its place,
//! `request` and `reconfigure` how thread mode changes it, `views` what it can be asked.

mod experiment;
mod io;
mod place;
mod planned;
mod probing;
mod reconfigure;
mod request;
mod sources;
mod views;

pub use experiment::StartError;
pub use io::{Inputs, Outputs};
pub use reconfigure::ReconfigureError;
pub use request::{Refused, Request};

use crate::capture::Unwrapper;
use crate::compensation::Compensation;
use crate::controller::{Controller, Demand};
use crate::edges::EdgeReader;
use crate::encoder_map::EncoderMap;
use crate::estimator::Evidence;
use crate::estimator::observer::Gains;
use crate::estimator::paths::Estimators;
use crate::homing::Homing;
use crate::identification::experiment::Experiment;
use crate::output::{ActiveLimits, Output};
use crate::params::AxisConfig;
use crate::probe::Probe;
use crate::setpoint::sources::Sources;
use crate::supervisor::{ClearError, Context, Permit, Review, Situation, Supervisor};
use crate::units::{Command, Position};

/// One axis; `'m` is how long its encoder map and its screw table live.
// What every tick needs comes first: the target reaches the first kilobyte by pairs, and four of them at all without
// an address of their own.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Axis<'m> {
    unwrapper: Unwrapper,
    /// The tick that comes next.
    tick: u32,
    output: Output,
    /// There is an experiment: itself it is a long way off in memory.
    has_experiment: bool,
    /// Ticks matter to the probe: it is as far off.
    has_probe: bool,
    /// What the last tick gave; before the first one an axis that is off.
    outputs: Outputs,
    compensation: Compensation<'m>,
    supervisor: Supervisor,
    controller: Controller,
    homing: Homing,
    edges: EdgeReader<'m>,
    experiment: Option<Experiment>,
    sources: Sources,
    estimators: Estimators,
    config: AxisConfig,
    probe: Probe,
}

impl<'m> Axis<'m> {
    /// An axis that is not enabled, without an encoder map. Solves for an observer's gains.
    #[must_use]
    pub fn new(config: AxisConfig) -> Self {
        Self::with_gains(config, &config.estimators.gains())
    }

    /// The same with the [gains](crate::estimator::paths::Config::gains) that were solved for before.
    #[must_use]
    pub fn with_gains(config: AxisConfig, gains: &Gains) -> Self {
        Self {
            unwrapper: Unwrapper::new(),
            edges: EdgeReader::new(config.edges),
            estimators: Estimators::with_gains(&config.estimators, gains),
            supervisor: Supervisor::new(config.supervisor),
            sources: Sources::new(&config.limits, &config.sources),
            homing: Homing::new(config.homing),
            compensation: Compensation::new(config.compensation),
            controller: Controller::new(config.controller),
            output: Output::new(config.output),
            experiment: None,
            has_experiment: false,
            probe: Probe::new(config.probe),
            has_probe: false,
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
            was_enabled.then(|| (self.output.command()).saturating_sub(self.controller.withheld()));
        let mut evidence = Evidence {
            observation: &observation,
            edges: &self.edges,
            sample: None,
            command,
        };
        self.estimators.update(&mut evidence, &mut outputs.estimate);
        let position = self.estimators.position(observation.position());

        let estimate = self.estimators.fed_back();
        self.controller.note(observation.delta, command, estimate);
        let told = self.output.command();
        let left;
        let lines = if self.homing.is_active() {
            left = self.homing.leave_limit(inputs.lines);
            &left
        } else {
            &inputs.lines
        };
        let permit = self.supervisor.permit(&Situation {
            tick,
            enable: inputs.enable,
            lines,
            illegal: inputs.capture.illegal,
            missed_ticks: inputs.missed_ticks,
            readback: inputs.readback,
            told,
        });
        if self.supervisor.is_context_due() {
            self.note_context(position, told);
        }
        let open_loop = self.has_experiment && self.is_open_loop();
        if open_loop || !(self.supervisor.is_in_loop() && permit > Permit::ZeroVolts) {
            self.begin(position);
        }
        let reference = &inputs.reference;
        self.sources
            .read_master(reference.master.as_ref(), lines.master_lost);
        // Homing goes by the sources, which go on from where it ends: what they said last is the setpoint of either.
        let is_homing = self.homing.is_active();
        let has_probe = self.has_probe;
        let moving = if is_homing | has_probe {
            self.step_guided(&observation, inputs, permit)
        } else {
            self.sources.advance(tick, reference, permit)
        };
        let outputs = &mut self.outputs;
        outputs.retract = self.sources.retract();
        outputs.moving = moving;
        outputs.setpoint = self.compensation.step(self.sources.last());
        let mut demand = self.control(position);
        self.outputs.following_error = demand.following_error;
        if self.has_experiment {
            self.step_experiment(&observation, permit, &mut demand.command);
        }
        let outputs = &self.outputs;
        let homing_trouble = if is_homing {
            self.homing.trouble()
        } else {
            None
        };

        let permit = self.supervisor.review(&Review {
            permit,
            tick,
            moving: outputs.moving,
            trouble: self.sources.trouble().or(homing_trouble),
            lines,
            observation: &observation,
            estimate: &outputs.estimate,
            setpoint: &outputs.setpoint,
            following_error: outputs.following_error.to_bits(),
            told,
            active: outputs.limits,
            open_loop,
        });
        if self.has_experiment {
            self.review_experiment(permit);
        }
        if self.supervisor.is_context_due() {
            self.note_context(position, told);
        }
        let outputs = &mut self.outputs;
        let was_held = self.output.is_held();
        if permit > Permit::ZeroVolts {
            outputs.command = self.output.step(demand.command);
            outputs.enabled = true;
        } else {
            outputs.moving = false;
            outputs.command = self.output.off();
            outputs.enabled = permit > Permit::Off;
        }
        if was_held | self.output.is_held() {
            self.tell_limits();
        }
        if self.supervisor.has_news() {
            self.tell_status();
        }
        let outputs = &self.outputs;
        let is_faulted = outputs.fault.is_some();
        let is_touched = observation.has_probe() & !has_probe;
        if observation.has_index() | inputs.lines.encoder_lost | is_faulted | is_touched {
            self.watch_place(&observation, inputs.lines.encoder_lost);
            if is_touched {
                self.watch_probe(&observation);
            }
        }
        let outputs = &mut self.outputs;
        outputs.reported = self.compensation.reported(position);
        outputs
    }

    #[cold]
    #[inline(never)]
    fn tell_limits(&mut self) {
        self.outputs.limits = self.output.active_limits();
    }

    /// What the supervisor has to say.
    #[cold]
    #[inline(never)]
    fn tell_status(&mut self) {
        self.supervisor.forget_news();
        let outputs = &mut self.outputs;
        outputs.brake_released = self.supervisor.brake_released();
        outputs.state = self.supervisor.state();
        outputs.fault = self.supervisor.fault();
        outputs.warnings = self.supervisor.warnings();
        outputs.refused = self.supervisor.is_refused();
    }

    /// The control law. A function of its own: so it has the registers to itself.
    #[inline(never)]
    fn control(&mut self, position: Position) -> Demand {
        let active = if self.output.is_held() {
            self.output.active_limits()
        } else {
            ActiveLimits::default()
        };
        let estimate = self.estimators.fed_back();
        self.controller
            .step(&self.outputs.setpoint, position, estimate, active)
    }

    /// Stands where the axis is, with nothing remembered: off, or about to come under control.
    #[cold]
    fn begin(&mut self, position: Position) {
        self.homing.abort();
        self.sources.hold(self.compensation.rest_at(position));
        self.controller.reset();
    }

    /// Notes the context of the first fault.
    #[cold]
    fn note_context(&mut self, position: Position, told: Command) {
        let Outputs {
            estimate,
            setpoint,
            following_error,
            ..
        } = &self.outputs;
        self.supervisor.note_context(&Context {
            position,
            velocity: estimate.velocity,
            setpoint_position: setpoint.position,
            setpoint_velocity: setpoint.velocity,
            following_error: *following_error,
            command: told,
        });
    }

    /// Leaves the state Fault: the axis is then disabled, and may be enabled anew.
    ///
    /// # Errors
    /// [`ClearError`]; the fault then stays.
    pub fn clear_fault(&mut self) -> Result<(), ClearError> {
        self.supervisor.clear()
    }

    /// Takes an encoder map between two ticks, or does without. It waits for the index, even if the one before
    /// was tied.
    pub fn set_map(&mut self, map: Option<EncoderMap<'m>>) {
        self.edges.set_map(map);
    }
}
