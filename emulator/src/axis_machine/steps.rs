//! Steps of an outer control, each with its direction there before.

use super::wired;
use crate::CLOCK_HZ;
use crate::emulator::Pin;

/// Clocks that a step pulse is high. The direction is there a step's period before.
const PULSE: u64 = 420;

/// Steps of an outer control.
#[derive(Clone, Copy, Debug)]
pub struct Steps {
    clocks_per_step: f64,
    next: f64,
    /// Steps so far, those backward less.
    pub count: i64,
    forward: bool,
}

impl Steps {
    /// Steps from clock `now` on, after `count` of them; a negative rate is backward.
    pub fn new(steps_per_s: f64, now: u64, count: i64) -> Self {
        let clocks_per_step = CLOCK_HZ as f64 / steps_per_s.abs();
        Self {
            clocks_per_step,
            next: now as f64 + clocks_per_step,
            count,
            forward: steps_per_s >= 0.0,
        }
    }

    /// Tells the steps before clock `end`.
    pub fn give(&mut self, end: u64, changes: &mut Vec<(u64, Pin, bool)>) {
        while self.next < end as f64 {
            let clock = self.next as u64;
            changes.push((clock, wired::STEP, true));
            changes.push((clock + PULSE, wired::STEP, false));
            self.count += if self.forward { 1 } else { -1 };
            self.next += self.clocks_per_step;
        }
    }
}
