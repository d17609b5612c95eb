//! Time for embassy: the dual timer's first half counts, its second half is the alarm.

use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering};
use core::task::Waker;

use critical_section::{CriticalSection, Mutex};
use embassy_time_driver::Driver;
use embassy_time_queue_utils::Queue;

use crate::interrupts::interrupt;
use crate::timer::{DUAL_FIRST, DUAL_SECOND};

const CLOCKS_PER_US: u64 = (crate::CLOCK_HZ / 1_000_000) as u64;
/// The counter starts 50 ms before its wrap (it takes 172 s): every run goes through one.
const FIRST_WRAP: u32 = crate::CLOCK_HZ / 20;
/// Longer waits are cut; the alarm then finds nothing expired and is set again.
const LONGEST_ALARM: u64 = 1 << 31;

struct TimeDriver {
    wraps: AtomicU32,
    queue: Mutex<RefCell<Queue>>,
}

embassy_time_driver::time_driver_impl!(static DRIVER: TimeDriver = TimeDriver {
    wraps: AtomicU32::new(0),
    queue: Mutex::new(RefCell::new(Queue::new())),
});

/// Starts the clock at zero. The line `DUALTIMER` has to be unmasked too.
pub fn start() {
    DUAL_FIRST.start_free_running(FIRST_WRAP);
}

/// Microseconds since [`start`].
pub fn now_us() -> u64 {
    DRIVER.now()
}

impl TimeDriver {
    fn clocks(&self) -> u64 {
        critical_section::with(|_| {
            let mut wraps = self.wraps.load(Ordering::Relaxed);
            let mut value = DUAL_FIRST.value();
            if DUAL_FIRST.is_due() {
                // Wrapped, and the interrupt has not counted it yet: the first reading may be of
                // either side.
                value = DUAL_FIRST.value();
                wraps += 1;
            } else {
                // Zero is when the wrap is flagged; unflagged, it is the moment before.
                value = value.max(1);
            }
            // Down from FIRST_WRAP to 1, then from 0 through 2³² − 1 to 1 again and again.
            (u64::from(wraps) << 32) + u64::from(FIRST_WRAP - 1) - u64::from(value.wrapping_sub(1))
        })
    }

    /// False if `at` has passed already.
    fn set_alarm(&self, _: CriticalSection<'_>, at: u64) -> bool {
        let now = self.clocks();
        let at = at.saturating_mul(CLOCKS_PER_US);
        if at <= now {
            return false;
        }
        let wait = (at - now).min(LONGEST_ALARM);
        DUAL_SECOND.start_once(u32::try_from(wait).expect("limited to LONGEST_ALARM"));
        true
    }

    fn wake_expired(&self, cs: CriticalSection<'_>, queue: &mut Queue) {
        // An alarm may come early (long waits are cut) or be in the past by now: the queue compares
        // with the time, whatever brought us here.
        while !self.set_alarm(cs, queue.next_expiration(self.now())) {}
    }
}

impl Driver for TimeDriver {
    fn now(&self) -> u64 {
        self.clocks() / CLOCKS_PER_US
    }

    fn schedule_wake(&self, at: u64, waker: &Waker) {
        critical_section::with(|cs| {
            let queue = &mut *self.queue.borrow_ref_mut(cs);
            if queue.schedule_wake(at, waker) {
                self.wake_expired(cs, queue);
            }
        });
    }
}

#[interrupt]
fn DUALTIMER() {
    critical_section::with(|cs| {
        if DUAL_FIRST.is_due() {
            DUAL_FIRST.acknowledge();
            DRIVER.wraps.fetch_add(1, Ordering::Relaxed);
        }
        if DUAL_SECOND.is_due() {
            DUAL_SECOND.acknowledge();
            DRIVER.wake_expired(cs, &mut DRIVER.queue.borrow_ref_mut(cs));
        }
    });
}
