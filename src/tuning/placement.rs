//! Gains from a model of the drive, by placing the poles of the loop.
//!
//! A velocity drive of second order, v″ + 2ζω·v′ + ω²·v = ω²·G·u, in a loop with position, integral,
//! velocity and acceleration feedback has the characteristic polynomial
//! s⁴ + (2ζω + ω²G·ka)s³ + ω²(1 + G·kv)s² + ω²G·kp·s + ω²G·ki. Setting it to (s + p)⁴ gives the gains;
//! the feedforward is the inverse of the drive: (v + (2ζ/ω)·a + j/ω²)/G.

use super::DriveModel;
use crate::params::ControllerParams;
use crate::units::{RangeError, checked};

impl DriveModel {
    /// Gains that put all four poles of the loop at `bandwidth_rad_per_s`.
    ///
    /// # Errors
    /// [`RangeError`] for a drive or a bandwidth that makes no sense. A bandwidth below
    /// ω/√6 leaves a negative velocity link, below ζω/2 a negative acceleration link; both are valid.
    pub fn place_poles(&self, bandwidth_rad_per_s: f64) -> Result<ControllerParams, RangeError> {
        self.place_pole_pairs(bandwidth_rad_per_s, 1.0)
    }

    /// Gains that put two equal pairs of poles at the radius `bandwidth_rad_per_s` with `damping` κ:
    /// (s² + 2κrs + r²)². With less damping the integral gain is larger for the same gain at high frequency,
    /// for less phase margin.
    ///
    /// # Errors
    /// As [`Self::place_poles`]; κ is 0.3 to 1.
    pub fn place_pole_pairs(
        &self,
        bandwidth_rad_per_s: f64,
        damping: f64,
    ) -> Result<ControllerParams, RangeError> {
        let pairs = checked("pole_damping", damping, 0.3, 1.0)?;
        let period = checked("natural_period_s", self.natural_period_s, 1e-4, 10.0)?;
        let damping = checked("damping", self.damping, 0.01, 10.0)?;
        let pole = checked("bandwidth_rad_per_s", bandwidth_rad_per_s, 0.1, 1e4)?;
        let omega = core::f64::consts::TAU / period;
        let stiffness = omega * omega;
        Ok(ControllerParams {
            position_gain_per_s: 4.0 * pairs * pole * pole * pole / stiffness,
            integral_gain_per_s2: pole * pole * pole * pole / stiffness,
            velocity_gain: (2.0 + 4.0 * pairs * pairs) * pole * pole / stiffness - 1.0,
            acceleration_gain_s: (4.0 * pairs * pole - 2.0 * damping * omega) / stiffness,
            velocity_feedforward: 1.0,
            acceleration_feedforward_s: 2.0 * damping / omega,
            jerk_feedforward_s2: 1.0 / stiffness,
            ..ControllerParams::default()
        })
    }
}
