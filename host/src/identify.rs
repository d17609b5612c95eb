//! Identification of a simulated machine through the real core of the axis.

use leadscrew::axis::{Axis, Inputs};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::estimator::{EstimatorConfig, difference};
use leadscrew::hal::Encoder;
use leadscrew::identification::{Identification, Identified, IdentifyParams, Refusal};
use leadscrew::params::{AxisParams, MAX_FEED_SHARE, MotionParams, ParamError};
use leadscrew::units::{AxisScale, Command};
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use thiserror::Error;

/// Entries of the work memory, as many as a board lends for the calibration of an encoder.
const MEMORY: usize = 10_000;
/// Ticks that an axis is given to become ready.
const READY_TICKS: u32 = 50;
/// Longest that all experiments together may take, s.
const LONGEST_S: f64 = 600.0;

/// A machine that is to be identified.
#[derive(Clone, Copy, Debug)]
pub struct Bench {
    /// The machine.
    pub machine: MachineParams,
    /// Bounds of the experiments.
    pub params: IdentifyParams,
    /// Control rate, Hz.
    pub tick_hz: f64,
    /// Feed at full command as it is thought to be, mm/min.
    pub nominal_feed_mm_per_min: f64,
    /// The wires of the command are exchanged.
    pub reversed: bool,
    /// Seed of everything random.
    pub seed: u64,
}

/// Why a machine was not identified.
#[derive(Debug, Error)]
pub enum IdentifyError {
    /// A parameter is out of range.
    #[error(transparent)]
    Param(#[from] ParamError),
    /// The machine was refused.
    #[error("{0}")]
    Refused(Refusal),
    /// The experiments did not come to an end.
    #[error("no result within {LONGEST_S} s of the machine's time")]
    Endless,
}

/// A record of the main experiments.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Time since the first one, s.
    pub time_s: f64,
    /// Velocity measured and modelled, d/tick.
    pub velocity: (f64, f64),
    /// Measured less modelled position, d.
    pub error_d: f64,
}

/// A machine that was identified.
#[derive(Clone, Debug)]
pub struct Found {
    /// The figures.
    pub identified: Identified,
    /// The records they were made of.
    pub samples: Vec<Sample>,
    /// Time that the experiments took, s.
    pub duration_s: f64,
    /// Furthest from where it began, mm.
    pub furthest_mm: f64,
}

impl Bench {
    /// An axis on it that was not tuned: its loop gives no command, and its estimator is plain counting.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn axis_params(&self) -> Result<AxisParams, ParamError> {
        let estimator = EstimatorConfig::Difference(difference::Config);
        Ok(AxisParams {
            tick_hz: self.tick_hz,
            timer_hz: self.machine.encoder.encoder.timer_hz,
            motion: MotionParams {
                counts_per_mm: self.machine.mount.counts_per_mm,
                full_command_feed_mm_per_min: self.nominal_feed_mm_per_min,
                max_feed_mm_per_min: MAX_FEED_SHARE * self.nominal_feed_mm_per_min,
                ..MotionParams::default()
            },
            ..AxisParams::new(estimator)
        })
    }

    /// Runs the experiments on an axis with a `map` of its encoder.
    ///
    /// # Errors
    /// [`IdentifyError`].
    pub fn run(&self, map: Option<EncoderMap<'_>>) -> Result<Found, IdentifyError> {
        let params = self.axis_params()?;
        let mut axis = Axis::new(params.validate()?);
        axis.set_map(map);
        let mut machine =
            Machine::new(&self.machine, self.tick_hz, self.seed).map_err(ParamError::from)?;
        let scale = AxisScale::new(self.machine.mount.counts_per_mm, self.tick_hz)
            .map_err(ParamError::from)?;
        let full = scale
            .velocity_from_feed(self.nominal_feed_mm_per_min)
            .map_err(ParamError::from)?;
        let mut memory = vec![0; MEMORY];
        let mut identification = Identification::new(&self.params, scale, full, &mut memory)
            .map_err(IdentifyError::Refused)?;
        let start_d = machine.truth().shaft.position;
        let mut furthest_d = 0.0_f64;
        for tick in 0..(LONGEST_S * self.tick_hz) as u32 {
            let outputs = axis.outputs();
            let sign = if self.reversed { -1 } else { 1 };
            let command = Command::from_bits(outputs.command.to_bits() * sign);
            machine.step(command, outputs.enabled);
            axis.step(&Inputs::of(machine.capture(), true));
            furthest_d = furthest_d.max((machine.truth().shaft.position - start_d).abs());
            if tick < READY_TICKS {
                continue;
            }
            let tended = identification.tend(&mut axis);
            if let Some(identified) = tended.map_err(IdentifyError::Refused)? {
                return Ok(Found {
                    identified,
                    samples: samples(&identification, self.tick_hz),
                    duration_s: f64::from(tick) / self.tick_hz,
                    furthest_mm: scale.mm_from_counts(furthest_d),
                });
            }
        }
        Err(IdentifyError::Endless)
    }
}

/// The records of the main experiments at a control rate of `tick_hz`.
pub(crate) fn samples(identification: &Identification<'_>, tick_hz: f64) -> Vec<Sample> {
    let record_s = f64::from(identification.ticks_of_record()) / tick_hz;
    let mut samples = Vec::new();
    identification.trace(|index, measured, modelled, error_d| {
        samples.push(Sample {
            time_s: index as f64 * record_s,
            velocity: (measured, modelled),
            error_d,
        });
    });
    samples
}
