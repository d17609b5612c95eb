//! The standard run: a move there and back.

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::Encoder;
use leadscrew::params::{AxisConfig, AxisParams, ParamError};
use leadscrew::setpoint::profile::Profile;
use leadscrew::telemetry::Record;
use leadscrew::units::{Position, checked};

use super::error::ScenarioError;
use super::tuning::{BANDWIDTH_RAD_PER_S, tuned_axis, tuned_estimator};
use crate::machine::{Machine, MachineParams};
use crate::trace::TraceDigest;

/// A move there and back: enable, wait, move, wait, move back, wait.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoveAndBack {
    /// Distance of the move, mm.
    pub move_mm: f64,
    /// Feed of the move, mm/min.
    pub feed_mm_per_min: f64,
    /// Control rate, Hz.
    pub tick_hz: f64,
    /// Standing still before, between and after the moves, s.
    pub dwell_s: f64,
}

impl MoveAndBack {
    /// The standard move: 300 mm at 9 000 mm/min and back.
    #[must_use]
    pub const fn standard(tick_hz: f64) -> Self {
        Self {
            move_mm: 300.0,
            feed_mm_per_min: 9000.0,
            tick_hz,
            dwell_s: 0.2,
        }
    }

    /// The estimator for `machine`: an observer with the machine's nominal figures and what its encoder does
    /// without a map in place of any other observer; all others as they are.
    ///
    /// # Errors
    /// The drive or the encoder has no figures that an observer could be tuned on.
    pub fn tuned(
        &self,
        machine: &MachineParams,
        estimator: EstimatorConfig,
        mapped: bool,
    ) -> Result<EstimatorConfig, ParamError> {
        tuned_estimator(machine, self.tick_hz, estimator, mapped)
    }

    /// An axis tuned on the drive's nominal figures, for this move on `machine`.
    ///
    /// # Errors
    /// The drive has no figures that a loop could be tuned on.
    pub fn axis_params(
        &self,
        machine: &MachineParams,
        estimator: EstimatorConfig,
    ) -> Result<AxisParams, ParamError> {
        tuned_axis(
            machine,
            self.tick_hz,
            self.feed_mm_per_min,
            BANDWIDTH_RAD_PER_S,
            estimator,
        )
    }
}

/// A move that starts at a stated tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimedMove {
    /// Tick of the start.
    pub start: u32,
    /// The move.
    pub profile: Profile,
}

/// What is commanded at which tick: the axis is enabled throughout.
#[derive(Clone, Debug)]
pub struct Script {
    /// The moves, in order.
    pub moves: [TimedMove; 2],
    /// Ticks of the whole run.
    pub ticks: u32,
}

impl Script {
    /// Plans `scenario` for an axis of `counts_per_mm` with configuration `config`.
    ///
    /// # Errors
    /// A distance or dwell out of range, or a move that cannot be planned.
    pub fn new(
        scenario: &MoveAndBack,
        counts_per_mm: f64,
        config: &AxisConfig,
    ) -> Result<Self, ScenarioError> {
        let dwell = (checked("dwell_s", scenario.dwell_s, 0.01, 1000.0)? * scenario.tick_hz) as u32;
        let move_mm = checked("move_mm", scenario.move_mm, -1e6, 1e6)?;
        let distance = Position::saturating_from_num(move_mm * counts_per_mm);
        let plan = |distance| Profile::plan(distance, &config.limits).map_err(ScenarioError::Plan);
        let (there, back) = (plan(distance)?, plan(-distance)?);
        let turn = dwell + there.ticks() + dwell;
        Ok(Self {
            moves: [
                TimedMove {
                    start: dwell,
                    profile: there,
                },
                TimedMove {
                    start: turn,
                    profile: back,
                },
            ],
            ticks: turn + back.ticks() + dwell,
        })
    }
}

/// What a run is made of, at rest.
#[derive(Clone, Debug)]
pub struct Setup<'m> {
    /// The machine.
    pub machine: Machine,
    /// The axis on it, tuned for it.
    pub axis: Axis<'m>,
    /// The moves.
    pub script: Script,
}

impl Setup<'_> {
    /// `scenario` on the machine `params` with the errors that `seed` draws, by an axis with `estimator`
    /// in its loop.
    ///
    /// # Errors
    /// A parameter out of range, or a move that cannot be planned.
    pub fn new(
        scenario: &MoveAndBack,
        params: &MachineParams,
        estimator: EstimatorConfig,
        seed: u64,
    ) -> Result<Self, ScenarioError> {
        let axis = scenario.axis_params(params, scenario.tuned(params, estimator, false)?)?;
        Self::with_axis(scenario, params, &axis, seed)
    }

    /// `scenario` on the machine `params` with the errors that `seed` draws, by the axis of `axis`.
    ///
    /// # Errors
    /// A parameter out of range, or a move that cannot be planned.
    pub fn with_axis(
        scenario: &MoveAndBack,
        params: &MachineParams,
        axis: &AxisParams,
        seed: u64,
    ) -> Result<Self, ScenarioError> {
        let config = axis.validate()?;
        Ok(Self {
            script: Script::new(scenario, axis.motion.counts_per_mm, &config)?,
            machine: Machine::new(params, scenario.tick_hz, seed)?,
            axis: Axis::new(config),
        })
    }
}

/// A run on the host: the machine, the axis on it and the script, tick by tick.
#[derive(Clone)]
pub struct Simulation<'m> {
    /// The machine.
    pub machine: Machine,
    /// The axis.
    pub axis: Axis<'m>,
    script: Script,
    next_move: usize,
    tick: u32,
    outputs: Outputs,
    digest: TraceDigest,
}

impl<'m> Simulation<'m> {
    /// A run of what [`Setup::new`] makes of the same arguments.
    ///
    /// # Errors
    /// As [`Setup::new`].
    pub fn prepare(
        scenario: &MoveAndBack,
        params: &MachineParams,
        estimator: EstimatorConfig,
        seed: u64,
    ) -> Result<Self, ScenarioError> {
        Ok(Setup::new(scenario, params, estimator, seed)?.into())
    }

    /// A run of `script` by `axis` on `machine`, both at rest.
    #[must_use]
    pub fn new(machine: Machine, axis: Axis<'m>, script: Script) -> Self {
        let (outputs, digest) = (Outputs::default(), TraceDigest::new());
        Self {
            machine,
            axis,
            script,
            next_move: 0,
            tick: 0,
            outputs,
            digest,
        }
    }

    /// One tick: the machine moves under the last command, the axis sees what came of it. `None`
    /// when the script is through.
    ///
    /// # Errors
    /// The axis refuses a move of the script.
    pub fn step(&mut self) -> Result<Option<Outputs>, ScenarioError> {
        if self.tick == self.script.ticks {
            return Ok(None);
        }
        self.machine
            .step(self.outputs.command, self.outputs.enabled);
        let inputs = Inputs::of(self.machine.capture(), true);
        self.outputs = *self.axis.step(&inputs);
        self.digest.update(&inputs, &Record::new(&self.outputs));
        self.tick += 1;
        self.queue_next_move()?;
        Ok(Some(self.outputs))
    }

    /// Ticks of the whole run.
    #[must_use]
    pub const fn ticks(&self) -> u32 {
        self.script.ticks
    }

    /// Digest of the run so far.
    #[must_use]
    pub fn digest(&self) -> u64 {
        self.digest.value()
    }

    /// Hands over the move that starts with the tick to come; after a fault the axis stands to the end.
    fn queue_next_move(&mut self) -> Result<(), ScenarioError> {
        match self.script.moves.get(self.next_move) {
            Some(next) if next.start == self.tick && self.outputs.fault.is_none() => {
                self.next_move += 1;
                self.axis
                    .queue(&next.profile, next.start)
                    .map_err(ScenarioError::Queue)
            }
            _ => Ok(()),
        }
    }
}

impl<'m> From<Setup<'m>> for Simulation<'m> {
    fn from(setup: Setup<'m>) -> Self {
        let Setup {
            machine,
            axis,
            script,
        } = setup;
        Self::new(machine, axis, script)
    }
}
