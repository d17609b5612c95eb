//! Soft limits of travel, in unwrapped encoder counts, and the guard that stops in time before them.
//!
//! The guard looks one tick ahead: a setpoint is let through only if a stop that begins after it ends within the
//! limits. If it does not, the setpoint before it is where the stop begins; that one was let through, so the stop
//! ends within. Beyond the limits, where an axis may be when they are set, only ways back are let through.

use core::fmt;

use super::Setpoint;
use super::follower::Config;
use crate::supervisor::Fault;
use crate::units::Position;

/// The stretch in which setpoints may lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TravelLimits {
    low: Position,
    high: Position,
}

/// Limits of travel of which the low one is not below the high one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TravelError {
    /// The low limit that was given, d.
    pub low: Position,
    /// The high limit that was given, d.
    pub high: Position,
}

impl fmt::Display for TravelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { low, high } = self;
        write!(
            f,
            "limits of travel from {low} to {high} d leave no way: the low one must be below the high one"
        )
    }
}

impl core::error::Error for TravelError {}

impl TravelLimits {
    /// From `low` to `high`, both in d as the encoder counts, without wrap.
    ///
    /// # Errors
    /// [`TravelError`] unless `low` is below `high`.
    pub const fn new(low: Position, high: Position) -> Result<Self, TravelError> {
        if low.to_bits() < high.to_bits() {
            Ok(Self { low, high })
        } else {
            Err(TravelError { low, high })
        }
    }

    /// The same limits seen from where 0 is `origin`.
    #[must_use]
    pub const fn from_origin(&self, origin: Position) -> Self {
        Self {
            low: self.low.saturating_add(origin),
            high: self.high.saturating_add(origin),
        }
    }

    /// The low limit, d.
    #[must_use]
    pub const fn low(&self) -> Position {
        self.low
    }

    /// The high limit, d.
    #[must_use]
    pub const fn high(&self) -> Position {
        self.high
    }

    /// True if `position` lies within.
    #[must_use]
    pub fn contains(&self, position: Position) -> bool {
        (self.low..=self.high).contains(&position)
    }

    /// Passes on a setpoint that no plan made, or refuses it where it would lead beyond the limits: a stop from the
    /// setpoint before it then ends within.
    ///
    /// # Errors
    /// [`Fault::SoftLimit`]
    #[inline]
    pub fn guard(&self, config: &Config, next: Setpoint) -> Result<Setpoint, Fault> {
        if self.admits(config, &next) {
            Ok(next)
        } else {
            Err(Fault::SoftLimit)
        }
    }

    /// True if a stop within `config` that begins after `next` ends within the limits, or if `next` leads back to
    /// them. An axis that stands may stand anywhere.
    #[must_use]
    pub fn admits(&self, config: &Config, next: &Setpoint) -> bool {
        let velocity = next.velocity.to_bits();
        if (velocity, next.acceleration.to_bits(), next.jerk.to_bits()) == (0, 0, 0) {
            return true;
        }
        let ahead = config.stopping_distance(next);
        let end = next.position.saturating_add(ahead);
        let too_high = ahead > 0 && end > self.high || velocity > 0 && next.position > self.high;
        let too_low = ahead < 0 && end < self.low || velocity < 0 && next.position < self.low;
        !(too_high || too_low)
    }
}
