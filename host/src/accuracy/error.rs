//! Why there are no figures.

use leadscrew::encoder_map::error::MapError;
use leadscrew::encoder_map::tie::MapState;
use leadscrew::units::RangeError;
use leadscrew_hal_mock::scenario::ScenarioError;
use thiserror::Error;

use crate::calibration::CalibrationError;

/// Why there are no figures.
#[derive(Debug, Error)]
pub enum AccuracyError {
    /// A parameter out of range.
    #[error(transparent)]
    Range(#[from] RangeError),
    /// The encoder cannot be learned.
    #[error("an encoder cannot be learned: {0}")]
    Calibration(#[from] CalibrationError),
    /// A learned map is no map.
    #[error("the learned map cannot be used: {0}")]
    Map(#[from] MapError),
    /// A move cannot be made.
    #[error(transparent)]
    Loop(#[from] ScenarioError),
    /// The index was not found in time.
    #[error(
        "row {row}, encoder {seed}: the map is {state:?} to the index when the figures begin; expected Tied"
    )]
    NotTied {
        /// The row.
        row: &'static str,
        /// The encoder.
        seed: u64,
        /// What the map is instead.
        state: MapState,
    },
}
