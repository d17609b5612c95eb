//! Gains of the controller: from fractions of full command per d and tick to integers with one scale.

use super::FollowingError;
use crate::estimator::Delay;
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
    /// Of the following error, its change, the estimates of v and a, the setpoints of v, a and j.
    weights: [i32; TERMS],
    weight_shift: u32,
    /// Half of what is shifted out, and the bias.
    offset: i64,
    deadband: i32,
    pub(super) integral_gain: i32,
    pub(super) transfer_decay: u32,
}

impl Config {
    /// Quantises `gains`; `deadband_d` in d is subtracted from the following error, `bias` in fractions
    /// of full command is added to the output, and a jump of the law decays with a time constant of
    /// `transfer_ticks`. `delay` is that of the estimates that the law will get.
    ///
    /// # Errors
    /// [`RangeError`] naming the parameter that does not fit.
    pub fn new(
        gains: &Gains,
        delay: impl Into<Delay>,
        deadband_d: f64,
        bias: f64,
        transfer_ticks: f64,
    ) -> Result<Self, RangeError> {
        let (weights, weight_shift) = quantise(gains, delay.into())?;
        let integral = checked("integral_gain_per_d_tick", gains.integral, 0.0, 1.9e-3)?;
        let transfer = checked("transfer_ticks", transfer_ticks, 1.0, 1e6)?;
        let bias = scaled(checked("bias", bias, -1.0, 1.0)?, Command::FRAC_NBITS);
        let half = 1_i64.wrapping_shl(weight_shift).wrapping_shr(1);
        let offset = i64::from(bias)
            .wrapping_shl(weight_shift)
            .wrapping_add(half);
        Ok(Self {
            weights,
            weight_shift,
            offset,
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
            transfer_decay: libm::round(libm::ldexp(libm::exp(-1.0 / transfer), 31)) as u32,
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
        let products = self.weights.iter().zip(signals);
        let sum = products.fold(self.offset, |sum, (&weight, &signal)| {
            sum.wrapping_add(i64::from(weight).wrapping_mul(i64::from(signal)))
        });
        sum.wrapping_shr(self.weight_shift)
    }
}

/// Weights in the order of [`Config`]'s field, and their common shift.
///
/// The links' references are written out in v, a and j:
/// kv·(v − lag_v·a + ⟨lag_v²⟩·j/2 − v̂) + ka·(a − lag_a·j − â).
fn quantise(gains: &Gains, delay: Delay) -> Result<([i32; TERMS], u32), RangeError> {
    let link_v = checked("velocity_gain", gains.velocity, -MAX_GAIN, MAX_GAIN)?;
    let link_a = checked("acceleration_gain", gains.acceleration, -MAX_GAIN, MAX_GAIN)?;
    let position = checked("position_gain", gains.position, 0.0, MAX_GAIN)?;
    let derivative = checked("derivative_gain", gains.derivative, 0.0, MAX_GAIN)?;
    let ff_v = checked(
        "velocity_feedforward",
        gains.velocity_feedforward,
        0.0,
        MAX_GAIN,
    )?;
    let ff_a = checked(
        "acceleration_feedforward",
        gains.acceleration_feedforward,
        0.0,
        MAX_GAIN,
    )?;
    let ff_j = checked("jerk_feedforward", gains.jerk_feedforward, 0.0, MAX_GAIN)?;
    let Delay {
        velocity: lag_v,
        velocity_squared: lag_v2,
        acceleration: lag_a,
    } = delay;
    let exact = [
        weight(position, FollowingError::FRAC_NBITS),
        weight(derivative, FollowingError::FRAC_NBITS),
        weight(-link_v, Velocity::FRAC_NBITS),
        weight(-link_a, Acceleration::FRAC_NBITS),
        weight(ff_v + link_v, Velocity::FRAC_NBITS),
        weight(ff_a + link_a - lag_v * link_v, Acceleration::FRAC_NBITS),
        weight(
            ff_j + 0.5 * lag_v2 * link_v - lag_a * link_a,
            Jerk::FRAC_NBITS,
        ),
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

/// Beyond any machine; the sum of the weights is the real bound. The links by velocity and acceleration
/// may be negative: a soft loop takes damping from the drive.
const MAX_GAIN: f64 = 1e6;
/// The bias takes 31 of 63 bits.
const MAX_WEIGHT_SHIFT: u32 = 31;

/// A gain as the factor from a signal with `frac` fractional bits to a command.
fn weight(gain: f64, frac: u32) -> f64 {
    libm::ldexp(
        gain,
        Command::FRAC_NBITS
            .cast_signed()
            .wrapping_sub(frac.cast_signed()),
    )
}

/// `value`·2^`frac` to nearest.
fn scaled(value: f64, frac: u32) -> i32 {
    libm::round(libm::ldexp(value, frac.cast_signed())) as i32
}
