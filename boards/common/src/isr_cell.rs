//! State of an interrupt handler, made by the program before the interrupt is unmasked.

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicBool, Ordering};

/// A value that one context at a time works with; another that tries meanwhile is refused, never
/// made to wait.
pub struct IsrCell<T> {
    busy: AtomicBool,
    value: UnsafeCell<Option<T>>,
}

// SAFETY: the value is reached only by the context that swapped `busy` from false to true, until it
// stores false again. `T: Send` because it moves from the program to the interrupt.
unsafe impl<T: Send> Sync for IsrCell<T> {}

impl<T: Send> IsrCell<T> {
    /// An empty cell.
    pub const fn empty() -> Self {
        Self {
            busy: AtomicBool::new(false),
            value: UnsafeCell::new(None),
        }
    }

    /// Puts the state in. False if it is in use at this moment.
    pub fn put(&self, value: T) -> bool {
        self.lock(|place| *place = Some(value)).is_some()
    }

    /// Works with the state; `None` if there is none yet, or it is in use.
    pub fn with<R>(&self, work: impl FnOnce(&mut T) -> R) -> Option<R> {
        self.lock(|place| place.as_mut().map(work)).flatten()
    }

    fn lock<R>(&self, work: impl FnOnce(&mut Option<T>) -> R) -> Option<R> {
        if self.busy.swap(true, Ordering::Acquire) {
            return None;
        }
        // SAFETY: `busy` was false and is now ours, so nobody else is here until the store below.
        let result = work(unsafe { &mut *self.value.get() });
        self.busy.store(false, Ordering::Release);
        Some(result)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_context_that_comes_in_between_is_refused() {
        let cell = IsrCell::empty();
        assert_eq!(cell.with(|value: &mut u32| *value), None, "empty");
        assert!(cell.put(1));
        let inner = cell.with(|value| {
            *value += 1;
            (cell.with(|value| *value), cell.put(9))
        });
        assert_eq!(inner, Some((None, false)));
        assert_eq!(cell.with(|value| *value), Some(2));
    }
}
