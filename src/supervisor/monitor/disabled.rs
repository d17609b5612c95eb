//! Motion while the drive is off.

use super::super::fault::Fault;
use super::super::record::Trip;

/// What is allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Way, d.
    pub way: i64,
    /// Ticks in which an axis may run out.
    pub after: u32,
    /// It is a fault, not a warning.
    pub is_fault: bool,
}

/// The monitor.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disabled {
    ticks: u32,
    anchor: i64,
}

impl Disabled {
    /// Judges the count of an axis that is off.
    #[inline(never)]
    pub fn check(&mut self, limits: &Limits, count: i64) -> Option<Trip> {
        if self.ticks <= limits.after {
            self.ticks = self.ticks.saturating_add(1);
            self.anchor = count;
            return None;
        }
        let way = count.wrapping_sub(self.anchor);
        if way.wrapping_abs() <= limits.way {
            return None;
        }
        self.anchor = count;
        Some(Trip::counted(Fault::MotionWhileDisabled, way, limits.way))
    }

    /// The drive is on.
    #[inline]
    pub const fn restart(&mut self) {
        self.ticks = 0;
    }
}
