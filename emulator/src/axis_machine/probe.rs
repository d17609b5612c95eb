//! A probe that touches at a count.

use super::wired;
use crate::emulator::Pin;

/// The probe.
#[derive(Clone, Copy, Debug, Default)]
pub struct Probe {
    /// It touches from this count on upward; nowhere without one.
    pub at: Option<i32>,
    touches: bool,
    /// When it touched last.
    pub touched_at: Option<u64>,
}

impl Probe {
    /// Follows the count, which came to `count` at a clock.
    pub fn follow(&mut self, count: i32, clock: u64, changes: &mut Vec<(u64, Pin, bool)>) {
        let touches = self.at.is_some_and(|at| count >= at);
        if touches != self.touches {
            self.touches = touches;
            changes.push((clock, wired::PROBE, touches));
            if touches {
                self.touched_at = Some(clock);
            }
        }
    }
}
