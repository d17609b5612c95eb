//! What is set on the sources.

use crate::edges::EdgeConfig;
use crate::setpoint::profile::Limits;
use crate::setpoint::{analog, gearing, master, step_dir, thread};
use crate::units::{AxisScale, RangeError};

/// Parameters of all sources but planned moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SourceParams {
    /// Step and direction.
    pub step_dir: step_dir::StepDirParams,
    /// Analog velocity command.
    pub analog: analog::AnalogParams,
    /// The second encoder.
    pub master: master::MasterParams,
    /// Electronic gearing.
    pub gearing: gearing::GearingParams,
    /// Thread cutting.
    pub thread: thread::ThreadParams,
}

/// The same, quantised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Step and direction.
    pub step_dir: step_dir::Config,
    /// Analog velocity command.
    pub analog: analog::Config,
    /// The second encoder.
    pub master: master::Config,
    /// Electronic gearing.
    pub gearing: gearing::Config,
    /// Thread cutting.
    pub thread: thread::Config,
}

impl SourceParams {
    /// Validates and quantises, for an axis with `limits` and the rates and timer of `edges`.
    ///
    /// # Errors
    /// [`RangeError`] naming the first parameter that is out of range.
    pub fn quantise(
        &self,
        scale: AxisScale,
        limits: Limits,
        edges: EdgeConfig,
    ) -> Result<Config, RangeError> {
        Ok(Config {
            step_dir: self.step_dir.quantise(scale, limits.velocity())?,
            analog: self.analog.quantise(scale, limits.velocity())?,
            master: self.master.quantise(edges)?,
            gearing: self.gearing.quantise()?,
            thread: self.thread.quantise(scale, limits)?,
        })
    }
}
