//! Planning of a jerk-limited move from rest to rest (seven-segment S-curve).
//!
//! With jerk ±j for T₁ ticks, constant acceleration for T₂, cruise for T₃, mirrored to a stop, the
//! move covers D = j·T₁·(T₁ + T₂)·S with S = 2T₁ + T₂ + T₃, reaches the acceleration j·T₁ and the
//! velocity D/S. The three durations are the shortest whole numbers of ticks that keep the limits;
//! rounding them up only lowers jerk, acceleration and velocity, and j is then D/(T₁(T₁ + T₂)S). Each
//! of the seven segments grows by less than a tick, so the move takes at most seven ticks longer
//! than the time-optimal one.
//!
//! Everything is integer: positions and their derivatives in units of 2⁻⁴⁸ d. The jerk is a multiple
//! of six units, so that the sixths and halves in the motion of a tick are whole. What rounding the
//! jerk leaves of the distance is covered by a step of acceleration of less than 6·T₁ units through
//! either ramp (0.04 LSB of the output after 10⁵ ticks of jerk), and what that leaves by a velocity of
//! less than 5e-7 d/tick, the creep, through the whole move. The peaks stay below those of the exact
//! jerk, so the limits hold.

use core::fmt;

use crate::units::{Acceleration, Jerk, Position, RangeError, Velocity, checked};

/// Fractional bits of trajectory quantities, in d.
pub const STATE_FRAC: u32 = 48;
/// Longest phase of constant jerk or acceleration, ticks.
const MAX_RAMP_TICKS: u32 = 1 << 24;
/// Longest move, ticks.
pub const MAX_TICKS: u32 = i32::MAX.cast_unsigned();
/// Longest move, d.
const MAX_DISTANCE: u128 = 1 << (31 + STATE_FRAC);

/// Limits of motion, each on the grid of its output format, so that rounding cannot pass them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    velocity: Velocity,
    acceleration: Acceleration,
    jerk: Jerk,
}

impl Limits {
    /// Largest velocity, d/tick.
    #[must_use]
    pub const fn max_velocity(&self) -> Velocity {
        self.velocity
    }

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

/// Ticks of constant jerk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Segment {
    pub(super) ticks: u32,
    /// A sixth of the jerk, 2⁻⁴⁸ d/tick³.
    pub(super) jerk_sixth: i64,
    /// Step of acceleration at its start, 2⁻⁴⁸ d/tick²; even.
    pub(super) acceleration_step: i64,
}

/// A planned move: a table of up to seven segments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Profile {
    pub(super) segments: [Segment; 7],
    /// Distance in 2⁻⁴⁸ d.
    pub(super) distance: i128,
    /// Velocity in 2⁻⁴⁸ d/tick that carries the rounding rest of the distance.
    pub(super) creep: i64,
    ticks: u32,
}

/// Why a move cannot be planned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlanError {
    /// The distance is beyond ±2³¹ d.
    TooFar,
    /// The move would take 2³¹ ticks or more, or its ramps 2²⁴: raise the limits or shorten the move.
    TooLong,
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TooFar => "the distance is beyond 2147483648 d: shorten the move",
            Self::TooLong => "the move takes too many ticks: raise its limits or shorten it",
        })
    }
}

impl core::error::Error for PlanError {}

impl Profile {
    /// Plans a move by `distance` d under `limits`; outside the tick (some 10⁴ instructions).
    ///
    /// # Errors
    /// [`PlanError`] for a move that is too far or too long.
    pub fn plan(distance: Position, limits: &Limits) -> Result<Self, PlanError> {
        let distance =
            i128::from(distance.to_bits()).wrapping_shl(STATE_FRAC - Position::FRAC_NBITS);
        let magnitude = distance.unsigned_abs();
        if magnitude > MAX_DISTANCE {
            return Err(PlanError::TooFar);
        }
        if magnitude == 0 {
            return Ok(Self::default());
        }
        let phases = Phases::shortest(magnitude, limits).ok_or(PlanError::TooLong)?;
        phases.profile(distance).ok_or(PlanError::TooLong)
    }

    /// Duration in ticks: the target is reached this many ticks after the start.
    #[must_use]
    pub const fn ticks(&self) -> u32 {
        self.ticks
    }
}

/// Durations of constant jerk (T₁), constant acceleration (T₂) and cruise (T₃), ticks.
struct Phases {
    jerk: u32,
    acceleration: u32,
    cruise: u32,
}

impl Phases {
    /// The shortest phases that cover `distance` (2⁻⁴⁸ d, not 0) within `limits`.
    fn shortest(distance: u128, limits: &Limits) -> Option<Self> {
        let velocity = in_state_units(limits.velocity.to_bits(), Velocity::FRAC_NBITS);
        let acceleration = in_state_units(limits.acceleration.to_bits(), Acceleration::FRAC_NBITS);
        let jerk = in_state_units(limits.jerk.to_bits(), Jerk::FRAC_NBITS);

        // The jerk phase ends at the first of: acceleration limit, half the cruising speed, a quarter
        // of the way.
        let t1 = first_tick(|ticks| {
            let speed = jerk.saturating_mul(ticks).saturating_mul(ticks);
            jerk.saturating_mul(ticks) >= acceleration
                || speed >= velocity
                || speed.saturating_mul(ticks).saturating_mul(2) >= distance
        })?
        .max(1);
        let t1_wide = u128::from(t1);
        // With the acceleration limit held, either the cruising speed or the end is reached.
        let t2 = first_tick(|ticks| {
            let speed = acceleration.saturating_mul(t1_wide.saturating_add(ticks));
            speed >= velocity
                || speed.saturating_mul(t1_wide.saturating_mul(2).saturating_add(ticks)) >= distance
        })?;
        let without_cruise = t1.saturating_mul(2).saturating_add(t2);
        let at_speed = u32::try_from(distance.div_ceil(velocity)).ok()?;
        Some(Self {
            jerk: t1,
            acceleration: t2,
            cruise: at_speed.saturating_sub(without_cruise),
        })
    }

    /// The profile that covers `distance` exactly.
    fn profile(&self, distance: i128) -> Option<Profile> {
        let Self {
            jerk: t1,
            acceleration: t2,
            cruise: t3,
        } = *self;
        let ticks = t1
            .checked_mul(4)?
            .checked_add(t2.checked_mul(2)?)?
            .checked_add(t3)?;
        if ticks > MAX_TICKS {
            return None;
        }
        let half = t1.checked_add(t2)?;
        let span = t1.checked_add(half)?.checked_add(t3)?;
        let per_jerk = i128::from(t1)
            .checked_mul(i128::from(half))?
            .checked_mul(i128::from(span))?
            .checked_mul(6)?;
        // Rounded towards zero: the limits hold, and the rest has the sign of the move.
        let jerk_sixth = i64::try_from(distance.checked_div(per_jerk)?).ok()?;
        let rest = distance.checked_rem(per_jerk)?;
        // Two units of acceleration through both ramps, 2T₁ + T₂ ticks each, add 2·(2T₁ + T₂)·S.
        let ramp = t1.checked_add(half)?;
        let per_step = i128::from(ramp)
            .checked_mul(i128::from(span))?
            .checked_mul(2)?;
        let step = i64::try_from(rest.checked_div(per_step)?)
            .ok()?
            .checked_mul(2)?;
        let creep =
            i64::try_from(rest.checked_rem(per_step)?.checked_div(i128::from(ticks))?).ok()?;

        let end_of_ramp = step.wrapping_neg();
        // A phase of no ticks drops out; the step at its start goes to the next one.
        let table = [
            (t1, 1, step),
            (t2, 0, 0),
            (t1, -1, 0),
            (t3, 0, end_of_ramp),
            (t1, -1, end_of_ramp),
            (t2, 0, 0),
            (t1, 1, 0),
        ];
        let mut segments = [Segment::default(); 7];
        let mut slots = segments.iter_mut();
        let mut pending = 0_i64;
        for (ticks, sign, step) in table {
            pending = pending.wrapping_add(step);
            if ticks > 0 {
                let acceleration_step = core::mem::take(&mut pending);
                *slots.next()? = Segment {
                    ticks,
                    jerk_sixth: jerk_sixth.wrapping_mul(sign),
                    acceleration_step,
                };
            }
        }
        Some(Profile {
            segments,
            distance,
            creep,
            ticks,
        })
    }
}

/// `value`·2^`frac` rounded down; the limits checked above fit.
fn rounded_down(value: f64, frac: u32) -> i32 {
    libm::floor(libm::ldexp(value, frac.cast_signed())) as i32
}

/// A positive value with `frac` fractional bits in units of 2⁻⁴⁸.
fn in_state_units(bits: i32, frac: u32) -> u128 {
    u128::from(bits.unsigned_abs()).wrapping_shl(STATE_FRAC.wrapping_sub(frac))
}

/// The smallest number of ticks up to [`MAX_RAMP_TICKS`] from which on `reached` holds.
fn first_tick(reached: impl Fn(u128) -> bool) -> Option<u32> {
    let (mut low, mut high) = (0_u32, MAX_RAMP_TICKS);
    if !reached(u128::from(high)) {
        return None;
    }
    while low < high {
        let middle = low.midpoint(high);
        if reached(u128::from(middle)) {
            high = middle;
        } else {
            low = middle.wrapping_add(1);
        }
    }
    Some(low)
}
