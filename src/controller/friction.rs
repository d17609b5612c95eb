//! Feedforward against friction: what a motion of the *setpoint* costs before it shows as an error.
//!
//! level = kinetic + (static − kinetic)/(1 + (v/v_s)²) in the direction of v, the Stribeck curve of the model, each
//! direction with its own two levels. v is the setpoint's velocity as far ahead as command and rise take,
//! v + τ·a + τ²·j/2, so that the level stands when the motion starts or reverses. It comes and goes at a bounded rate, and
//! so passes zero speed smoothly; below a least speed, and at rest, it is let go.
//!
//! In motion it acts on the setpoint alone: an error, or noise of an estimate, cannot make it chatter. At rest the
//! setpoint has no direction, and a standing error is held by static friction. There the level rises evenly in the direction of the error
//! until the axis lets go, and is gone when the error is within its band: an integral would still push then, and throw the axis
//! to the other side, as friction falls with speed.

use crate::estimator::saturate;
use crate::setpoint::Setpoint;
use crate::units::{Acceleration, Command, Jerk, RangeError, Velocity, checked};

/// Friction in fractions of full command, speeds in d/tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Friction {
    /// Kinetic level forward and backward.
    pub kinetic: [f64; 2],
    /// Level at which the axis breaks away, forward and backward; not less than the kinetic one.
    pub breakaway: [f64; 2],
    /// Speed at which half of the excess is gone.
    pub stribeck: f64,
    /// Least speed that counts as motion.
    pub least_speed: f64,
    /// Ticks in which the largest level is reached from zero.
    pub rise_ticks: f64,
    /// How far ahead the setpoint is looked at, ticks.
    pub lead_ticks: f64,
    /// Ticks in which the level at rest rises to the largest one; 0: it does not.
    pub lift_ticks: f64,
}

/// Quantised friction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Config {
    /// Kinetic level and the excess over it, forward and backward, Q.30; all zero: none.
    levels: [[i32; 2]; 2],
    /// Largest change in a tick, Q.30.
    slew: i32,
    /// Least speed, Q11.20.
    least_speed: u32,
    /// 2²⁰/v_s: times a speed in Q11.20 its high word is v/v_s in Q.8.
    per_stribeck: u32,
    /// τ, Q.16, and τ²/2, Q.8.
    lead: [i32; 2],
    /// Rise of the level at rest in a tick, and its bound, Q.30.
    lift: i32,
    most_lift: i32,
}

/// v/v_s beyond which the excess is gone, Q.8.
const FAST: u32 = 1 << 15;

impl Config {
    /// Quantises `friction`.
    ///
    /// # Errors
    /// [`RangeError`] for a level beyond full command, a static level below the kinetic one, a Stribeck speed below
    /// 2.5e-4 d/tick, or a lead beyond 1 000 ticks.
    pub fn new(friction: &Friction) -> Result<Self, RangeError> {
        let fixed = |value: f64, frac: u32| libm::round(libm::ldexp(value, frac.cast_signed()));
        let mut levels = [[0; 2]; 2];
        let mut largest = 0.0_f64;
        let both = friction.kinetic.into_iter().zip(friction.breakaway);
        for ((kinetic, breakaway), level) in both.zip(&mut levels) {
            let kinetic = checked("friction", kinetic, 0.0, 1.0)?;
            let breakaway = checked("breakaway", breakaway, kinetic, 1.0)?;
            largest = largest.max(breakaway);
            *level = [kinetic, breakaway - kinetic]
                .map(|value| fixed(value, Command::FRAC_NBITS) as i32);
        }
        if largest == 0.0 {
            return Ok(Self::default());
        }
        let rise = checked("friction_rise_ticks", friction.rise_ticks, 1.0, 1e6)?;
        let stribeck = checked("stribeck_d_per_tick", friction.stribeck, 2.5e-4, 2e3)?;
        let least = checked("friction_least_d_per_tick", friction.least_speed, 0.0, 2e3)?;
        let lead = checked("friction_lead_ticks", friction.lead_ticks, 0.0, 1000.0)?;
        let lift = checked("friction_lift_ticks", friction.lift_ticks, 0.0, 1e6)?;
        let per_tick = if lift == 0.0 { 0.0 } else { largest / lift };
        let most_lift = (largest * MOST_LIFT).min(1.0);
        Ok(Self {
            lift: fixed(per_tick, Command::FRAC_NBITS) as i32,
            most_lift: fixed(most_lift, Command::FRAC_NBITS) as i32,
            levels,
            slew: fixed(largest / rise, Command::FRAC_NBITS).max(1.0) as i32,
            least_speed: fixed(least, Velocity::FRAC_NBITS) as u32,
            per_stribeck: fixed(1.0 / stribeck, 20) as u32,
            lead: [
                fixed(lead, LEAD_FRAC) as i32,
                fixed(lead * lead / 2.0, SQUARE_FRAC) as i32,
            ],
        })
    }

    /// There is something to do.
    #[inline]
    #[must_use]
    pub const fn is_on(&self) -> bool {
        self.slew != 0
    }

    /// Static friction is overcome at rest.
    #[inline]
    #[must_use]
    pub const fn lifts(&self) -> bool {
        self.lift != 0
    }

    /// The level that a motion asks for.
    #[inline]
    fn target(&self, setpoint: &Setpoint) -> i32 {
        let velocity = self.velocity_ahead(setpoint);
        let speed = velocity.unsigned_abs();
        if speed <= self.least_speed {
            return 0;
        }
        let [forward, backward] = &self.levels;
        let [kinetic, excess] = *if velocity > 0 { forward } else { backward };
        let product = u64::from(speed).wrapping_mul(u64::from(self.per_stribeck));
        let relative = (product.wrapping_shr(32) as u32).min(FAST);
        let square = relative.wrapping_mul(relative).wrapping_shr(8);
        // A 32-bit division; its divisor is 256 at least.
        let share = excess
            .checked_div(square.wrapping_add(256).cast_signed())
            .unwrap_or(0);
        let level = kinetic.saturating_add(share.wrapping_shl(8));
        if velocity > 0 {
            level
        } else {
            level.wrapping_neg()
        }
    }

    /// v + τ·a + τ²·j/2, Q11.20; saturates.
    #[inline]
    fn velocity_ahead(&self, setpoint: &Setpoint) -> i32 {
        const BY_ACCELERATION: u32 = Acceleration::FRAC_NBITS + LEAD_FRAC - Velocity::FRAC_NBITS;
        const BY_JERK: u32 = Jerk::FRAC_NBITS + SQUARE_FRAC - Velocity::FRAC_NBITS;
        let [lead, half_square] = self.lead.map(i64::from);
        let by_acceleration = i64::from(setpoint.acceleration.to_bits()).wrapping_mul(lead);
        let by_jerk = i64::from(setpoint.jerk.to_bits()).wrapping_mul(half_square);
        saturate(
            i64::from(setpoint.velocity.to_bits())
                .wrapping_add(by_acceleration.wrapping_shr(BY_ACCELERATION))
                .wrapping_add(by_jerk.wrapping_shr(BY_JERK)),
        )
    }
}

/// Bound of the level at rest, of the largest level: friction may have grown.
const MOST_LIFT: f64 = 1.6;
/// Change of the following error that shows that the axis has let go, Q15.16.
const LEAST_WAY: i32 = 3 << 14;
/// Fractional bits of τ.
const LEAD_FRAC: u32 = 16;
/// Fractional bits of τ²/2.
const SQUARE_FRAC: u32 = 8;

/// The level in force, Q.30.
#[derive(Clone, Debug, Default)]
pub struct State {
    level: i32,
    /// Following error at which the level at rest began to rise, Q15.16.
    lifted_at: i32,
}

impl State {
    /// No level.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            level: 0,
            lifted_at: 0,
        }
    }

    /// The level in force.
    #[inline]
    #[must_use]
    pub const fn level(&self) -> Command {
        Command::from_bits(self.level)
    }

    /// One tick; the level after it.
    #[inline]
    pub fn step(&mut self, config: &Config, setpoint: &Setpoint) -> i32 {
        let gap = config.target(setpoint).wrapping_sub(self.level);
        self.level = self
            .level
            .wrapping_add(gap.max(config.slew.wrapping_neg()).min(config.slew));
        self.level
    }

    /// One tick at rest, with a standing `error`, Q15.16, or none; the level after it.
    #[inline]
    pub fn lift(&mut self, config: &Config, error: Option<i32>) -> i32 {
        let Some(error) = error else {
            self.level = 0;
            return 0;
        };
        let has_moved = error.wrapping_sub(self.lifted_at).saturating_abs() > LEAST_WAY;
        let is_against = self.level.signum().wrapping_mul(error.signum()) < 0;
        if has_moved || is_against {
            self.lifted_at = error;
            self.level = 0;
        } else {
            let step = config.lift.wrapping_mul(error.signum());
            let most = config.most_lift;
            self.level = self
                .level
                .saturating_add(step)
                .clamp(most.wrapping_neg(), most);
        }
        self.level
    }
}
