//! The least, the most and the mean of what was measured. Pure, so that the host tests it too.

use core::sync::atomic::{AtomicU32, Ordering};

/// Numbers that an interrupt measures and the program reads.
#[derive(Debug)]
pub struct Spread {
    least: AtomicU32,
    most: AtomicU32,
    /// In units of 2^[`COARSE`], so that 2³² of it last.
    sum: AtomicU32,
    count: AtomicU32,
}

/// Of a sum of cycles.
const COARSE: u32 = 6;

impl Spread {
    /// Of none yet.
    pub const fn new() -> Self {
        Self {
            least: AtomicU32::new(u32::MAX),
            most: AtomicU32::new(0),
            sum: AtomicU32::new(0),
            count: AtomicU32::new(0),
        }
    }

    /// One more; one context alone calls this.
    pub fn note(&self, value: u32) {
        let (least, most) = self.range();
        self.least.store(least.min(value), Ordering::Relaxed);
        self.most.store(most.max(value), Ordering::Relaxed);
        let sum = self.sum.load(Ordering::Relaxed);
        let sum = sum.wrapping_add(value >> COARSE);
        self.sum.store(sum, Ordering::Relaxed);
        let count = self.count().wrapping_add(1);
        self.count.store(count, Ordering::Relaxed);
    }

    /// Least and most.
    pub fn range(&self) -> (u32, u32) {
        let load = |place: &AtomicU32| place.load(Ordering::Relaxed);
        (load(&self.least), load(&self.most))
    }

    /// How many; 2³² ticks wrap.
    pub fn count(&self) -> u32 {
        self.count.load(Ordering::Relaxed)
    }

    /// The mean, to 2^[`COARSE`]; 0 of none.
    pub fn mean(&self) -> u32 {
        let mean = self.sum.load(Ordering::Relaxed).checked_div(self.count());
        mean.unwrap_or(0) << COARSE
    }
}
