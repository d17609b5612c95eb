//! The tables: with what helps, and without.

use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::Ripple;
use serde::Serialize;

/// What is known and what the hardware gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Variant {
    /// Learned map, every edge stamped.
    Learned,
    /// No map.
    WithoutMap,
    /// Learned map, the last edge of a tick stamped.
    OneStamp,
    /// A ripple of the shaft's angle on the motion, in calibration and use.
    ShaftSynchronous,
    /// Phase offsets that have drifted since the calibration.
    Drifted,
}

impl Variant {
    /// All, in order.
    pub const ALL: [Self; 5] = [
        Self::Learned,
        Self::WithoutMap,
        Self::OneStamp,
        Self::ShaftSynchronous,
        Self::Drifted,
    ];

    /// What keeps to the angle of the shaft.
    pub const fn ripple(self) -> Ripple {
        match self {
            Self::ShaftSynchronous => Ripple::TWICE_A_REVOLUTION,
            _ => Ripple::NONE,
        }
    }

    /// The encoder in use.
    pub fn model(self) -> EncoderModel {
        match self {
            Self::Drifted => EncoderModel::real().drifted(DRIFT_D),
            _ => EncoderModel::real(),
        }
    }
}

/// Most that a phase offset has drifted.
const DRIFT_D: f64 = 0.02;
