//! The law's sums: gains as integers with one power of two for all of a sum.
//!
//! It is chosen as large as the sum of their magnitudes allows; the sum of the products then cannot overflow, and one shift at
//! the end serves all of them.

use super::FollowingError;
use super::config::Gains;
use super::integral::INTEGRAL_SHIFT;
use crate::estimator::Delay;
use crate::narrowing::Narrowing;
use crate::units::{Acceleration, Command, Jerk, RangeError, Velocity, checked};

/// Weighted inputs of the law, the integral apart: those of the feedback part, the setpoints last.
pub(super) const TERMS: usize = 7;
/// Weighted inputs of the feedforward part: the setpoints.
pub(super) const SETPOINTS: usize = 3;

/// Weights of the law, by one of its sets of gains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct GainSet {
    /// Of the following error, its change, the estimates of v and a, the setpoints of v, a and j. Without filters the
    /// feedforward is in the latter.
    weights: [i32; TERMS],
    narrowing: Narrowing,
    /// Half of what is shifted out, and without filters the bias.
    offset: i64,
    pub(super) integral_gain: i32,
}

impl GainSet {
    pub(super) fn new(
        gains: &Gains,
        delay: Delay,
        within: [f64; SETPOINTS],
        bias: i64,
    ) -> Result<Self, RangeError> {
        let (weights, shift) = quantise(&with_feedforward(feedback(gains, delay)?, within))?;
        let integral = checked("integral_gain_per_d_tick", gains.integral, 0.0, 1.9e-3)?;
        Ok(Self {
            weights,
            narrowing: Narrowing::by(shift),
            offset: shifted(bias, shift),
            integral_gain: scaled(
                integral,
                Command::FRAC_NBITS
                    .wrapping_add(INTEGRAL_SHIFT)
                    .wrapping_sub(FollowingError::FRAC_NBITS),
            ),
        })
    }

    /// Weighted sum of the signals and `more`, Q.30, without filters with the bias; saturates. The weights add up to less than 2³¹, so
    /// the sum of products stays within ±2⁶².
    #[inline]
    pub(super) fn weigh(&self, signals: &[i32; TERMS], more: i32) -> i32 {
        self.narrowing
            .apply_and_add(weighed(&self.weights, signals, self.offset), more)
    }
}

#[inline]
pub(super) fn weighed<const N: usize>(weights: &[i32; N], signals: &[i32; N], offset: i64) -> i64 {
    let products = weights.iter().zip(signals);
    products.fold(offset, |sum, (&weight, &signal)| {
        sum.wrapping_add(i64::from(weight).wrapping_mul(i64::from(signal)))
    })
}

/// `bias` before a shift, and half of what is shifted out.
pub(super) const fn shifted(bias: i64, shift: u32) -> i64 {
    let half = 1_i64.wrapping_shl(shift).wrapping_shr(1);
    bias.wrapping_shl(shift).wrapping_add(half)
}

/// Weights of the feedback part in the order of [`Config`]'s field.
///
/// The links' references are written out in v, a and j:
/// kv·(v − lag_v·a + ⟨lag_v²⟩·j/2 − v̂) + ka·(a − lag_a·j − â).
fn feedback(gains: &Gains, delay: Delay) -> Result<[f64; TERMS], RangeError> {
    let link_v = checked("velocity_gain", gains.velocity, -MAX_GAIN, MAX_GAIN)?;
    let link_a = checked("acceleration_gain", gains.acceleration, -MAX_GAIN, MAX_GAIN)?;
    let position = checked("position_gain", gains.position, 0.0, MAX_GAIN)?;
    let derivative = checked("derivative_gain", gains.derivative, 0.0, MAX_GAIN)?;
    let Delay {
        velocity: lag_v,
        velocity_squared: lag_v2,
        acceleration: lag_a,
    } = delay;
    Ok([
        weight(position, FollowingError::FRAC_NBITS),
        weight(derivative, FollowingError::FRAC_NBITS),
        weight(-link_v, Velocity::FRAC_NBITS),
        weight(-link_a, Acceleration::FRAC_NBITS),
        weight(link_v, Velocity::FRAC_NBITS),
        weight(link_a - lag_v * link_v, Acceleration::FRAC_NBITS),
        weight(0.5 * lag_v2 * link_v - lag_a * link_a, Jerk::FRAC_NBITS),
    ])
}

/// Weights of the setpoints of v, a and j in the feedforward, which is τ ahead of them:
/// ff_v·(v + τ·a + τ²·j/2) + ff_a·(a + τ·j) + ff_j·j.
pub(super) fn feedforward(gains: &Gains) -> Result<[f64; SETPOINTS], RangeError> {
    let of = |name, gain| checked(name, gain, 0.0, MAX_GAIN);
    let by_v = of("velocity_feedforward", gains.velocity_feedforward)?;
    let by_a = of("acceleration_feedforward", gains.acceleration_feedforward)?;
    let by_j = of("jerk_feedforward", gains.jerk_feedforward)?;
    let lead = checked("feedforward_lead_ticks", gains.feedforward_lead, 0.0, 1e4)?;
    Ok([
        weight(by_v, Velocity::FRAC_NBITS),
        weight(by_a + lead * by_v, Acceleration::FRAC_NBITS),
        weight(
            by_j + lead * by_a + 0.5 * lead * lead * by_v,
            Jerk::FRAC_NBITS,
        ),
    ])
}

/// All in one sum, for a law without filters.
fn with_feedforward(feedback: [f64; TERMS], feedforward: [f64; SETPOINTS]) -> [f64; TERMS] {
    let [e, d, v, a, set_v, set_a, set_j] = feedback;
    let [by_v, by_a, by_j] = feedforward;
    [e, d, v, a, set_v + by_v, set_a + by_a, set_j + by_j]
}

/// Weights as integers with a common power of two, as large as the sum of their magnitudes allows.
pub(super) fn quantise<const N: usize>(exact: &[f64; N]) -> Result<([i32; N], u32), RangeError> {
    let total: f64 = exact.iter().map(|weight| libm::fabs(*weight)).sum();
    // Rounding adds at most half a unit to each weight.
    let room = f64::from(i32::MAX) - N as f64;
    checked("sum of the controller's gains", total, 0.0, room / 2.0)?;
    let mut shift = 1_u32;
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
pub(super) fn weight(gain: f64, frac: u32) -> f64 {
    libm::ldexp(
        gain,
        Command::FRAC_NBITS
            .cast_signed()
            .wrapping_sub(frac.cast_signed()),
    )
}

/// `value`·2^`frac` to nearest.
#[inline(never)]
pub(super) fn scaled(value: f64, frac: u32) -> i32 {
    libm::round(libm::ldexp(value, frac.cast_signed())) as i32
}
