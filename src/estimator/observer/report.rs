//! The state as an estimate, with its lags, and its uncertainty.

use super::config::Config;
use super::gains::Solved;
use super::{Model, State};
use crate::capture::Observation;
use crate::estimator::{Estimate, Lags, Variances};
use crate::units::{Acceleration, Lag, Position, Variance, Velocity};

impl State {
    #[inline]
    pub(super) const fn estimate(
        &self,
        observation: &Observation<'_>,
        lag: Lag,
        estimate: &mut Estimate,
    ) {
        let base = observation.count.wrapping_shl(Position::FRAC_NBITS);
        let motion = &self.motion;
        *estimate = Estimate {
            position: Position::from_bits(base.wrapping_add(motion.position_q16() as i64)),
            velocity: Velocity::from_bits(motion.velocity_q20()),
            acceleration: Acceleration::from_bits(motion.acceleration_q24()),
            lags: Lags {
                position: Lag::ZERO,
                velocity: Lag::ZERO,
                acceleration: lag,
            },
        };
    }

    /// How uncertain the newest estimate is.
    pub(super) fn variances(&self, solved: &Solved) -> Variances {
        if self.is_resting(&solved.config) {
            return solved.config.rest_variances;
        }
        let drive = self.supervisor.model() == Model::Drive;
        let class = solved.gains.class(drive, self.class);
        solved
            .config
            .with_long_wave(&class.variances, self.motion.velocity_q20())
    }

    /// The silence is long enough to be rest.
    pub(super) const fn is_resting(&self, config: &Config) -> bool {
        self.silence >= config.supervision.rest_ticks
    }
}

impl Config {
    /// `variances`, and what the map's residual of long wave adds at a velocity in Q11.20.
    const fn with_long_wave(&self, variances: &Variances, velocity: i32) -> Variances {
        let speed = velocity.unsigned_abs();
        // Q20 · Q36 for 24; Q20 · Q20 for 8, and that by Q48 for 24 again.
        let of_velocity = high_product(speed, self.wave_slope);
        let of_acceleration = high_product(high_product(speed, speed), self.wave_curvature);
        Variances {
            velocity: added(variances.velocity, of_velocity),
            acceleration: added(variances.acceleration, of_acceleration),
        }
    }
}

/// The high word of a product.
#[inline]
const fn high_product(one: u32, other: u32) -> u32 {
    (one as u64).wrapping_mul(other as u64).wrapping_shr(32) as u32
}

/// `variance` and the square of a deviation in Q8.24, at most 128 as the formats of slope and curvature are.
#[inline]
const fn added(variance: Variance, deviation: u32) -> Variance {
    let square = (deviation as u64).wrapping_mul(deviation as u64);
    Variance::from_bits(variance.to_bits().wrapping_add(square))
}
