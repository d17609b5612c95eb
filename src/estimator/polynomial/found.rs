//! What a fit came to, whichever way it was made.

use super::config::Config;
use super::fit::{Fit, wide};
use super::geometry::{GAIN_FRAC, Geometry, MIDDLE_FRAC};
use super::window::Window;
use super::{GRID_BITS, Motion, STEPS, TIME_FRAC};
use crate::estimator::{Variances, shift_rounded};
use crate::uncertainty::{EdgeNoise, PLACE_FRAC};
use crate::units::{Position, Variance};

/// A fit at its samples' middle.
pub struct Found {
    /// Q.16 d from the count.
    pub place: i64,
    /// Q12.20 d/tick.
    pub velocity: i32,
    /// Q8.24 d/tick².
    pub acceleration: i32,
    /// Time from the middle to the sampling instant, ticks with [`TIME_FRAC`] fractional bits.
    pub behind: i32,
    /// It is a quadratic, not a line.
    pub is_curved: bool,
    /// Weights of the samples, added up.
    weight: u32,
    /// Variance of the velocity per d² of a sample of weight 1, [`GAIN_FRAC`].
    pub velocity_gain: u32,
    /// Variance of the acceleration, likewise.
    acceleration_gain: u32,
}

impl Found {
    /// Of a full window of samples one a tick, the newest at `step` from the origin; `now` is the sampling instant from
    /// there.
    #[inline]
    pub fn regular(config: &Config, window: &Window, step: i32, now: i32) -> Self {
        let regular = &config.regular;
        let ages = window.ages();
        let (velocity, acceleration) = regular.motion(ages);
        // Half a window less half a tick before the newest sample.
        let middle = step
            .wrapping_shl(1)
            .wrapping_sub(config.window_steps)
            .wrapping_add(STEPS)
            .wrapping_shl(TIME_FRAC - GRID_BITS - 1);
        Self {
            place: regular.place(ages, acceleration),
            velocity,
            acceleration,
            behind: now.wrapping_sub(middle),
            is_curved: true,
            weight: window.count() as u32,
            velocity_gain: regular.velocity_gain,
            acceleration_gain: regular.acceleration_gain,
        }
    }

    /// Of samples wherever they stand; `motion` is about what is to be expected.
    pub fn anywhere(window: &Window, motion: Motion, now: i32) -> Self {
        let sums = window.sums();
        let geometry = Geometry::of(&sums);
        let gained = wide(motion.acceleration, now).wrapping_shr(24 + TIME_FRAC - 20) as i32;
        let expected = motion.newest.wrapping_sub(gained);
        let fit = Fit::new(&sums, &geometry, expected, motion.acceleration);
        let middle = geometry
            .middle
            .wrapping_shl(TIME_FRAC - GRID_BITS - MIDDLE_FRAC);
        let velocity = later(fit.velocity, fit.acceleration, middle);
        Self {
            place: fit
                .place
                .wrapping_add(trapezium(fit.velocity, velocity, middle)),
            velocity,
            acceleration: fit.acceleration,
            behind: now.wrapping_sub(middle),
            is_curved: geometry.by_spread.is_some(),
            weight: sums.weight.cast_unsigned(),
            velocity_gain: geometry.velocity_gain,
            acceleration_gain: geometry.acceleration_gain,
        }
    }

    /// Velocity at the sampling instant, Q12.20 d/tick.
    #[inline]
    pub fn newest(&self) -> i32 {
        later(self.velocity, self.acceleration, self.behind)
    }

    /// Variance of the velocity at the sampling instant: at the middle it is independent of the acceleration's.
    #[inline]
    pub fn newest_gain(&self) -> u32 {
        const COARSE: u32 = TIME_FRAC - 8;
        let ticks = self.behind.wrapping_shr(COARSE).cast_unsigned();
        let square = ticks.wrapping_mul(ticks);
        let of_bend = u64::from(square)
            .wrapping_mul(u64::from(self.acceleration_gain))
            .wrapping_shr(16);
        self.velocity_gain.wrapping_add(of_bend as u32)
    }

    /// Variances, of a velocity with that gain, at `velocity` (Q12.20 d/tick) and `edges` in the window: the noise of a
    /// sample of weight 1 is that of an edge, over the edges to each weight.
    #[inline]
    pub fn variances(&self, gain: u32, velocity: i32, edges: u32, noise: &EdgeNoise) -> Variances {
        // 24 significant bits, so that weights of 256 fit and many edges leave some.
        const SPARE_BITS: u32 = 8;
        const FRAC: u32 = PLACE_FRAC + GAIN_FRAC - SPARE_BITS - Variance::FRAC_NBITS;
        let of_edge = noise.of_edge(velocity);
        let lead = of_edge.leading_zeros() & 31;
        let of_sample = of_edge
            .wrapping_shl(lead)
            .wrapping_shr(SPARE_BITS)
            .wrapping_mul(self.weight)
            .checked_div(edges)
            .unwrap_or(0);
        let of_samples = |gain: u32| {
            let product = u64::from(of_sample).wrapping_mul(u64::from(gain));
            Variance::from_bits(product.wrapping_shr(FRAC.wrapping_add(lead)))
        };
        Variances {
            velocity: of_samples(gain).wrapping_add(noise.of_velocity(velocity)),
            acceleration: of_samples(self.acceleration_gain)
                .wrapping_add(noise.of_acceleration(velocity)),
        }
    }
}

/// A velocity a time later, Q12.20 d/tick.
#[inline]
const fn later(velocity: i32, acceleration: i32, time: i32) -> i32 {
    let gained = shift_rounded(wide(acceleration, time), 24 + TIME_FRAC - 20) as i32;
    velocity.saturating_add(gained)
}

/// Way, Q.16 d, while the velocity goes evenly from one to the other (Q12.20 d/tick) in a time with [`TIME_FRAC`] bits.
#[inline]
pub const fn trapezium(from: i32, to: i32, time: i32) -> i64 {
    let mean = from.wrapping_shr(1).wrapping_add(to.wrapping_shr(1));
    wide(mean, time).wrapping_shr(20 + TIME_FRAC - Position::FRAC_NBITS)
}
