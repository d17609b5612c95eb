//! The independent watchdog: it resets the part unless the tick feeds it.
//!
//! Its clock is 17 to 47 kHz over chips and temperature. The short period is 10 ms at the slowest one; at the fastest that is
//! 3.6 ms, 3 ticks at 1 kHz. Below 700 ticks a second it is as long as 2.5 ticks at the fastest clock.

use core::sync::atomic::{AtomicBool, AtomicU16, Ordering};

use embassy_stm32::pac::IWDG;
use embassy_stm32::pac::iwdg::vals::{Key, Pr};
use leadscrew_app::safe_state::period::{Period, Stuck, Watchdog, WatchdogPeriod};

const SLOWEST_HZ: u32 = 17_000;
const FASTEST_HZ: u32 = 47_000;
/// Longest time without food where ticks are fast enough, ms.
const LONGEST_MS: u32 = 10;
/// With the short period the clock is divided by this.
const DIVIDER: u32 = 4;
/// With the long one, by this.
const LONG_DIVIDER: u32 = 64;
/// Longest erasure of a sector, ms (datasheet, 128 KiB, 32 bits at once).
const ERASURE_MS: u32 = 2_000;
/// Longer than that by a quarter at the fastest clock.
const LONG: u16 = (FASTEST_HZ / LONG_DIVIDER * ERASURE_MS * 5 / 4 / 1000) as u16;
const _: () = assert!(LONG < 0x1000, "the watchdog counts 12 bits");

/// The short period, in clocks; [`short_period`] makes it.
static SHORT: AtomicU16 = AtomicU16::new(short_period(1000));
/// The registers are open, by a key that a feeding would take back.
static IS_OPEN: AtomicBool = AtomicBool::new(false);
/// Turns of a wait for five of its clocks, 0.3 ms at the slowest: a turn takes some 10 of the core's.
const PATIENCE: u32 = 50_000;
/// Which period is in force.
pub static PERIOD: WatchdogPeriod = WatchdogPeriod::new(PATIENCE);

/// Divided clocks of the short period at `tick_hz`.
pub const fn short_period(tick_hz: u32) -> u16 {
    let usual = SLOWEST_HZ / DIVIDER * LONGEST_MS / 1000;
    let least = FASTEST_HZ / DIVIDER * 5 / (2 * tick_hz);
    if least > usual {
        least as u16
    } else {
        usual as u16
    }
}

/// Starts it with the long period, at ticks of `tick_hz` to come; nothing but a reset stops it again. It runs on while a
/// debugger halts the processor: a halted program controls no axis.
///
/// # Errors
/// [`Stuck`]: the short period of its reset stays, which no boot outlasts.
pub fn start(tick_hz: u32) -> Result<(), Stuck> {
    SHORT.store(short_period(tick_hz), Ordering::Relaxed);
    IWDG.kr().write(|w| w.set_key(Key::START));
    lengthen()
}

/// Gives it the short period. The ticks have to run.
///
/// # Errors
/// [`Stuck`]; no axis is enabled then.
pub fn shorten() -> Result<(), Stuck> {
    PERIOD.shorten(&Iwdg)
}

/// Gives it a period that outlasts the longest erasure of a sector.
///
/// # Errors
/// [`Stuck`]; nothing may be erased then.
pub fn lengthen() -> Result<(), Stuck> {
    PERIOD.lengthen(&Iwdg)
}

/// Its registers; thread mode alone changes the period.
struct Iwdg;

impl Watchdog for Iwdg {
    fn is_settled(&self) -> bool {
        IWDG.sr().read().0 == 0
    }

    fn set(&self, period: Period) {
        let (divider, reload) = match period {
            Period::Short => (Pr::DIVIDE_BY4, SHORT.load(Ordering::Relaxed)),
            Period::Long => (Pr::DIVIDE_BY64, LONG),
        };
        IS_OPEN.store(true, Ordering::SeqCst);
        IWDG.kr().write(|w| w.set_key(Key::ENABLE));
        IWDG.pr().write(|w| w.set_pr(divider));
        // It counts from the reload value to zero and once more.
        IWDG.rlr().write(|w| w.set_rl(reload.saturating_sub(1)));
        IS_OPEN.store(false, Ordering::SeqCst);
    }

    fn feed(&self) {
        IWDG.kr().write(|w| w.set_key(Key::RESET));
    }
}

/// Feeds it: the tick does, an erasure before each sector, and a board that has stopped for good.
#[inline(always)]
pub fn feed() {
    if !IS_OPEN.load(Ordering::Relaxed) {
        Iwdg.feed();
    }
}
