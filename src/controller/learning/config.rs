//! What is learned, against what, and from which motion.

use super::shares::COVARIANCE_FRAC;
use super::{TERM_FRAC, TERM_SHIFT};
use crate::controller::config::Gains;
use crate::controller::weights::{SETPOINTS, weight};
use crate::estimator::{Delay, saturate};
use crate::units::{Acceleration, Jerk, RangeError, Velocity, checked};

/// Fractional bits of the weights beyond those of a command.
pub(super) const WEIGHT_FRAC: u32 = 20;
/// Fractional bits of the lead.
pub(super) const LEAD_FRAC: u32 = 8;

/// Least speed that is learned from, of that at full command.
const LEAST_SPEED: f64 = 0.02;
/// Longest delay, ticks.
const MAX_DELAY: f64 = 63.0;

/// Quantised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Config {
    /// Full command per signal's unit of v, a and j, with [`WEIGHT_FRAC`] more bits than a command; zero: nothing is learned.
    pub(super) weights: [i32; SETPOINTS],
    /// How far ahead the feedforward is, ticks, Q.8.
    pub(super) lead: u32,
    /// Ticks of delay of the command.
    pub(super) delay: usize,
    /// Bias, with [`TERM_FRAC`].
    pub(super) bias: i32,
    /// Least speed of the setpoint, Q11.20.
    pub(super) least_speed: u32,
    /// Square of the noise, with [`COVARIANCE_FRAC`].
    pub(super) noise: i32,
}

impl Config {
    /// Learning of the feedforward of `gains` from estimates of `delay`, against a `noise` (1σ) and with a `bias` in fractions of
    /// full command. None with a noise of 0.
    ///
    /// # Errors
    /// [`RangeError`] for estimates that lag, a full-command speed below 1 d/tick, or a delay beyond 63 ticks.
    pub fn new(gains: &Gains, delay: Delay, bias: f64, noise: f64) -> Result<Self, RangeError> {
        if checked("learning_noise", noise, 0.0, 0.1)? == 0.0 {
            return Ok(Self::default());
        }
        let lag = delay.velocity.max(delay.acceleration);
        checked(
            "lag of the estimates that are learned from, ticks",
            lag,
            0.0,
            0.0,
        )?;
        let by_v = checked(
            "velocity_feedforward, per d/tick",
            gains.velocity_feedforward,
            1e-6,
            1.0,
        )?;
        let by_a = checked(
            "acceleration_feedforward, per d/tick²",
            gains.acceleration_feedforward,
            0.0,
            10.0,
        )?;
        let by_j = checked(
            "jerk_feedforward, per d/tick³",
            gains.jerk_feedforward,
            0.0,
            500.0,
        )?;
        let lead = checked(
            "feedforward_lead_ticks",
            gains.feedforward_lead,
            0.0,
            MAX_DELAY,
        )?;
        let fixed =
            |value: f64, frac: u32| libm::round(libm::ldexp(value, frac.cast_signed())) as i32;
        let scaled = |gain: f64, frac: u32| fixed(weight(gain, frac), WEIGHT_FRAC);
        Ok(Self {
            weights: [
                scaled(by_v, Velocity::FRAC_NBITS),
                scaled(by_a, Acceleration::FRAC_NBITS),
                scaled(by_j, Jerk::FRAC_NBITS),
            ],
            lead: fixed(lead, LEAD_FRAC) as u32,
            delay: libm::floor(lead) as usize,
            bias: fixed(bias, TERM_FRAC),
            least_speed: fixed(LEAST_SPEED / by_v, Velocity::FRAC_NBITS) as u32,
            noise: fixed(noise * noise, COVARIANCE_FRAC).max(1),
        })
    }

    /// There is something to do.
    #[inline]
    #[must_use]
    pub const fn is_on(&self) -> bool {
        self.noise != 0
    }

    /// Whole ticks of the lead.
    pub(in crate::controller) const fn horizon(&self) -> u32 {
        self.lead.wrapping_shr(LEAD_FRAC)
    }

    /// Terms of v, a and j in command, with [`TERM_FRAC`].
    pub(super) fn terms(&self, signals: [i32; SETPOINTS]) -> [i32; SETPOINTS] {
        let mut terms = [0; SETPOINTS];
        for ((term, weight), signal) in terms.iter_mut().zip(self.weights).zip(signals) {
            let product = i64::from(weight).wrapping_mul(i64::from(signal));
            *term = saturate(product.wrapping_shr(WEIGHT_FRAC + TERM_SHIFT));
        }
        terms
    }
}
