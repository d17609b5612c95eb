//! Why there are no tables.

use leadscrew::encoder_map::error::MapError;
use leadscrew::params::ParamError;
use leadscrew::supervisor::Fault;
use leadscrew::tuning::autotune::AutotuneError;
use leadscrew::units::RangeError;
use leadscrew_hal_mock::scenario::ScenarioError;
use thiserror::Error;

use crate::calibration::CalibrationError;
use crate::identify::IdentifyError;
use crate::threads::ThreadError;

/// Why there are no tables.
#[derive(Debug, Error)]
pub enum TrackingError {
    /// A parameter out of range.
    #[error(transparent)]
    Range(#[from] RangeError),
    /// Parameters of an axis that are refused.
    #[error(transparent)]
    Param(#[from] ParamError),
    /// A move cannot be made.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The encoder cannot be learned.
    #[error("an encoder cannot be learned: {0}")]
    Calibration(#[from] CalibrationError),
    /// A learned map is no map.
    #[error("the learned map cannot be used: {0}")]
    Map(#[from] MapError),
    /// A fault ended a run.
    #[error("the axis stopped in tick {tick} with {fault:?}; expected a run without fault")]
    Fault {
        /// The fault.
        fault: Fault,
        /// When it came.
        tick: u32,
    },
    /// Why a scene has no figures.
    #[error("{scene}, encoder {seed}: {error}")]
    Scene {
        /// The scene.
        scene: &'static str,
        /// The encoder.
        seed: u64,
        /// Why.
        error: Box<TrackingError>,
    },
    /// The drive was not identified.
    #[error(transparent)]
    Identify(#[from] IdentifyError),
    /// No tuning can be offered.
    #[error("{0}")]
    Autotune(AutotuneError),
    /// A machine that no axis was commissioned on.
    #[error("no axis was commissioned on this machine: name its scene when the kit is made")]
    NotCommissioned,
    /// A thread was not cut.
    #[error(transparent)]
    Thread(#[from] ThreadError),
    /// A relay makes no limit cycle.
    #[error("the relay of {effort_d_per_s} d/s did not switch in {ticks} ticks: raise the effort")]
    NoLimitCycle {
        /// The relay's output.
        effort_d_per_s: f64,
        /// How long it was waited for.
        ticks: u32,
    },
}

impl From<AutotuneError> for TrackingError {
    fn from(error: AutotuneError) -> Self {
        Self::Autotune(error)
    }
}
