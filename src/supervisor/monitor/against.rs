//! Motion against the command: wrong polarity.
//!
//! A deceleration is no such motion: the speed against the command then falls. A run of motion against the
//! command counts from its first tick, with the speed that it began with.

use super::super::fault::Fault;
use super::super::record::Trip;

/// What is allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Commands up to this say nothing (offset, friction), Q.30 of full command.
    pub level: i32,
    /// Way, d.
    pub way: i32,
    /// Ticks.
    pub ticks: u32,
}

/// The monitor.
#[derive(Clone, Copy, Debug, Default)]
pub struct Against {
    ticks: u32,
    way: i32,
    /// Speed at the beginning of the run, Q11.20 d/tick.
    first_speed: i32,
}

impl Against {
    /// True while a run goes on.
    pub const fn is_busy(&self) -> bool {
        self.ticks != 0
    }

    /// Judges a motion of `delta` d under `command` (Q.30), at an estimated velocity (Q11.20 d/tick).
    pub fn check(
        &mut self,
        limits: &Limits,
        command: i32,
        delta: i32,
        velocity: i32,
    ) -> Option<Trip> {
        if self.ticks == 0 && delta == 0 {
            return None;
        }
        let is_silent = command.saturating_abs() <= limits.level;
        if is_silent || (delta != 0 && delta ^ command >= 0) {
            *self = Self::default();
            return None;
        }
        let speed = velocity.saturating_abs();
        if self.ticks == 0 {
            self.first_speed = speed;
        }
        self.ticks = self.ticks.saturating_add(1);
        self.way = self.way.saturating_add(delta.saturating_abs());
        (self.way > limits.way && self.ticks > limits.ticks && speed > self.first_speed).then(
            || {
                let (way, limit) = (i64::from(self.way), i64::from(limits.way));
                Trip::counted(Fault::MotionAgainstCommand, way, limit)
            },
        )
    }
}
