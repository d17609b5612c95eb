//! Limits of motion.

use crate::narrowing::within_or_high;
use crate::units::{Acceleration, Jerk, RangeError, Velocity, checked};

/// The slowest limit of velocity: 100 LSB.
const SLOWEST: Velocity = Velocity::from_bits(100);

/// Limits of motion, each on the grid of its output format, so that rounding cannot pass them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    velocity: Velocity,
    acceleration: Acceleration,
    jerk: Jerk,
}

impl Limits {
    /// Limits from d/tick, d/tick² and d/tick³, rounded down to the grid of the formats.
    ///
    /// # Errors
    /// [`RangeError`] for a limit that is below 100 LSB (1 LSB for the jerk) or beyond the format.
    pub fn new(velocity: f64, acceleration: f64, jerk: f64) -> Result<Self, RangeError> {
        Ok(Self {
            velocity: Velocity::from_bits(rounded_down(
                checked("max_velocity_d_per_tick", velocity, 1e-4, 2047.0)?,
                Velocity::FRAC_NBITS,
            )),
            acceleration: Acceleration::from_bits(rounded_down(
                checked("max_acceleration_d_per_tick2", acceleration, 6e-6, 127.0)?,
                Acceleration::FRAC_NBITS,
            )),
            jerk: Jerk::from_bits(rounded_down(
                checked("max_jerk_d_per_tick3", jerk, 2e-9, 3.9)?,
                Jerk::FRAC_NBITS,
            )),
        })
    }

    /// The same with a largest velocity of `velocity`, if that is less and not below 100 LSB.
    #[must_use]
    pub fn slowed(&self, velocity: Velocity) -> Self {
        Self {
            velocity: within_or_high(velocity, SLOWEST.min(self.velocity), self.velocity),
            ..*self
        }
    }

    /// Largest velocity.
    #[must_use]
    pub const fn velocity(&self) -> Velocity {
        self.velocity
    }

    /// Largest acceleration.
    #[must_use]
    pub const fn acceleration(&self) -> Acceleration {
        self.acceleration
    }

    /// Largest jerk.
    #[must_use]
    pub const fn jerk(&self) -> Jerk {
        self.jerk
    }
}

/// `value`·2^`frac` rounded down; the limits checked above fit.
fn rounded_down(value: f64, frac: u32) -> i32 {
    libm::floor(libm::ldexp(value, frac.cast_signed())) as i32
}
