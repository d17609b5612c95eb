//! Runs that the host and the firmware share: what is commanded at which tick.

use core::fmt;

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer::{self, ObserverParams};
use leadscrew::hal::Encoder;
use leadscrew::params::{AxisConfig, AxisParams, MotionParams, ParamError};
use leadscrew::setpoint::profile::{PlanError, Profile};
use leadscrew::setpoint::trajectory::QueueError;
use leadscrew::telemetry::Record;
use leadscrew::tuning::DriveModel;
use leadscrew::units::{AxisScale, Position, checked};

use crate::machine::{Machine, MachineParams};
use crate::trace::TraceDigest;

/// Bandwidth of the loop with an estimator that lags by some five ticks of 1 ms, rad/s.
pub const BANDWIDTH_RAD_PER_S: f64 = 35.0;

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
        if !matches!(estimator, EstimatorConfig::Observer(_)) {
            return Ok(estimator);
        }
        let scale = AxisScale::new(machine.mount.counts_per_mm, self.tick_hz)?;
        let config = observer::Config::new(&observer_params(machine, mapped), scale)?;
        Ok(EstimatorConfig::Observer(config))
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
        let drive = DriveModel::second_order(machine.drive.natural_period_s, machine.drive.damping);
        Ok(AxisParams {
            tick_hz: self.tick_hz,
            timer_hz: machine.encoder.encoder.timer_hz,
            motion: MotionParams {
                counts_per_mm: machine.mount.counts_per_mm,
                full_command_feed_mm_per_min: machine.drive.full_command_feed_mm_per_min,
                max_feed_mm_per_min: self.feed_mm_per_min,
                ..MotionParams::default()
            },
            controller: drive.place_poles(BANDWIDTH_RAD_PER_S)?,
            ..AxisParams::new(estimator)
        })
    }
}

/// What an observer is to count on, on `machine`; with a map of its encoder (`mapped`), what such a map leaves.
#[must_use]
pub fn observer_params(machine: &MachineParams, mapped: bool) -> ObserverParams {
    let (drive, disc, encoder) = (
        &machine.drive,
        &machine.encoder.disc,
        &machine.encoder.encoder,
    );
    let params = ObserverParams {
        full_command_feed_mm_per_min: drive.full_command_feed_mm_per_min,
        natural_period_s: drive.natural_period_s,
        damping: drive.damping,
        delay_s: drive.delay_s,
        offset: drive.offset,
        ..ObserverParams::default()
    };
    if mapped {
        return params;
    }
    let edge_variance = encoder.noise_d * encoder.noise_d
        + disc.line_sigma_d * disc.line_sigma_d
        + disc.edge_sigma_d * disc.edge_sigma_d
        + disc.phase_offset_d * disc.phase_offset_d / 3.0;
    // Slopes add up as squares; that of the second harmonic is twice as steep.
    let second = 2.0 * disc.second_harmonic_d;
    let waves = disc.eccentricity_d * disc.eccentricity_d + second * second;
    ObserverParams {
        edge_noise_d: libm::sqrt(edge_variance).max(LEAST_EDGE_NOISE_D),
        time_noise_s: encoder.noise_s,
        map_residual_d: libm::sqrt(waves / 2.0),
        map_wave_mm: disc.edges_per_revolution / machine.mount.counts_per_mm,
        ..params
    }
}

/// Edge noise that even an ideal encoder is given: what the timer's clock leaves at 150 d/tick.
const LEAST_EDGE_NOISE_D: f64 = 0.002;

/// Why a scenario cannot run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScenarioError {
    /// A parameter is out of range.
    Param(ParamError),
    /// The move cannot be planned.
    Plan(PlanError),
    /// The axis did not take a move.
    Queue(QueueError),
}

impl fmt::Display for ScenarioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Param(error) => error.fmt(f),
            Self::Plan(error) => error.fmt(f),
            Self::Queue(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for ScenarioError {}

impl<E: Into<ParamError>> From<E> for ScenarioError {
    fn from(error: E) -> Self {
        Self::Param(error.into())
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

    /// Hands over the move that starts with the tick to come.
    fn queue_next_move(&mut self) -> Result<(), ScenarioError> {
        match self.script.moves.get(self.next_move) {
            Some(next) if next.start == self.tick => {
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
