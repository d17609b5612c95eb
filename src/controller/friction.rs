//! Feedforward against friction: what a motion of the *setpoint* costs before it shows as an error.
//!
//! level = kinetic + (static − kinetic)/(1 + (v/v_s)²) in the direction of v, the Stribeck curve of the model, each
//! direction with its own two levels. v is the setpoint's velocity as far ahead as command and rise take,
//! v + τ·a + τ²·j/2, so that the level stands when the motion starts or reverses. It comes and goes at a bounded rate, and
//! so passes zero speed smoothly; below a least speed, and at rest, it is let go.
//!
//! It acts on the setpoint alone: an error, or noise of an estimate, cannot make it chatter. At rest the setpoint has no
//! direction, and there is no level; what is done about a standing error is in [`rest`](super::rest).
//!
//! Before a motion from rest, which a planned one announces, half of the kinetic level stands for as long as the drive's dead time: a reversal
//! of the command is over when the motion starts.

use super::learning::State as Learned;
use super::turning::{change, rest_of};
use crate::estimator::saturate;
use crate::narrowing::narrowed;
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
    /// Ticks for which the drive stands at a reversal of its command.
    pub dead_ticks: f64,
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
    /// τ, Q.16, and τ²/2, Q.11: times an acceleration and a jerk they have the same fractional bits.
    lead: [i32; 2],
    /// Ticks before a start from rest from which on it is prepared for.
    notice: u32,
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
        let dead = checked("dead_time_ticks", friction.dead_ticks, 0.0, 100.0)?;
        Ok(Self {
            levels,
            slew: fixed(largest / rise, Command::FRAC_NBITS).max(1.0) as i32,
            least_speed: fixed(least, Velocity::FRAC_NBITS) as u32,
            per_stribeck: fixed(1.0 / stribeck, 20) as u32,
            notice: libm::ceil(lead + dead) as u32,
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

    /// Ticks before a start from rest from which on it is prepared for.
    #[must_use]
    pub const fn notice(&self) -> u32 {
        self.notice
    }

    /// A motion from rest is about to start: it is prepared for.
    #[inline]
    #[must_use]
    pub fn is_due(&self, setpoint: &Setpoint) -> bool {
        setpoint.turn.ticks <= self.notice
    }

    /// Whole ticks of τ.
    pub(super) const fn horizon(&self) -> u32 {
        (self.lead[0] as u32).wrapping_shr(LEAD_FRAC)
    }

    /// The level that a motion asks for.
    #[inline]
    fn target(&self, setpoint: &Setpoint, turns: bool) -> i32 {
        let velocity = self.velocity_ahead(setpoint, turns);
        let speed = velocity.unsigned_abs();
        if speed <= self.least_speed {
            return self.notice_of(setpoint);
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
    fn velocity_ahead(&self, setpoint: &Setpoint, turns: bool) -> i32 {
        const SHIFT: u32 = Acceleration::FRAC_NBITS + LEAD_FRAC - Velocity::FRAC_NBITS;
        let [lead, half_square] = self.lead.map(i64::from);
        let sum = i64::from(setpoint.velocity.to_bits())
            .wrapping_shl(SHIFT)
            .wrapping_add(i64::from(setpoint.acceleration.to_bits()).wrapping_mul(lead))
            .wrapping_add(i64::from(setpoint.jerk.to_bits()).wrapping_mul(half_square));
        let velocity = narrowed::<SHIFT>(sum);
        if turns && let Some(rest) = rest_of(self.lead[0] as u32, LEAD_FRAC, setpoint) {
            return velocity.saturating_add(gained(rest, setpoint));
        }
        velocity
    }

    /// What turns the sign of the command in time, before a motion from rest: a drive's dead time is over when it starts.
    #[cold]
    #[inline(never)]
    fn notice_of(&self, setpoint: &Setpoint) -> i32 {
        if !self.is_due(setpoint) || setpoint.velocity != Velocity::ZERO {
            return 0;
        }
        let jerk = setpoint.turn.jerk;
        let [forward, backward] = &self.levels;
        let [kinetic, _] = if jerk > Jerk::ZERO { forward } else { backward };
        kinetic
            .wrapping_shr(NOTICE_SHIFT)
            .wrapping_mul(jerk.to_bits().signum())
    }
}

/// r²/2·Δj: what a change of the jerk `rest` ticks (Q.16) before adds to a velocity, Q11.20.
#[cold]
#[inline(never)]
fn gained(rest: u32, setpoint: &Setpoint) -> i32 {
    const BY_JERK: u32 = Jerk::FRAC_NBITS + SQUARE_FRAC - Velocity::FRAC_NBITS;
    let half_square = u64::from(rest)
        .wrapping_mul(u64::from(rest))
        .wrapping_shr(2 * LEAD_FRAC + 1 - SQUARE_FRAC);
    let gained = i64::from(change(setpoint))
        .wrapping_mul(half_square.cast_signed())
        .wrapping_shr(BY_JERK);
    saturate(gained)
}

/// The level before a start, of the kinetic one: 2⁻ⁿ.
const NOTICE_SHIFT: u32 = 1;

/// Fractional bits of τ.
const LEAD_FRAC: u32 = 16;
/// Fractional bits of τ²/2.
const SQUARE_FRAC: u32 = 11;

/// The level in force, Q.30.
#[derive(Clone, Debug, Default)]
pub struct State {
    level: i32,
}

impl State {
    /// No level.
    #[must_use]
    pub const fn new() -> Self {
        Self { level: 0 }
    }

    /// The level in force.
    #[inline]
    #[must_use]
    pub const fn level(&self) -> Command {
        Command::from_bits(self.level)
    }

    /// Lets the level go: at rest.
    #[inline]
    pub const fn let_go(&mut self) {
        self.level = 0;
    }

    /// One tick; the level after it. Friction is torque: where the drive's gain turned out to be another, so does its command.
    #[inline]
    pub fn step(&mut self, config: &Config, setpoint: &Setpoint, learned: &Learned) -> i32 {
        self.step_where(config, setpoint, true, learned)
    }

    /// The same where it is known whether the jerk of the setpoint may change within τ (`turns`).
    #[inline(always)]
    pub(super) fn step_where(
        &mut self,
        config: &Config,
        setpoint: &Setpoint,
        turns: bool,
        learned: &Learned,
    ) -> i32 {
        let target = config.target(setpoint, turns);
        let gap = learned.scaled(target).wrapping_sub(self.level);
        self.level = self
            .level
            .wrapping_add(gap.max(config.slew.wrapping_neg()).min(config.slew));
        self.level
    }
}
