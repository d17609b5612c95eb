//! Gains of the controller: from fractions of full command per d and tick to integers with one scale.

use super::FollowingError;
use crate::units::{Acceleration, Command, Jerk, RangeError, Velocity, checked};

/// Weighted inputs of the law, the integral apart.
pub(super) const TERMS: usize = 7;

/// Fractional bits of the integral beyond those of a command.
pub(super) const INTEGRAL_SHIFT: u32 = 26;

/// Gains in fractions of full command per unit of the tick (d, d/tick, …).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gains {
    /// kp, per d of following error.
    pub position: f64,
    /// ki, per d and tick.
    pub integral: f64,
    /// kd, per d of change of the following error in a tick.
    pub derivative: f64,
    /// kv, per d/tick of velocity error.
    pub velocity: f64,
    /// ka, per d/tick² of acceleration error.
    pub acceleration: f64,
    /// Feedforward per d/tick.
    pub velocity_feedforward: f64,
    /// Feedforward per d/tick².
    pub acceleration_feedforward: f64,
    /// Feedforward per d/tick³.
    pub jerk_feedforward: f64,
}

/// Quantised controller parameters.
///
/// All weights share one power of two, chosen as large as the sum of their magnitudes allows; the sum
/// of the products then cannot overflow, and one shift at the end serves all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    weights: [i32; TERMS],
    weight_shift: u32,
    bias: i32,
    deadband: i32,
    pub(super) integral_gain: i32,
    pub(super) transfer_decay: i32,
}

impl Config {
    /// Quantises `gains`; `deadband_d` in d is subtracted from the following error, `bias` in fractions
    /// of full command is added to the output, and a jump of the law decays with a time constant of
    /// `transfer_ticks`.
    ///
    /// # Errors
    /// [`RangeError`] naming the parameter that does not fit.
    pub fn new(
        gains: &Gains,
        deadband_d: f64,
        bias: f64,
        transfer_ticks: f64,
    ) -> Result<Self, RangeError> {
        let (weights, weight_shift) = quantise(gains)?;
        let integral = checked("integral_gain_per_d_tick", gains.integral, 0.0, 1.9e-3)?;
        let transfer = checked("transfer_ticks", transfer_ticks, 1.0, 1e6)?;
        Ok(Self {
            weights,
            weight_shift,
            bias: scaled(checked("bias", bias, -1.0, 1.0)?, Command::FRAC_NBITS),
            deadband: scaled(
                checked("deadband_d", deadband_d, 0.0, 1000.0)?,
                FollowingError::FRAC_NBITS,
            ),
            integral_gain: scaled(
                integral,
                Command::FRAC_NBITS
                    .wrapping_add(INTEGRAL_SHIFT)
                    .wrapping_sub(FollowingError::FRAC_NBITS),
            ),
            transfer_decay: scaled(libm::exp(-1.0 / transfer), 31),
        })
    }

    /// The error less the deadband, which does not step at its border.
    pub(super) const fn apply_deadband(&self, error: i32) -> i32 {
        if error > self.deadband {
            error.wrapping_sub(self.deadband)
        } else if error < self.deadband.wrapping_neg() {
            error.saturating_add(self.deadband)
        } else {
            0
        }
    }

    /// Bias and weighted sum of the signals, Q.30. The weights add up to less than 2³¹, so the sum of
    /// products stays within ±2⁶².
    pub(super) fn weigh(&self, signals: &[i32; TERMS]) -> i64 {
        let half = 1_i64.wrapping_shl(self.weight_shift).wrapping_shr(1);
        let products = self.weights.iter().zip(signals);
        let sum = products.fold(half, |sum, (&weight, &signal)| {
            sum.wrapping_add(i64::from(weight).wrapping_mul(i64::from(signal)))
        });
        sum.wrapping_shr(self.weight_shift)
            .wrapping_add(i64::from(self.bias))
    }
}

/// Weights in the order of [`super::Controller::signals`] and their common shift.
fn quantise(gains: &Gains) -> Result<([i32; TERMS], u32), RangeError> {
    let error = FollowingError::FRAC_NBITS;
    let exact = [
        weight("position_gain", gains.position, 0.0, error)?,
        weight("derivative_gain", gains.derivative, 0.0, error)?,
        weight(
            "velocity_gain",
            gains.velocity,
            MIN_LINK,
            Velocity::FRAC_NBITS,
        )?,
        weight(
            "acceleration_gain",
            gains.acceleration,
            MIN_LINK,
            Acceleration::FRAC_NBITS,
        )?,
        weight(
            "velocity_feedforward",
            gains.velocity_feedforward,
            0.0,
            Velocity::FRAC_NBITS,
        )?,
        weight(
            "acceleration_feedforward",
            gains.acceleration_feedforward,
            0.0,
            Acceleration::FRAC_NBITS,
        )?,
        weight(
            "jerk_feedforward",
            gains.jerk_feedforward,
            0.0,
            Jerk::FRAC_NBITS,
        )?,
    ];
    let total: f64 = exact.iter().map(|weight| libm::fabs(*weight)).sum();
    // Rounding adds at most half a unit to each weight.
    let room = f64::from(i32::MAX) - TERMS as f64;
    checked("sum of the controller's gains", total, 0.0, room)?;
    let mut shift = 0_u32;
    while shift < MAX_WEIGHT_SHIFT && libm::ldexp(total, shift.wrapping_add(1).cast_signed()) < room
    {
        shift = shift.wrapping_add(1);
    }
    Ok((
        exact.map(|weight| libm::round(libm::ldexp(weight, shift.cast_signed())) as i32),
        shift,
    ))
}

/// The links by velocity and acceleration may be negative: a soft loop takes damping from the drive.
const MIN_LINK: f64 = -MAX_GAIN;
/// Beyond any machine; the sum of the weights is the real bound.
const MAX_GAIN: f64 = 1e6;
const MAX_WEIGHT_SHIFT: u32 = 40;

/// A gain as the factor from a signal with `frac` fractional bits to a command.
fn weight(name: &'static str, gain: f64, min: f64, frac: u32) -> Result<f64, RangeError> {
    let gain = checked(name, gain, min, MAX_GAIN)?;
    Ok(libm::ldexp(
        gain,
        Command::FRAC_NBITS
            .cast_signed()
            .wrapping_sub(frac.cast_signed()),
    ))
}

/// `value`·2^`frac` to nearest.
fn scaled(value: f64, frac: u32) -> i32 {
    libm::round(libm::ldexp(value, frac.cast_signed())) as i32
}
