//! Dead time of the drive at a reversal of its command: what it does not answer is given back afterwards.
//!
//! A thyristor drive stands for some milliseconds when the sign of its command changes, until the current of the other
//! bridge may flow. What was commanded meanwhile, friction apart, would have moved the axis; it is added up and, once
//! the drive answers again, given back by an eighth of the rest in each tick, so that the axis is where the
//! feedforward meant it to be without an error that feedback would have to see first. Only a setpoint
//! that moves is given back; at rest nothing is owed.

use crate::units::{Command, RangeError, checked};

/// Quantised dead time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Config {
    /// 0: none.
    ticks: u32,
    /// Command that the drive takes for zero, Q.30.
    zero: i32,
    /// Least command either side of it that has a sign, Q.30.
    least: u32,
}

impl Config {
    /// A dead time of `ticks` where the sign of the command against `zero` changes, a command within `least` of it having
    /// none; fractions of full command.
    ///
    /// # Errors
    /// [`RangeError`] for more than 100 ticks, or commands that are none.
    pub fn new(ticks: f64, zero: f64, least: f64) -> Result<Self, RangeError> {
        let fixed = |value: f64| libm::ldexp(value, Command::FRAC_NBITS.cast_signed()) as i32;
        Ok(Self {
            ticks: libm::round(checked("dead_time_ticks", ticks, 0.0, 100.0)?) as u32,
            zero: fixed(checked("bias", zero, -1.0, 1.0)?),
            least: fixed(checked("dead_time_least", least, 0.0, 0.1)?).unsigned_abs(),
        })
    }

    /// There is something to do.
    #[inline]
    #[must_use]
    pub const fn is_on(&self) -> bool {
        self.ticks != 0
    }
}

/// Part of what is owed that a tick gives back: 2⁻ⁿ.
const SHARE: u32 = 3;
/// Fractional bits of what is owed.
const OWED_FRAC: u32 = 24;
/// Bits that a command drops for that.
const OWED_SHIFT: u32 = Command::FRAC_NBITS - OWED_FRAC;
/// Most that is owed, full commands: 64.
const MOST: i32 = 64 << OWED_FRAC;
/// Most that is given back in a tick, full commands: 2.
const MOST_SHARE: i32 = 2 << OWED_FRAC;

/// What the drive still owes.
#[derive(Clone, Debug, Default)]
pub struct State {
    /// Sign of the last command that had one.
    sign: i32,
    /// Ticks that the drive will stand for.
    left: u32,
    /// With [`OWED_FRAC`].
    owed: i32,
}

impl State {
    /// Nothing owed, no sign known.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            sign: 0,
            left: 0,
            owed: 0,
        }
    }

    /// `law`, Q.30, with what is given back in this tick, and what of it the drive does not answer; `friction` is the part of it
    /// that moves nothing and is in neither.
    #[inline]
    pub fn step(&mut self, config: &Config, law: i32, friction: i32, resting: bool) -> (i32, i32) {
        let net = law.saturating_sub(config.zero);
        if (net ^ self.sign) < 0 || self.sign == 0 {
            self.turn(config, net);
        }
        if self.left > 0 {
            let lost = net.saturating_sub(friction);
            self.stand(lost, resting);
            return (law, lost);
        }
        if resting {
            self.owed = 0;
            return (law, 0);
        }
        let share = self.owed.wrapping_shr(SHARE);
        self.owed = self.owed.wrapping_sub(share);
        // These bounds are one instruction.
        let share = share.clamp(-MOST_SHARE, MOST_SHARE.wrapping_sub(1));
        (law.saturating_add(share.wrapping_shl(OWED_SHIFT)), 0)
    }

    /// A command of another sign than the last: if it has one.
    #[cold]
    fn turn(&mut self, config: &Config, net: i32) {
        if net.unsigned_abs() <= config.least {
            return;
        }
        // The first sign is no reversal.
        if self.sign != 0 {
            self.left = config.ticks;
        }
        self.sign = if net < 0 { -1 } else { 1 };
    }

    /// A tick in which the drive stands, and does not answer `lost`.
    #[cold]
    fn stand(&mut self, lost: i32, resting: bool) {
        self.left = self.left.wrapping_sub(1);
        self.owed = if resting {
            0
        } else {
            self.owed
                .saturating_add(lost.wrapping_shr(OWED_SHIFT))
                .clamp(-MOST, MOST)
        };
    }
}
