//! What a fit came to, whichever way it was made.

use super::config::Config;
use super::fit::{Fit, wide};
use super::geometry::{Geometry, MIDDLE_FRAC};
use super::window::Window;
use super::{GRID_BITS, Motion, STEPS, TIME_FRAC};
use crate::estimator::shift_rounded;
use crate::units::Position;

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
}

impl Found {
    /// Of a full window of samples one a tick, the newest at `step` from the origin; `now` is the sampling instant from
    /// there.
    #[inline]
    pub fn regular(config: &Config, window: &Window, step: i32, now: i32) -> Self {
        let regular = &config.regular;
        let sums = window.regular();
        let (velocity, acceleration) = regular.motion(sums);
        Self {
            place: regular.place(sums, acceleration),
            velocity,
            acceleration,
            behind: now.wrapping_sub(middle_of_regular(config, step)),
            is_curved: true,
        }
    }

    /// Of samples wherever they stand; `motion` is about what is to be expected.
    pub fn anywhere(window: &Window, motion: Motion, now: i32) -> Self {
        let sums = window.sums();
        let geometry = Geometry::of(&sums);
        let gained = wide(motion.acceleration, now).wrapping_shr(24 + TIME_FRAC - 20) as i32;
        let expected = motion.newest.wrapping_sub(gained);
        let fit = Fit::new(&sums, &geometry, expected, motion.acceleration);
        let middle = middle_of(&geometry);
        let velocity = later(fit.velocity, fit.acceleration, middle);
        Self {
            place: fit
                .place
                .wrapping_add(trapezium(fit.velocity, velocity, middle)),
            velocity,
            acceleration: fit.acceleration,
            behind: now.wrapping_sub(middle),
            is_curved: geometry.by_spread.is_some(),
        }
    }

    /// Velocity at the sampling instant, Q12.20 d/tick.
    #[inline]
    pub fn newest(&self) -> i32 {
        later(self.velocity, self.acceleration, self.behind)
    }
}

/// Middle of a regular window, ticks from the window's origin with [`TIME_FRAC`] fractional bits: half a window less
/// half a tick before the newest sample, which is at `step`.
#[inline]
pub const fn middle_of_regular(config: &Config, step: i32) -> i32 {
    step.wrapping_shl(1)
        .wrapping_sub(config.window_steps)
        .wrapping_add(STEPS)
        .wrapping_shl(TIME_FRAC - GRID_BITS - 1)
}

/// Middle of samples anywhere, likewise.
#[inline]
pub const fn middle_of(geometry: &Geometry) -> i32 {
    geometry
        .middle
        .wrapping_shl(TIME_FRAC - GRID_BITS - MIDDLE_FRAC)
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
