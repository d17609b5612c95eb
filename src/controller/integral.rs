//! The integral of the following error, within ± full command.
//!
//! While static friction holds the axis it grows without effect. What a motion starts with is therefore less by that
//! friction's level.

use crate::narrowing::within_or_high;
use crate::units::Command;

/// Fractional bits of the integral beyond those of a command.
pub(super) const INTEGRAL_SHIFT: u32 = 26;
/// Full command.
const FULL: i64 = (Command::ONE.to_bits() as i64) << INTEGRAL_SHIFT;

/// The integral.
#[derive(Clone, Debug, Default)]
pub struct State {
    /// Fractions of full command with 30 + [`INTEGRAL_SHIFT`] fractional bits.
    sum: i64,
    /// What it was at the last rest.
    at_rest: i64,
}

impl State {
    /// Nothing.
    pub const fn new() -> Self {
        Self { sum: 0, at_rest: 0 }
    }

    /// Q.30.
    #[inline]
    pub const fn value(&self) -> i32 {
        self.sum.wrapping_shr(INTEGRAL_SHIFT) as i32
    }

    /// Adds `increment`, ki·e.
    #[inline]
    pub fn add(&mut self, increment: i64) {
        let sum = self.sum.wrapping_add(increment);
        // By the high word, for both ends at once.
        const HIGHEST: u32 = (FULL >> 32) as u32;
        let high = sum.wrapping_shr(32) as u32;
        self.sum = if high.wrapping_add(HIGHEST) < 2 * HIGHEST {
            sum
        } else {
            held(sum)
        };
    }

    /// Takes over `command`, Q.30.
    pub fn take(&mut self, command: i32) {
        let most = Command::ONE.to_bits();
        let held = within_or_high(command, most.wrapping_neg(), most);
        self.add(i64::from(held).wrapping_shl(INTEGRAL_SHIFT));
    }

    /// Leaves to another term what that has begun to give, `command`, Q.30: up to all of itself.
    #[cold]
    pub fn give_way(&mut self, command: i32) {
        if command != 0 {
            let most = self.value();
            self.take(within_or_high(command, most.min(0), most.max(0)).wrapping_neg());
        }
    }

    /// A motion begins after a rest: what static friction, `held` (Q.30), may have made of it is taken out.
    #[cold]
    pub fn start(&mut self, held: i32) {
        let held = i64::from(held).wrapping_shl(INTEGRAL_SHIFT);
        self.sum = self
            .sum
            .wrapping_sub(within_or_high(self.sum, held.wrapping_neg(), held));
        self.at_rest = self.sum;
    }

    /// A motion ends: what the motion asked for is over.
    #[cold]
    pub const fn rest(&mut self) {
        self.sum = self.at_rest;
    }
}

#[cold]
fn held(sum: i64) -> i64 {
    sum.clamp(FULL.wrapping_neg(), FULL)
}
