//! What the noise of the edges makes of a fit: its variances, made when they are asked for.

use super::Answer;
use super::TIME_FRAC;
use super::config::Config;
use super::found::{middle_of, middle_of_regular};
use super::geometry::{GAIN_FRAC, Gains, Geometry};
use super::window::Window;
use crate::estimator::Variances;
use crate::uncertainty::{EdgeNoise, PLACE_FRAC};
use crate::units::Variance;

/// What a window makes of the noise of its edges.
pub struct Spread {
    /// Time from the samples' middle to the sampling instant, ticks with [`TIME_FRAC`] fractional bits.
    behind: i32,
    /// Weights of the samples, added up.
    weight: u32,
    /// Edges in the window.
    edges: u32,
    /// At the middle, per d² of a sample of weight 1.
    gains: Gains,
}

impl Spread {
    /// Of the window as the last tick left it; `now` is the sampling instant from its origin.
    pub fn of(config: &Config, window: &Window, now: i32) -> Self {
        let edges = window.edges();
        if let Some(step) = window.regular_step(config) {
            return Self {
                behind: now.wrapping_sub(middle_of_regular(config, step)),
                weight: window.count() as u32,
                edges,
                gains: config.regular.gains,
            };
        }
        let sums = window.sums();
        let geometry = Geometry::of(&sums);
        Self {
            behind: now.wrapping_sub(middle_of(&geometry)),
            weight: sums.weight.cast_unsigned(),
            edges,
            gains: geometry.gains(sums.weight),
        }
    }

    /// Variance of the velocity at the sampling instant: at the middle it is independent of the acceleration's.
    fn newest_gain(&self) -> u32 {
        const COARSE: u32 = TIME_FRAC - 8;
        let ticks = self.behind.wrapping_shr(COARSE).cast_unsigned();
        let square = ticks.wrapping_mul(ticks);
        let of_bend = u64::from(square)
            .wrapping_mul(u64::from(self.gains.acceleration))
            .wrapping_shr(16);
        self.gains.velocity.wrapping_add(of_bend as u32)
    }

    /// Variances of what is answered, at `velocity` (Q12.20 d/tick): the noise of a sample of weight 1 is that of an edge,
    /// over the edges to each weight.
    pub fn variances(&self, answer: Answer, velocity: i32, noise: &EdgeNoise) -> Variances {
        // 24 significant bits, so that weights of 256 fit and many edges leave some.
        const SPARE_BITS: u32 = 8;
        const FRAC: u32 = PLACE_FRAC + GAIN_FRAC - SPARE_BITS - Variance::FRAC_NBITS;
        let of_edge = noise.of_edge(velocity);
        let lead = of_edge.leading_zeros() & 31;
        let of_sample = of_edge
            .wrapping_shl(lead)
            .wrapping_shr(SPARE_BITS)
            .wrapping_mul(self.weight)
            .checked_div(self.edges)
            .unwrap_or(0);
        let of_samples = |gain: u32| {
            let product = u64::from(of_sample).wrapping_mul(u64::from(gain));
            Variance::from_bits(product.wrapping_shr(FRAC.wrapping_add(lead)))
        };
        let gain = match answer {
            Answer::Centre => self.gains.velocity,
            Answer::Newest => self.newest_gain(),
        };
        Variances {
            velocity: of_samples(gain).wrapping_add(noise.of_velocity(velocity)),
            acceleration: of_samples(self.gains.acceleration)
                .wrapping_add(noise.of_acceleration(velocity)),
        }
    }
}
