//! The independent watchdog: it resets the part unless the tick feeds it.
//!
//! Its clock is 17 to 47 kHz over chips and temperature. The short period is 10 ms at the slowest one; at the fastest that is
//! 3.6 ms, 3 ticks at 1 kHz. Below 700 ticks a second it is as long as 2.5 ticks at the fastest clock.

use core::sync::atomic::{AtomicBool, AtomicU16, Ordering};

use embassy_stm32::pac::IWDG;
use embassy_stm32::pac::iwdg::vals::{Key, Pr};

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
/// The registers are being written, by keys that a feeding would undo.
static IS_CHANGING: AtomicBool = AtomicBool::new(false);

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
pub fn start(tick_hz: u32) {
    SHORT.store(short_period(tick_hz), Ordering::Relaxed);
    IWDG.kr().write(|w| w.set_key(Key::START));
    lengthen();
}

/// Gives it the short period. The ticks have to run.
pub fn shorten() {
    set(Pr::DIVIDE_BY4, SHORT.load(Ordering::Relaxed));
}

/// Gives it a period that outlasts the longest erasure of a sector.
pub fn lengthen() {
    set(Pr::DIVIDE_BY64, LONG);
}

/// In thread mode alone.
fn set(divider: Pr, reload: u16) {
    IS_CHANGING.store(true, Ordering::SeqCst);
    // Each takes up to five of its clocks to get across; a write before that is lost.
    while IWDG.sr().read().0 != 0 {}
    IWDG.kr().write(|w| w.set_key(Key::ENABLE));
    IWDG.pr().write(|w| w.set_pr(divider));
    IWDG.rlr().write(|w| w.set_rl(reload));
    while IWDG.sr().read().0 != 0 {}
    IWDG.kr().write(|w| w.set_key(Key::RESET));
    IS_CHANGING.store(false, Ordering::SeqCst);
}

/// Feeds it.
#[inline(always)]
pub fn feed() {
    if !IS_CHANGING.load(Ordering::Relaxed) {
        IWDG.kr().write(|w| w.set_key(Key::RESET));
    }
}
