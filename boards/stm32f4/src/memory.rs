//! Memory to work with, lent by the link.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicBool, Ordering};

use leadscrew::calibration::Work;
use leadscrew_app::link::WorkMemory;
use leadscrew_app::store::SET_BYTES;

/// Words of the work memory: what is left of the RAM. An encoder of 10 000 edges cannot be learned in it.
pub const WORDS: usize = 2_048;
/// Halves of it: what the store needs.
const HALVES: usize = SET_BYTES / 2;

type Memory = WorkMemory<WORDS, HALVES>;

struct Place(UnsafeCell<MaybeUninit<Memory>>);

// SAFETY: reached by `take_work` alone, which gives it away once.
unsafe impl Sync for Place {}

static WORK: Place = Place(UnsafeCell::new(MaybeUninit::uninit()));
static IS_TAKEN: AtomicBool = AtomicBool::new(false);

/// The work memory, cleared, once.
pub fn take_work() -> Option<Work<'static>> {
    if IS_TAKEN.swap(true, Ordering::Relaxed) {
        return None;
    }
    // SAFETY: given away once, by the flag. Integers alone are in it, so all zeros are one.
    let memory = unsafe {
        let place = WORK.0.get();
        place.write_bytes(0, 1);
        (*place).assume_init_mut()
    };
    Some(memory.lend())
}
