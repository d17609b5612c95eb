//! What was learned, as weights for the tick: the shares of the feedforward, its lead and the changes of the jerk in it.

use super::config::{Config, LEAD_FRAC, WEIGHT_FRAC};
use super::shares::SHARE_FRAC;
use crate::controller::turning::Config as Turning;
use crate::controller::weights::SETPOINTS;
use crate::estimator::saturate;
use crate::narrowing::narrowed;
use crate::setpoint::Setpoint;
use crate::units::{Acceleration, Jerk, Velocity};

/// What has been learned, ready for the tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Addition {
    /// Weights of the setpoint's v, a and j, the lead in them.
    weights: [i32; SETPOINTS],
    turning: Turning,
}

impl Addition {
    /// Nothing.
    pub const NONE: Self = Self {
        weights: [0; SETPOINTS],
        turning: Turning::NONE,
    };

    /// Of `shares`.
    pub fn new(config: &Config, shares: &[i32; 3]) -> Self {
        let mut scaled = [0_i64; SETPOINTS];
        for ((scaled, weight), share) in scaled.iter_mut().zip(config.weights).zip(shares) {
            *scaled = i64::from(weight)
                .wrapping_mul(i64::from(*share))
                .wrapping_shr(SHARE_FRAC);
        }
        let [by_v, by_a, by_j] = scaled;
        let lead = i64::from(config.lead);
        // By τ, from the format of one derivative to that of the next.
        let led = |weight: i64, from: u32, to: u32| {
            weight
                .wrapping_mul(lead)
                .wrapping_shr(LEAD_FRAC.wrapping_add(to).wrapping_sub(from))
        };
        let of_v_by_a = led(by_v, Velocity::FRAC_NBITS, Acceleration::FRAC_NBITS);
        let of_a_by_j = led(by_a, Acceleration::FRAC_NBITS, Jerk::FRAC_NBITS);
        let of_v_by_j = led(of_v_by_a, Acceleration::FRAC_NBITS, Jerk::FRAC_NBITS).wrapping_shr(1);
        let in_jerk =
            |weight: i64, frac: u32| weight.wrapping_shr(Jerk::FRAC_NBITS.wrapping_sub(frac));
        Self {
            weights: [
                saturate(by_v),
                saturate(by_a.wrapping_add(of_v_by_a)),
                saturate(by_j.wrapping_add(of_a_by_j).wrapping_add(of_v_by_j)),
            ],
            turning: Turning::of_weights(
                config.lead,
                saturate(in_jerk(by_v, Velocity::FRAC_NBITS).wrapping_shr(1)),
                saturate(in_jerk(by_a, Acceleration::FRAC_NBITS)),
                saturate(by_j),
            ),
        }
    }

    /// Command for a setpoint, Q.30; saturates.
    #[inline]
    pub fn command(&self, setpoint: &Setpoint, turns: bool) -> i32 {
        let [by_v, by_a, by_j] = self.weights.map(i64::from);
        let sum = by_v
            .wrapping_mul(i64::from(setpoint.velocity.to_bits()))
            .wrapping_add(by_a.wrapping_mul(i64::from(setpoint.acceleration.to_bits())))
            .wrapping_add(by_j.wrapping_mul(i64::from(setpoint.jerk.to_bits())));
        let command = narrowed::<WEIGHT_FRAC>(sum);
        if turns {
            command.saturating_add(self.turning.command(setpoint))
        } else {
            command
        }
    }
}
