//! What comes unasked, and waits for whoever takes it.

use std::collections::VecDeque;

use leadscrew::protocol::stream::MAX_SIGNALS;

/// Most records, and samples, kept for whoever takes them.
const MOST_KEPT: usize = 1 << 16;

/// A sample of signals: its tick, and the signals in the order of the request; 0 behind the last one.
pub type Sample = (u32, [i32; MAX_SIGNALS]);

/// What came unasked, until somebody takes it.
#[derive(Debug)]
pub(super) struct Kept<T> {
    queue: VecDeque<T>,
    /// What nobody took in time.
    dropped: u32,
}

impl<T> Default for Kept<T> {
    fn default() -> Self {
        Self {
            queue: VecDeque::new(),
            dropped: 0,
        }
    }
}

impl<T> Kept<T> {
    pub(super) fn keep(&mut self, one: T) {
        if self.queue.len() == MOST_KEPT {
            self.queue.pop_front();
            self.dropped = self.dropped.saturating_add(1);
        }
        self.queue.push_back(one);
    }

    /// The oldest one.
    pub(super) fn take(&mut self) -> Option<T> {
        self.queue.pop_front()
    }

    /// How many nobody took in time.
    pub(super) const fn dropped(&self) -> u32 {
        self.dropped
    }
}
