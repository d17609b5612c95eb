//! From physical parameters to the integers of the tick.

use super::classes::{JERK_FRAC, Response, quantised, variance};
use super::gains;
use super::motion::FINE_FRAC;
use super::params::ObserverParams;
use super::per_tick::PerTick;
use crate::estimator::{Delay, Lags, Variances};
use crate::parameter_table::ParameterTable;
use crate::units::{AxisScale, Lag, RangeError};

/// Largest slope of the long wave; beyond it places would come to lie in another order.
const MOST_SLOPE: f64 = 0.0624;
/// Largest curvature of the long wave, 1/d.
const MOST_CURVATURE: f64 = 1.5e-5;
/// Fractional bits of a normalised innovation.
pub const SIGMA_FRAC: u32 = 8;
/// Most ticks of transport delay.
pub const MAX_DELAY: usize = 63;

/// When the model changes, and what is rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Supervision {
    /// Silence that is rest, ticks.
    pub rest_ticks: u32,
    /// Jerk of the model that ends an assumed rest, as a state.
    pub release_jerk: i64,
    /// Mean square of the normalised innovation at which the drive's model is given up.
    pub fallback_level: i32,
    /// Ticks for which it is to be exceeded.
    pub fallback_ticks: u32,
    /// Error of the predicted acceleration, as a state.
    pub return_acceleration: i64,
    /// Ticks for which the prediction is to be that good.
    pub return_ticks: u32,
}

/// Models and thresholds. Its [`Gains`](super::Gains) follow from it and take long to solve for, so that a
/// configuration itself is small and soon made.
// What every tick needs comes first.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Config {
    pub(super) response: Response,
    pub(super) supervision: Supervision,
    /// Variances at rest.
    pub(super) rest_variances: Variances,
    /// Velocity error a velocity that the long wave makes, Q.36.
    pub(super) wave_slope: u32,
    /// Acceleration error by the square of a velocity that it makes, 1/d, Q.48.
    pub(super) wave_curvature: u32,
    /// What gains are solved from.
    pub(super) per_tick: PerTick,
}

impl Config {
    /// An observer of the axis of `params` and `scale`.
    ///
    /// # Errors
    /// [`RangeError`] for a parameter out of range, a natural period outside 8 to 20 000 ticks, or a
    /// delay beyond 63.
    #[inline(never)]
    pub fn new(params: &ObserverParams, scale: AxisScale) -> Result<Self, RangeError> {
        params.check()?;
        let per_tick = PerTick::new(params, scale)?;
        let rate = scale.tick_hz();
        let wave_number = core::f64::consts::TAU / scale.counts_from_mm(params.map_wave_mm);
        let slope = params.map_residual_d * wave_number;
        let rest_ticks = (params.rest_s * rate).max(2.0);
        Ok(Self {
            response: Response::new(params, &per_tick, rate)?,
            supervision: Supervision::new(params, &per_tick, scale),
            rest_variances: Variances {
                velocity: variance(1.0 / (3.0 * rest_ticks * rest_ticks)),
                acceleration: variance(1.0 / libm::pow(rest_ticks, 4.0)),
            },
            wave_slope: libm::ldexp(slope.min(MOST_SLOPE), 36) as u32,
            wave_curvature: libm::ldexp((slope * wave_number).min(MOST_CURVATURE), 48) as u32,
            per_tick,
        })
    }

    /// The observer of the 16K20F3's longitudinal axis at 1 kHz.
    ///
    /// # Errors
    /// None: the parameters are within their ranges, which a test checks.
    pub fn of_16k20f3() -> Result<Self, RangeError> {
        Self::new(&ObserverParams::default(), AxisScale::new(1000.0, 1000.0)?)
    }

    /// Lags where the drive's command is known: none, as long as its model is right.
    pub(in crate::estimator) const fn lags(&self) -> Lags {
        Lags {
            position: Lag::ZERO,
            velocity: Lag::ZERO,
            acceleration: Lag::ZERO,
        }
    }

    pub(in crate::estimator) fn delay(&self) -> Delay {
        Delay::from(&self.lags())
    }

    /// Solves for the gains, to know how long they take to forget.
    pub(in crate::estimator) fn warm_up_ticks(&self) -> u32 {
        gains::warm_up_ticks(self)
    }

    /// Coefficients k₁, /tick², and k₂, /tick, of the drive's jerk, as quantised.
    #[must_use]
    pub fn jerk_coefficients(&self) -> [f64; 2] {
        let Response {
            stiffness,
            damping,
            multiplier,
            ..
        } = self.response;
        let frac = JERK_FRAC
            .wrapping_sub(multiplier.trailing_zeros())
            .cast_signed();
        [
            libm::ldexp(f64::from(stiffness), frac.wrapping_neg()),
            libm::ldexp(f64::from(damping), 4_i32.wrapping_sub(frac)),
        ]
    }
}

impl Supervision {
    fn new(params: &ObserverParams, per_tick: &PerTick, scale: AxisScale) -> Self {
        let rate = scale.tick_hz();
        let release = params.release_mm_per_min * scale.counts_per_mm() / (rate * 60.0);
        let state = |value: f64| libm::ldexp(value.min(100.0), FINE_FRAC as i32) as i64;
        let level = params.fallback_sigmas * params.fallback_sigmas;
        Self {
            rest_ticks: (params.rest_s * rate).max(2.0) as u32,
            release_jerk: state(per_tick.stiffness * release),
            fallback_level: quantised(level, 2 * SIGMA_FRAC),
            fallback_ticks: (params.fallback_s * rate) as u32,
            return_acceleration: state(scale.acceleration_from_m_s2(params.return_m_s2)),
            return_ticks: (params.return_s * rate) as u32,
        }
    }
}
