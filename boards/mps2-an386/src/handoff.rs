//! Values passed from one interrupt to another of different priority, without a critical section.
//!
//! ```text
//!  machine (low priority)                  control tick (high priority)
//!    Giver<Inputs>  ──────► Handoff ──────►  Taker<Inputs>
//!    Taker<Outputs> ◄────── Handoff ◄──────  Giver<Outputs>
//! ```
//!
//! The value belongs to one side at a time and is worked on in place, so a large one (edge times) is
//! not copied. Neither side ever waits: a value that is not there, or not fetched yet, is an answer.

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicBool, Ordering};

/// A place for one value between one giver and one taker.
pub struct Handoff<T> {
    full: AtomicBool,
    value: UnsafeCell<T>,
}

// SAFETY: the value is reached only through the one `Giver` and the one `Taker` that `split` makes
// (it takes the handoff by `&'static mut`, so it can be called once), and `full` says whose turn it
// is: the giver touches the value only while `full` is false and only the giver sets it, the taker
// only while it is true and only the taker clears it. Each sets it after its last access (Release)
// and the other reads it before its first one (Acquire). An interrupt that preempts the other side
// in the middle of an access finds the flag still unset and keeps off. `T: Send` because the value
// moves between contexts.
unsafe impl<T: Send> Sync for Handoff<T> {}

/// The side that fills in values.
pub struct Giver<T: 'static>(&'static Handoff<T>);

/// The side that reads them.
pub struct Taker<T: 'static>(&'static Handoff<T>);

/// The last value has not been taken yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotTaken;

impl<T> Handoff<T> {
    /// An empty handoff; `value` is what the giver finds to fill in first.
    pub const fn new(value: T) -> Self {
        Self {
            full: AtomicBool::new(false),
            value: UnsafeCell::new(value),
        }
    }

    /// The two sides.
    pub fn split(&'static mut self) -> (Giver<T>, Taker<T>) {
        (Giver(self), Taker(self))
    }
}

impl<T: Send> Giver<T> {
    /// Fills in a value and passes it on, unless the last one has not been taken.
    pub fn give(&mut self, fill: impl FnOnce(&mut T)) -> Result<(), NotTaken> {
        if self.0.full.load(Ordering::Acquire) {
            return Err(NotTaken);
        }
        // SAFETY: `full` is false, so the value is the giver's until the store below (see `Sync`);
        // `&mut self` keeps the giver itself from coming here twice.
        fill(unsafe { &mut *self.0.value.get() });
        self.0.full.store(true, Ordering::Release);
        Ok(())
    }
}

impl<T: Send> Giver<T> {
    /// Reads what was given and taken last, unless it has not been taken.
    pub fn look<R>(&self, read: impl FnOnce(&T) -> R) -> Result<R, NotTaken> {
        if self.0.full.load(Ordering::Acquire) {
            return Err(NotTaken);
        }
        // SAFETY: as in `give`: the value is the giver's while `full` is false.
        Ok(read(unsafe { &*self.0.value.get() }))
    }
}

impl<T: Send> Taker<T> {
    /// Reads the value and passes the place back, if there is one.
    pub fn take<R>(&mut self, read: impl FnOnce(&T) -> R) -> Option<R> {
        if !self.0.full.load(Ordering::Acquire) {
            return None;
        }
        // SAFETY: `full` is true, so the value is the taker's until the store below (see `Sync`);
        // `&mut self` keeps the taker itself from coming here twice.
        let result = read(unsafe { &*self.0.value.get() });
        self.0.full.store(false, Ordering::Release);
        Some(result)
    }
}
