//! Which tick feeds the watchdog.
//!
//! Only one that had its inputs and ended in time: the watchdog then bites where ticks stop, where one hangs, and where all of
//! them take too long, whatever the cause. A single late tick costs nothing but its food; the supervisor's `LateTick` stops the
//! axis in its loop before so many come that the watchdog has to.

use super::reason::Reason;

/// What a tick is to do about the watchdog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meal {
    /// Feed it.
    Feed,
    /// Feed it, and take the record of starving ticks back.
    FeedAgain,
    /// Do not.
    Starve,
    /// Do not, and record this reason: if the ticks do not recover, a reset follows.
    StarveFirst(Reason),
}

/// Decides it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Feeding {
    ticks: u32,
    starved: u32,
}

/// Ticks running that starve before it is recorded: one late tick is no reason for a reset.
const RECORDED: u32 = 2;

impl Feeding {
    /// No tick came yet.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            ticks: 0,
            starved: 0,
        }
    }

    /// After each tick, with [`Runtime::was_in_time`](crate::tick::Runtime::was_in_time).
    pub const fn after_tick(&mut self, was_in_time: bool) -> Meal {
        self.ticks = self.ticks.wrapping_add(1);
        if was_in_time {
            let was_recorded = self.starved >= RECORDED;
            self.starved = 0;
            return if was_recorded {
                Meal::FeedAgain
            } else {
                Meal::Feed
            };
        }
        self.starved = self.starved.saturating_add(1);
        if self.starved == RECORDED {
            Meal::StarveFirst(Reason::LateTicks { tick: self.ticks })
        } else {
            Meal::Starve
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_tick_in_time_feeds_and_starving_is_recorded_once() {
        let mut feeding = Feeding::new();
        let mut after = |in_time| feeding.after_tick(in_time);
        assert_eq!(after(true), Meal::Feed);
        assert_eq!(after(false), Meal::Starve);
        assert_eq!(after(true), Meal::Feed, "one late tick is forgotten");
        assert_eq!(after(false), Meal::Starve);
        let reason = Reason::LateTicks { tick: 5 };
        assert_eq!(after(false), Meal::StarveFirst(reason));
        assert_eq!(after(false), Meal::Starve);
        assert_eq!(after(true), Meal::FeedAgain, "and so is their record");
        assert_eq!(after(true), Meal::Feed);
    }
}
