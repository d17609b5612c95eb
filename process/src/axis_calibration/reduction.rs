//! To 20 °C: what the expansion of the machine's scale, and of an instrument that is not compensated, has put into the deviations.

use leadscrew::units::{RangeError, checked};
use serde::Serialize;

use super::runs::{Reading, Runs};

/// The temperature that lengths are told at, °C.
pub const REFERENCE_C: f64 = 20.0;

/// Coefficients of expansion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Expansion {
    /// Of what the axis measures its place by (screw, scale), µm/(m·K); steel 11.5.
    pub machine_um_per_m_k: f64,
    /// Of an instrument at the same temperature whose readings are not reduced, µm/(m·K); 0 for a laser that measures true
    /// lengths.
    pub instrument_um_per_m_k: f64,
    /// Place that does not move with temperature: where the instrument was set to zero, mm.
    pub datum_mm: f64,
    /// Temperature of readings without one, °C.
    pub temperature_c: f64,
}

impl Default for Expansion {
    fn default() -> Self {
        Self {
            machine_um_per_m_k: 11.5,
            instrument_um_per_m_k: 0.0,
            datum_mm: 0.0,
            temperature_c: REFERENCE_C,
        }
    }
}

impl Expansion {
    /// The same if it is possible.
    ///
    /// # Errors
    /// [`RangeError`]: coefficients of −50 to 50 µm/(m·K), datums of ±1e5 mm, temperatures of −20 to 80 °C.
    pub fn check(self) -> Result<Self, RangeError> {
        checked(
            "machine_expansion_um_per_m_k",
            self.machine_um_per_m_k,
            -50.0,
            50.0,
        )?;
        checked(
            "instrument_expansion_um_per_m_k",
            self.instrument_um_per_m_k,
            -50.0,
            50.0,
        )?;
        checked("datum_mm", self.datum_mm, -1e5, 1e5)?;
        checked("temperature_c", self.temperature_c, -20.0, 80.0)?;
        Ok(self)
    }

    /// Temperature at a reading, °C.
    #[must_use]
    pub fn temperature_of(&self, reading: &Reading) -> f64 {
        reading.temperature_c.unwrap_or(self.temperature_c)
    }

    /// What the deviation would be at 20 °C, µm: x − (α_machine − α_instrument)·(target − datum)·(T − 20).
    #[must_use]
    pub fn reduced(&self, reading: &Reading) -> f64 {
        let length_m = (reading.target_mm - self.datum_mm) / 1000.0;
        let warmer = self.temperature_of(reading) - REFERENCE_C;
        let difference = self.machine_um_per_m_k - self.instrument_um_per_m_k;
        reading.deviation_um - difference * length_m * warmer
    }

    /// Largest distance of a reading's temperature from 20 °C, K.
    #[must_use]
    pub fn warmest(&self, runs: &Runs) -> f64 {
        let away = |reading| (self.temperature_of(reading) - REFERENCE_C).abs();
        runs.readings.iter().map(away).fold(0.0, f64::max)
    }
}
