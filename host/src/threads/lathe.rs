//! A lathe that cuts threads: axis, machine and spindle, tick by tick.

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::estimator::{EstimatorConfig, observer};
use leadscrew::hal::{Encoder as _, Lines, Reference};
use leadscrew::params::AxisParams;
use leadscrew::setpoint::thread::{ThreadOrder, ThreadPhase};
use leadscrew::tuning::DriveModel;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::MoveAndBack;
use leadscrew_hal_mock::spindle::{Spindle, SpindleParams, encoder_1024};

use super::error::ThreadError;
use super::pass::Pass;

/// Control rate, Hz.
const TICK_HZ: f64 = 1000.0;
/// Longest wait for a pass, ticks.
pub(super) const PATIENCE: u32 = 200_000;

/// A lathe: an axis on its machine, and a spindle.
#[derive(Clone, Debug)]
pub struct Lathe<'m> {
    /// The axis.
    pub axis: Axis<'m>,
    /// Its machine.
    pub machine: Machine,
    /// The spindle.
    pub spindle: Spindle,
    /// Levels of the board's inputs.
    pub lines: Lines,
    outputs: Outputs,
}

impl<'m> Lathe<'m> {
    /// A lathe at rest, its spindle turning at `rpm`, with the encoders that `seed` draws and the loop's poles at
    /// `bandwidth_rad_per_s` on the drive's nominal figures, with the observer in the loop.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(
        machine: &MachineParams,
        spindle: &SpindleParams,
        spindle_encoder: EncoderModel,
        bandwidth_rad_per_s: f64,
        seed: u64,
    ) -> Result<Self, ThreadError> {
        let params = axis_params(machine, bandwidth_rad_per_s)?;
        Self::with(&params, None, machine, spindle, spindle_encoder, seed)
    }

    /// A lathe at rest, its spindle turning at `rpm`, with the encoders that `seed` draws and an axis of `params` with a map
    /// of its encoder.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn with(
        params: &AxisParams,
        map: Option<EncoderMap<'m>>,
        machine: &MachineParams,
        spindle: &SpindleParams,
        spindle_encoder: EncoderModel,
        seed: u64,
    ) -> Result<Self, ThreadError> {
        let mut axis = Axis::new(params.validate()?);
        axis.set_map(map);
        let encoder = encoder_1024(spindle_encoder);
        Ok(Self {
            axis,
            machine: Machine::new(machine, TICK_HZ, seed)?,
            spindle: Spindle::new(spindle, &encoder, TICK_HZ, seed ^ 0x51)?,
            lines: Lines::default(),
            outputs: Outputs::default(),
        })
    }

    /// One tick, enabled.
    pub fn step(&mut self) -> Outputs {
        self.machine
            .step(self.outputs.command, self.outputs.enabled);
        self.spindle.step();
        let inputs = Inputs {
            reference: Reference {
                master: Some(self.spindle.capture()),
                ..Reference::default()
            },
            lines: self.lines,
            ..Inputs::of(self.machine.capture(), true)
        };
        self.outputs = *self.axis.step(&inputs);
        self.outputs
    }

    /// So many ticks.
    pub fn run(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.step();
        }
    }

    /// Cuts one pass.
    ///
    /// # Errors
    /// A refusal of the axis, or a pass that did not come to its end.
    pub fn cut(&mut self, order: &ThreadOrder, counts_per_mm: f64) -> Result<Pass, ThreadError> {
        let figures = self.axis.arm_thread(order)?;
        self.follow(order, counts_per_mm, figures.rpm)
    }

    /// Cuts on in the pass `order`, which was armed when the spindle turned at `rpm`.
    ///
    /// # Errors
    /// A pass that did not come to its end.
    pub fn follow(
        &mut self,
        order: &ThreadOrder,
        counts_per_mm: f64,
        rpm: f64,
    ) -> Result<Pass, ThreadError> {
        let mut pass = Pass::new(order, counts_per_mm, rpm);
        for _ in 0..PATIENCE {
            let outputs = self.step();
            let phase = self.axis.thread_phase();
            if phase == ThreadPhase::Idle {
                if let Some(trouble) = self.axis.spindle_trouble() {
                    return Err(ThreadError::Ended(trouble));
                }
                return Ok(pass);
            }
            let shaft = self.machine.truth().shaft.position;
            let is_cutting = phase == ThreadPhase::Cutting && pass.is_deep(shaft);
            self.spindle.load(is_cutting);
            if is_cutting {
                pass.push(shaft, self.spindle.turns(), &outputs);
            }
        }
        Err(ThreadError::Endless)
    }
}

/// The axis of `machine`, with the observer.
fn axis_params(
    machine: &MachineParams,
    bandwidth_rad_per_s: f64,
) -> Result<AxisParams, ThreadError> {
    let scenario = MoveAndBack::standard(TICK_HZ);
    let observer = EstimatorConfig::Observer(observer::Config::of_16k20f3()?);
    let observer = scenario.tuned(machine, observer, false)?;
    let mut params = scenario.axis_params(machine, observer)?;
    let drive = &machine.drive;
    let model = DriveModel::second_order(drive.natural_period_s, drive.damping);
    params.controller = model.place_poles(bandwidth_rad_per_s)?;
    Ok(params)
}
