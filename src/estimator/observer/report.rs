//! The state as an estimate, with its lags and uncertainty.

use super::classes::Class;
use super::{Estimator, Model};
use crate::capture::Observation;
use crate::estimator::{Estimate, Lags, Variances};
use crate::units::{Acceleration, Lag, Position, Variance, Velocity};

impl Estimator {
    #[inline]
    pub(super) fn estimate(&self, observation: &Observation<'_>) -> Estimate {
        let base = observation.count.wrapping_shl(Position::FRAC_NBITS);
        let drive = self.supervisor.model() == Model::Drive;
        let velocity = self.motion.velocity_q20();
        let class = self.config.class(drive, self.octave);
        let resting = self.silence >= self.config.supervision.rest_ticks;
        let variances = if resting {
            self.config.rest_variances
        } else {
            self.with_long_wave(class, velocity)
        };
        let at_rest = resting && self.motion.velocity == 0;
        Estimate {
            position: Position::from_bits(base.wrapping_add(self.motion.position_q16())),
            velocity: Velocity::from_bits(velocity),
            acceleration: Acceleration::from_bits(self.motion.acceleration_q24()),
            lags: Lags {
                position: Lag::ZERO,
                velocity: Lag::ZERO,
                acceleration: if at_rest { Lag::ZERO } else { class.lag },
            },
            variances,
        }
    }

    /// The variances of a class, and what the map's residual of long wave adds at a velocity in Q11.20.
    #[inline]
    fn with_long_wave(&self, class: &Class, velocity: i32) -> Variances {
        let speed = velocity.unsigned_abs();
        let slope = u64::from(self.config.wave_slope);
        // Q20 · Q24 for 24, and times Q32 once more.
        let of_velocity = u64::from(speed).wrapping_mul(slope).wrapping_shr(20) as u32;
        let wave = u64::from(speed).wrapping_mul(u64::from(self.config.wave_number));
        let wave = wave.wrapping_shr(20) as u32;
        let of_acceleration = u64::from(of_velocity)
            .wrapping_mul(u64::from(wave))
            .wrapping_shr(32) as u32;
        Variances {
            velocity: added(class.variances.velocity, of_velocity),
            acceleration: added(class.variances.acceleration, of_acceleration),
        }
    }
}

/// Largest deviation by the long wave, 128 in Q8.24: its square and the variance of a class fit their format.
const MOST_DEVIATION: u32 = 1 << 31;

/// `variance` and the square of a deviation in Q8.24.
#[inline]
fn added(variance: Variance, deviation: u32) -> Variance {
    let deviation = if deviation > MOST_DEVIATION {
        MOST_DEVIATION
    } else {
        deviation
    };
    let square = u64::from(deviation).wrapping_mul(u64::from(deviation));
    Variance::from_bits(variance.to_bits().wrapping_add(square))
}
