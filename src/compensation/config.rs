//! How fast the compensation may go, and what that leaves to the setpoint.

use core::fmt;

use super::table::{Extreme, ScrewError, ScrewTable};
use crate::parameter_table;
use crate::parameter_table::ParameterTable;
use crate::setpoint::profile::Limits;
use crate::units::{Acceleration, AxisScale, Position, RangeError, Velocity, checked};

parameter_table! {
    /// Compensation of the screw. It takes a share of the axis's limits for itself, by which the setpoints get less,
    /// but only where it is used: with backlash, or with a screw error table.
    pub struct CompensationParams {
        /// Lost motion between encoder and carriage, taken up at each reversal
        backlash_mm: 0.0, "mm", 0.0..=0.5;
        /// A screw error table is used: 0 no, 1 yes
        screw_table: 0.0, "0 or 1", 0.0..=1.0;
        /// Share of the largest feed by which the compensation may change
        feed_share: 0.0025, "of the largest feed", 0.0001..=0.1;
        /// Share of the largest acceleration by which it may do so
        acceleration_share: 0.1, "of the largest acceleration", 0.001..=0.5;
        /// Motion backward that makes a reversal: less is not taken for one
        reversal_mm: 0.0005, "mm", 0.0..=0.1;
    }
}

/// Shortest and longest time constant of the smoothing, ticks.
const SMOOTHING_TICKS: (f64, f64) = (4.0, 4096.0);
/// Largest velocity of the compensation, d/tick: its format inside.
const MAX_RATE: f64 = 7.0;
/// Smallest, d/tick: 16 units of the limiter.
const MIN_RATE: f64 = 1.6e-5;
/// What rounding may add, units of velocity and of acceleration.
const ROUNDING: i32 = 4;

/// The quantised configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Whether the limits of setpoints leave room for it.
    pub(super) is_used: bool,
    /// Half the backlash, Q12.20 d.
    pub(super) half_backlash: i32,
    /// Largest step of the limiter, Q12.20 d/tick.
    pub(super) rate: i32,
    /// 2³² over the time constant of each smoothing.
    pub(super) weight: i32,
    /// Lag of both smoothings, Q.12 ticks.
    pub(super) lead: i32,
    /// Motion backward that is not a reversal yet, Q.16 d.
    pub(super) reversal: i32,
    reserve: Reserve,
}

/// What the compensation takes of the axis's limits.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Reserve {
    velocity: Velocity,
    acceleration: Acceleration,
    /// How fast the place of the look-up may move, d/tick.
    look_up_speed: f64,
}

impl CompensationParams {
    /// The configuration under the limits of the axis.
    ///
    /// # Errors
    /// [`RangeError`] for a parameter, or what it comes to in d and ticks, out of range.
    pub fn quantise(&self, scale: AxisScale, limits: &Limits) -> Result<Config, RangeError> {
        self.check()?;
        let velocity: f64 = limits.velocity().to_num();
        let acceleration: f64 = limits.acceleration().to_num();
        let (shortest, longest) = SMOOTHING_TICKS;
        // A slow axis with a brisk drive would smooth for less than a tick; one with much feed and little
        // acceleration for ever: then the compensation is slower than it might be.
        let share = self.acceleration_share * acceleration;
        let rate = libm::fmin(self.feed_share * velocity, MAX_RATE);
        let rate = libm::fmin(rate, 0.5 * share * longest);
        let is_used = self.backlash_mm > 0.0 || self.screw_table >= 0.5;
        if is_used {
            checked("compensation_feed_d_per_tick", rate, MIN_RATE, MAX_RATE)?;
        }
        let rate = libm::fmax(rate, MIN_RATE);
        let ticks = libm::ceil(2.0 * rate / share).clamp(shortest, longest);
        let backlash = scale.counts_from_mm(self.backlash_mm);
        let backlash = checked("backlash_d", backlash, 0.0, super::table::MAX_ERROR_D)?;
        let reversal = scale.counts_from_mm(self.reversal_mm);
        let reversal = checked("reversal_d", reversal, 0.0, 16_000.0)?;
        Ok(Config {
            is_used,
            half_backlash: fixed_bits(0.5 * backlash, ScrewError::FRAC_NBITS),
            rate: libm::floor(libm::ldexp(rate, ScrewError::FRAC_NBITS.cast_signed())) as i32,
            weight: libm::floor(libm::ldexp(1.0, 32) / ticks) as i32,
            lead: fixed_bits(2.0 * (ticks - 1.0), LEAD_FRAC),
            reversal: fixed_bits(reversal, Position::FRAC_NBITS),
            reserve: Reserve {
                velocity: Velocity::from_bits(
                    fixed_bits(rate, Velocity::FRAC_NBITS).wrapping_add(ROUNDING),
                ),
                acceleration: Acceleration::from_bits(
                    fixed_bits(2.0 * rate / ticks, Acceleration::FRAC_NBITS)
                        .wrapping_add(ROUNDING.wrapping_shl(4)),
                ),
                look_up_speed: velocity + 2.0 * ticks * acceleration,
            },
        })
    }
}

impl Config {
    /// What the limits of the axis leave to its setpoints: velocity and acceleration less the compensation's own.
    ///
    /// # Errors
    /// [`RangeError`] where nothing is left.
    pub fn setpoint_limits(&self, limits: &Limits) -> Result<Limits, RangeError> {
        if !self.is_used {
            return Ok(*limits);
        }
        let velocity = limits.velocity().saturating_sub(self.reserve.velocity);
        let acceleration = limits
            .acceleration()
            .saturating_sub(self.reserve.acceleration);
        Limits::new(
            velocity.to_num(),
            acceleration.to_num(),
            limits.jerk().to_num(),
        )
    }

    /// Largest velocity of the compensation.
    #[must_use]
    pub const fn velocity(&self) -> Velocity {
        self.reserve.velocity
    }

    /// Largest acceleration of the compensation.
    #[must_use]
    pub const fn acceleration(&self) -> Acceleration {
        self.reserve.acceleration
    }

    /// Whether the compensation can follow a table at the largest feed.
    pub(super) fn check(&self, table: &ScrewTable<'_>) -> Result<(), TableRefused> {
        if !self.is_used {
            return Err(TableRefused::NotUsed);
        }
        let allowed = self.reserve.velocity.to_num::<f64>() / self.reserve.look_up_speed;
        let steepest = table.steepest();
        if steepest.value > allowed {
            return Err(TableRefused::Steep {
                at: steepest,
                allowed,
            });
        }
        let shortest = table.shortest();
        if shortest.value < self.reserve.look_up_speed {
            return Err(TableRefused::Short {
                at: shortest,
                allowed: self.reserve.look_up_speed,
            });
        }
        Ok(())
    }
}

/// Fractional bits of [`Config::lead`].
pub(super) const LEAD_FRAC: u32 = 12;

/// `value`·2^`frac` to nearest.
#[inline(never)]
fn fixed_bits(value: f64, frac: u32) -> i32 {
    libm::round(libm::ldexp(value, frac.cast_signed())) as i32
}

/// Why an axis did not take a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableRefused {
    /// The limits of setpoints leave no room for the compensation.
    NotUsed,
    /// The error changes faster than the compensation may at the largest feed.
    Steep {
        /// Point from which on, and how steep, d a d.
        at: Extreme,
        /// Steepest that may be, d a d.
        allowed: f64,
    },
    /// At the largest feed more than a stretch is passed in a tick.
    Short {
        /// Point from which on, and how long, d.
        at: Extreme,
        /// Shortest that may be, d.
        allowed: f64,
    },
}

impl fmt::Display for TableRefused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotUsed => f.write_str(
                "the parameters leave no room for a screw table: set screw_table to 1, which takes the \
                 compensation's share off feed and acceleration",
            ),
            Self::Steep { at, allowed } => write!(
                f,
                "from point {} on the screw's error changes by {:.6} d a d, allowed {allowed:.6} at the largest feed: \
                 raise feed_share or lower the largest feed",
                at.point, at.value
            ),
            Self::Short { at, allowed } => write!(
                f,
                "from point {} on of the screw table the next point is {:.1} d off, allowed are {allowed:.1} d and \
                 more at the largest feed: thin the points out or lower the largest feed",
                at.point, at.value
            ),
        }
    }
}

impl core::error::Error for TableRefused {}
