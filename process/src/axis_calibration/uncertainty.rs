//! Expanded uncertainty (k = 2) of the figures, by the sources that ISO/TR 230-9 names for ISO 230-2. Its text was not at hand:
//! the formulas are derived here, from limits of a rectangular distribution (a range r is a standard uncertainty r/√12, so
//! U = 2·r/√12 = r/√3, which the standard rounds to 0.6·r), and may differ from its tables in the last digit.
//!
//! ```text
//! U_D  instrument        its certificate, µm/m (k = 2), times L
//! U_A  alignment         a beam ΔY off over L measures L·(1 − cos) = ΔY²/2L too little, 0 to that: U = ΔY²/(2·√3·L)
//! U_T  thermometer       range r_T:  α·L·r_T/√3
//! U_α  expansion         range r_α:  r_α·L·|T − 20|/√3
//! U_V  drift             range E_V of the environmental variation test: E_V/√3
//!
//! U(B)        = √(2/n)·U_V                        two means of n runs
//! U(R↑), U(R) = 2·U_V                             4·s with all the drift in s
//! U(M)        = √(U_D² + U_A² + U_T² + U_α² + U_V²/n)
//! U(E), U(E↑) = √(U_D² + U_A² + U_T² + U_α² + 2·U_V²/n)
//! U(A), U(A↑) = √(U(E)² + U(R)²)
//! ```

use leadscrew::units::{RangeError, checked};
use serde::Serialize;

use super::figures::Calibration;

/// What the measurement is uncertain by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Sources {
    /// Of the instrument, expanded (k = 2), µm/m.
    pub device_um_per_m: f64,
    /// Lateral offset of the beam over the length, mm.
    pub misalignment_mm: f64,
    /// Range in which the thermometer may be off, K.
    pub thermometer_range_k: f64,
    /// Range of the coefficient of expansion, µm/(m·K).
    pub expansion_range_um_per_m_k: f64,
    /// Range of the drift at standstill over the time of the test, µm.
    pub drift_um: f64,
}

/// Expanded uncertainties (k = 2), µm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Uncertainty {
    /// Of the instrument.
    pub device_um: f64,
    /// Of its alignment.
    pub alignment_um: f64,
    /// Of the temperature.
    pub thermometer_um: f64,
    /// Of the coefficient of expansion.
    pub expansion_um: f64,
    /// Of the drift.
    pub drift_um: f64,
    /// Of the reversal B.
    pub reversal_um: f64,
    /// Of the repeatabilities R, R↑, R↓.
    pub repeatability_um: f64,
    /// Of the systematic errors E, E↑, E↓.
    pub systematic_um: f64,
    /// Of the range of the means M.
    pub mean_range_um: f64,
    /// Of the accuracies A, A↑, A↓.
    pub accuracy_um: f64,
}

impl Sources {
    /// The uncertainties of a calibration, whose scale expands by `expansion_um_per_m_k` and was up to `away_k` from 20 °C.
    ///
    /// # Errors
    /// [`RangeError`] for a source that is negative or larger than any is.
    pub fn of(
        &self,
        calibration: &Calibration,
        expansion_um_per_m_k: f64,
        away_k: f64,
    ) -> Result<Uncertainty, RangeError> {
        let device = checked("device_um_per_m", self.device_um_per_m, 0.0, 1000.0)?;
        let offset_mm = checked("misalignment_mm", self.misalignment_mm, 0.0, 100.0)?;
        let thermometer = checked("thermometer_range_k", self.thermometer_range_k, 0.0, 20.0)?;
        let expansion = checked(
            "expansion_range_um_per_m_k",
            self.expansion_range_um_per_m_k,
            0.0,
            50.0,
        )?;
        let drift = checked("drift_um", self.drift_um, 0.0, 1000.0)?;
        let length_m = calibration.length_mm / 1000.0;
        let of_range = |range: f64| range / 3_f64.sqrt();
        let device_um = device * length_m;
        // mm² over m is µm.
        let alignment_um = of_range(offset_mm * offset_mm / (2.0 * length_m));
        let thermometer_um = of_range(expansion_um_per_m_k.abs() * length_m * thermometer);
        let expansion_um = of_range(expansion * length_m * away_k);
        let drift_um = of_range(drift);
        let n = calibration.runs as f64;
        let length = [device_um, alignment_um, thermometer_um, expansion_um];
        let with_drift = |squares: f64| {
            let lengths: f64 = length.iter().map(|one| one * one).sum();
            (lengths + squares * drift_um * drift_um).sqrt()
        };
        let systematic_um = with_drift(2.0 / n);
        let repeatability_um = 2.0 * drift_um;
        Ok(Uncertainty {
            device_um,
            alignment_um,
            thermometer_um,
            expansion_um,
            drift_um,
            reversal_um: (2.0 / n).sqrt() * drift_um,
            repeatability_um,
            systematic_um,
            mean_range_um: with_drift(1.0 / n),
            accuracy_um: systematic_um.hypot(repeatability_um),
        })
    }
}
