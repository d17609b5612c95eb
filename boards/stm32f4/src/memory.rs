//! What lies in the CCM, which no DMA reaches: memory to work with, lent by the link, and the queue of reports.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicBool, Ordering};

use heapless::spsc::Queue;
use leadscrew::calibration::Work;
use leadscrew_app::link::WorkMemory;
use leadscrew_app::report::Report;

/// Words of the work memory, and its halves: as many edges of an encoder can be learned.
pub const WORDS: usize = leadscrew_app::link::WORDS;
/// Ticks that thread mode may be behind.
pub const REPORTS: usize = 24;

type Memory = WorkMemory<WORDS, WORDS>;

/// A place that is given away once. The start neither clears nor loads it.
struct Place<T> {
    memory: UnsafeCell<MaybeUninit<T>>,
}

// SAFETY: reached by `take` alone, which gives it away once.
unsafe impl<T: Send> Sync for Place<T> {}

impl<T> Place<T> {
    const fn new() -> Self {
        Self {
            memory: UnsafeCell::new(MaybeUninit::uninit()),
        }
    }

    /// The place, at the first call. The flag is not part of it, as nobody clears it.
    #[expect(clippy::mut_from_ref, reason = "it is given away once")]
    fn take(&'static self, is_taken: &AtomicBool) -> Option<&'static mut MaybeUninit<T>> {
        if is_taken.swap(true, Ordering::Relaxed) {
            return None;
        }
        // SAFETY: given away once, by the flag, of which there is one for each place.
        Some(unsafe { &mut *self.memory.get() })
    }
}

/// The work memory, cleared, once.
pub fn take_work() -> Option<Work<'static>> {
    #[unsafe(link_section = ".ccm.work")]
    static WORK: Place<Memory> = Place::new();
    static IS_TAKEN: AtomicBool = AtomicBool::new(false);
    let place = WORK.take(&IS_TAKEN)?;
    // SAFETY: integers alone are in it, so all zeros are one. Written in place: it is larger than the stack.
    let memory = unsafe {
        place.as_mut_ptr().write_bytes(0, 1);
        place.assume_init_mut()
    };
    Some(memory.lend())
}

/// The queue of reports, empty, once.
pub fn take_reports() -> Option<&'static mut Queue<Report, REPORTS>> {
    #[unsafe(link_section = ".ccm.reports")]
    static QUEUE: Place<Queue<Report, REPORTS>> = Place::new();
    static IS_TAKEN: AtomicBool = AtomicBool::new(false);
    Some(QUEUE.take(&IS_TAKEN)?.write(Queue::new()))
}
