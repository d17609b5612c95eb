//! The integral of the following error: a constant part, and one that goes with the speed of the setpoint.
//!
//! A drive whose gain is not what the feedforward counts on asks for a command that grows with the speed. A constant
//! has to follow every ramp by an error; a share of the speed is right from the first ramp on after it was learned. At a steady speed
//! from v₀ on the constant therefore goes over into share·s, s = v/v₀, by 1/64 of the rest in each tick; their sum stays, so it does
//! nothing to the loop at that speed. What friction may be off by, an eighth of its static level, is left in the constant.
//!
//! While static friction holds the axis the integral grows without effect. What a motion starts with is
//! therefore less by that friction's level.

use crate::units::{Command, RangeError, Velocity, checked};

/// Fractional bits of the integral beyond those of a command.
pub(super) const INTEGRAL_SHIFT: u32 = 26;
/// Fractional bits of s and of 1/s.
const SPEED_FRAC: u32 = 12;
/// s = 1.
const ONE_SPEED: i32 = 1 << SPEED_FRAC;
/// Part of the constant that a tick turns into a share: 2⁻ⁿ.
const LEARNING: u32 = 6;
/// Part of the static friction that the feedforward may be off by: 2⁻ⁿ.
const UNKNOWN: u32 = 3;
/// Largest s, Q.12: sixteen.
const MOST_SPEED: i32 = 1 << 16;
/// Fractional bits of an increment of the share before it is multiplied.
const INCREMENT_SHIFT: u32 = 16;
/// Full command.
const FULL: i64 = (Command::ONE.to_bits() as i64) << INTEGRAL_SHIFT;
/// Largest share: a sixteenth of full command at v₀.
const MOST_SHARE: i64 = FULL >> (SPEED_FRAC + 4);
/// Doublings of the band at rest.
const MOST_DOUBLINGS: u32 = 4;

/// Largest error that static friction is taken to hold, over the band at rest: 2ⁿ.
const REACH: u32 = 4;

/// Quantised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// 1/v₀: times a speed in Q11.20 its high word is s in Q.12; 0 for a constant alone.
    per_speed: i32,
    /// Largest following error at which the integral holds at rest, Q15.16; below zero for none.
    rest_band: i32,
    /// What static friction can hold, in units of the integral.
    held: i64,
}

impl Config {
    /// A part that goes with the speed from about `speed` d/tick on, 0 for none; a band at rest in Q15.16; `held` is what static
    /// friction can hold, in fractions of full command.
    ///
    /// # Errors
    /// [`RangeError`] for a speed below 0.01 d/tick.
    pub fn new(speed: f64, rest_band: i32, held: f64) -> Result<Self, RangeError> {
        const BITS: u32 = 32 + SPEED_FRAC - Velocity::FRAC_NBITS;
        let per_speed = if speed == 0.0 {
            0
        } else {
            let speed = checked("integral_by_speed_d_per_tick", speed, 0.01, 2047.0)?;
            libm::round(libm::ldexp(1.0 / speed, BITS.cast_signed())) as i32
        };
        let held = checked("static friction held", held, 0.0, 4.0)?;
        Ok(Self {
            per_speed,
            rest_band,
            held: (held * FULL as f64) as i64,
        })
    }

    /// There is a part that goes with the speed.
    #[inline]
    pub const fn learns(&self) -> bool {
        self.per_speed != 0
    }

    /// s, Q.12.
    #[inline]
    fn speed(&self, velocity: i32) -> i32 {
        let product = i64::from(velocity).wrapping_mul(i64::from(self.per_speed));
        (product.wrapping_shr(32) as i32).clamp(-MOST_SPEED, MOST_SPEED)
    }
}

/// What is to become of a following error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// At rest within the band: nothing.
    Within,
    /// At rest, as small as what static friction holds: it is overcome, or there is no friction and it is integrated.
    Near,
    /// It is integrated.
    Far,
}

/// The integral.
#[derive(Clone, Debug, Default)]
pub struct State {
    /// Fractions of full command with 30 + [`INTEGRAL_SHIFT`] fractional bits.
    constant: i64,
    /// For each s, with 12 fractional bits less.
    share: i64,
    /// Sign of the error at rest, when it was last beyond the band.
    side: i32,
    /// Changes of that sign since the last motion.
    changes: u32,
    rested: bool,
}

impl State {
    /// Nothing.
    pub const fn new() -> Self {
        Self {
            constant: 0,
            share: 0,
            side: 0,
            changes: 0,
            rested: false,
        }
    }

    /// What it comes to at the speed `velocity`, Q11.20, of the setpoint; Q.30.
    #[inline]
    pub fn value(&self, config: &Config, velocity: i32) -> i64 {
        let mut sum = self.constant;
        if self.share != 0 {
            let speed = i64::from(config.speed(velocity));
            sum = sum.wrapping_add(self.share.wrapping_mul(speed));
        }
        sum.wrapping_shr(INTEGRAL_SHIFT)
    }

    /// What is to become of the `error`; `resting` if the setpoint stands.
    ///
    /// At rest the integral holds within a band. Static friction, once it lets go, may throw the axis beyond the other end
    /// of it, and back: from the second time on the band doubles, so that no swing goes on.
    #[inline]
    pub fn judge(&mut self, config: &Config, error: i32, resting: bool) -> Verdict {
        if !resting {
            if self.rested {
                self.start(config);
            }
            return Verdict::Far;
        }
        self.rested = true;
        let size = error.saturating_abs();
        let doublings = self.changes.saturating_sub(1).min(MOST_DOUBLINGS);
        if size.wrapping_shr(doublings) <= config.rest_band {
            return Verdict::Within;
        }
        if config.held != 0 && self.side.wrapping_mul(error.signum()) <= 0 {
            self.changes = self.changes.saturating_add(self.side.unsigned_abs());
            self.side = error.signum();
        }
        if size.wrapping_shr(REACH) <= config.rest_band {
            Verdict::Near
        } else {
            Verdict::Far
        }
    }

    /// A motion begins.
    #[cold]
    fn start(&mut self, config: &Config) {
        let held = self.constant.clamp(config.held.wrapping_neg(), config.held);
        self.constant = self.constant.wrapping_sub(held);
        (self.side, self.changes, self.rested) = (0, 0, false);
    }

    /// Adds `increment`.
    #[inline]
    pub fn add(&mut self, increment: i64) {
        self.constant = self
            .constant
            .wrapping_add(increment)
            .clamp(FULL.wrapping_neg(), FULL);
    }

    /// At the steady speed `velocity`, Q11.20, of the setpoint: a part of the constant becomes a share of the speed.
    #[inline]
    pub fn learn(&mut self, config: &Config, velocity: i32) {
        let speed = config.speed(velocity);
        if speed.saturating_abs() < ONE_SPEED {
            return;
        }
        let unknown = config.held.wrapping_shr(UNKNOWN);
        let beyond = self
            .constant
            .wrapping_sub(self.constant.clamp(unknown.wrapping_neg(), unknown));
        // 1/s by a 32-bit division.
        let inverse = (1_i32 << (2 * SPEED_FRAC)).checked_div(speed).unwrap_or(0);
        let more = beyond
            .wrapping_shr(LEARNING + INCREMENT_SHIFT)
            .wrapping_mul(i64::from(inverse))
            .wrapping_shr(2 * SPEED_FRAC - INCREMENT_SHIFT);
        let share = self
            .share
            .wrapping_add(more)
            .clamp(MOST_SHARE.wrapping_neg(), MOST_SHARE);
        let more = share.wrapping_sub(self.share);
        self.share = share;
        self.constant = self
            .constant
            .wrapping_sub(more.wrapping_mul(i64::from(speed)));
    }
}
