//! The period of the watchdog: short, except around an erasure of flash.
//!
//! ```text
//!           shorten          settled, fed
//! Long ───────────────► … ───────────────► Short      the axis may be enabled in Short alone,
//!  ▲                                         │        flash be erased in Long alone
//!  └───────────── settled, fed ◄─ … ◄────────┘ lengthen
//! ```
//!
//! An erasure stalls a processor that runs from the same flash: no tick runs, nobody feeds. Thread mode lengthens the period
//! before and shortens it after; the tick may feed all the while. A new period reaches the watchdog's own clock some of its
//! cycles later and counts from the next feeding, so each change waits for the hardware and feeds once; only then the state
//! moves on. Hardware that does not take it leaves a state in which nothing is allowed.
//!
//! The store writes under the permission of its interlock, in which no axis can be enabled, and the permission ends after
//! the flash driver's erasure with [`WatchdogPeriod::shorten`] in it. [`WatchdogPeriod::may_enable`] holds it against every other way.

use core::fmt;
use core::sync::atomic::{AtomicU8, Ordering};

/// A period of the watchdog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Period {
    /// At most 10 ms.
    Short,
    /// Longer than the worst erasure of a sector.
    Long,
}

/// The watchdog's registers.
pub trait Watchdog {
    /// Whether the last period has reached it, so that another may be set.
    fn is_settled(&self) -> bool;
    /// Sets a period; it counts from the first feeding after it has settled.
    fn set(&self, period: Period);
    /// Feeds it.
    fn feed(&self);
}

/// The hardware did not take the period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stuck;

impl fmt::Display for Stuck {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the watchdog did not take its new period: switch off and on; if it stays, replace the board")
    }
}

impl core::error::Error for Stuck {}

const LONG: u8 = 0;
const CHANGING: u8 = 1;
const SHORT: u8 = 2;

/// Where the period stands; set by thread mode, read by the tick.
#[derive(Debug)]
pub struct WatchdogPeriod {
    state: AtomicU8,
    /// Turns of a wait.
    patience: u32,
}

impl WatchdogPeriod {
    /// Of a watchdog that was started with the long period. `patience`: times that [`Watchdog::is_settled`] is asked before
    /// it is given up, to last for longer than the hardware needs (an IWDG: five of its clocks, 0.3 ms at its slowest).
    #[must_use]
    pub const fn new(patience: u32) -> Self {
        Self {
            state: AtomicU8::new(LONG),
            patience,
        }
    }

    /// Whether the axis may be enabled: the period is short.
    #[inline]
    pub fn may_enable(&self) -> bool {
        self.state.load(Ordering::Acquire) == SHORT
    }

    /// Whether flash may be erased: the period is long.
    pub fn may_erase(&self) -> bool {
        self.state.load(Ordering::Acquire) == LONG
    }

    /// Makes it long. Blocks until the hardware has it.
    ///
    /// # Errors
    /// [`Stuck`]; nothing may be erased then.
    pub fn lengthen(&self, watchdog: &impl Watchdog) -> Result<(), Stuck> {
        self.change(watchdog, Period::Long)
    }

    /// Makes it short. Blocks until the hardware has it.
    ///
    /// # Errors
    /// [`Stuck`]; no axis may be enabled then.
    pub fn shorten(&self, watchdog: &impl Watchdog) -> Result<(), Stuck> {
        self.change(watchdog, Period::Short)
    }

    fn change(&self, watchdog: &impl Watchdog, period: Period) -> Result<(), Stuck> {
        self.state.store(CHANGING, Ordering::Release);
        self.settle(watchdog)?;
        watchdog.set(period);
        self.settle(watchdog)?;
        watchdog.feed();
        let state = match period {
            Period::Short => SHORT,
            Period::Long => LONG,
        };
        self.state.store(state, Ordering::Release);
        Ok(())
    }

    fn settle(&self, watchdog: &impl Watchdog) -> Result<(), Stuck> {
        let mut turns = 0..self.patience;
        if turns.any(|_| watchdog.is_settled()) {
            Ok(())
        } else {
            Err(Stuck)
        }
    }
}

#[cfg(test)]
mod tests {
    use core::cell::Cell;

    use super::*;

    /// Takes `delay` looks to settle; looks on whether anything is allowed meanwhile.
    struct Slow<'p> {
        period: &'p WatchdogPeriod,
        delay: u32,
        left: Cell<u32>,
        written: Cell<Period>,
        in_force: Cell<Period>,
    }

    impl<'p> Slow<'p> {
        fn new(period: &'p WatchdogPeriod, delay: u32) -> Self {
            Self {
                period,
                delay,
                left: Cell::new(0),
                written: Cell::new(Period::Long),
                in_force: Cell::new(Period::Long),
            }
        }
    }

    impl Watchdog for Slow<'_> {
        fn is_settled(&self) -> bool {
            assert!(!self.period.may_enable() && !self.period.may_erase());
            let left = self.left.get();
            self.left.set(left.saturating_sub(1));
            left == 0
        }

        fn set(&self, period: Period) {
            assert_eq!(self.left.get(), 0, "a write before it settled is lost");
            self.left.set(self.delay);
            self.written.set(period);
        }

        fn feed(&self) {
            if self.left.get() == 0 {
                self.in_force.set(self.written.get());
            }
        }
    }

    #[test]
    fn nothing_is_allowed_but_what_the_period_in_force_allows() {
        let period = WatchdogPeriod::new(10);
        assert!(period.may_erase() && !period.may_enable(), "long at start");
        let watchdog = Slow::new(&period, 5);
        for _ in 0..3 {
            assert_eq!(period.shorten(&watchdog), Ok(()));
            assert_eq!(watchdog.in_force.get(), Period::Short);
            assert!(period.may_enable() && !period.may_erase());
            assert_eq!(period.lengthen(&watchdog), Ok(()));
            assert_eq!(watchdog.in_force.get(), Period::Long);
            assert!(period.may_erase() && !period.may_enable());
        }
    }

    #[test]
    fn hardware_that_does_not_take_it_allows_nothing_and_ends_the_wait() {
        let period = WatchdogPeriod::new(10);
        let watchdog = Slow::new(&period, 1000);
        assert_eq!(period.shorten(&watchdog), Err(Stuck));
        assert!(!period.may_enable() && !period.may_erase());
        assert_eq!(period.lengthen(&watchdog), Err(Stuck));
        assert!(!period.may_enable() && !period.may_erase());
    }
}
