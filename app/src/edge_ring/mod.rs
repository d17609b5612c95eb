//! From a ring of edge times, written by DMA, and one sample of the counter to a capture.
//!
//! ```text
//! A, B ─┬─► counter (x4) ──────────── count ┐ latched at one instant by the tick timer's trigger
//!       └─► A ⊕ B ─► timer ──┬─────── time  ┘
//!                            └─► DMA ─► ring of words: the time of every edge
//! ```
//!
//! # Which edges belong to a tick
//!
//! Those that the count has seen: an edge is taken in the tick in whose sample it was counted, once and in order. Count and
//! time are latched by one trigger, so code may come as late as it likes; edges that came after the sample are in the ring by
//! then, are told by their time and stay for the next tick.
//!
//! The two timers see an edge through filters and synchronisers of their own, a few clocks apart. An edge within
//! [`EdgeRing::new`]'s `skew` of the sample may have been counted or not, whatever its time says: the count decides. Every
//! edge moves the count by one, so a tick has as many edges as counts modulo 2, in whatever order they went up and down. Edges
//! that are at least 2·skew + 1 clocks apart leave one in doubt at most, so that this parity decides it without ambiguity,
//! reversals included; [`crate::input_filter`] gives a filter that passes no closer ones. If a disturbance brings several in
//! spite of it, as many are taken as explain the count, and failing that as the parity and the times ask for.
//!
//! An edge that was counted may so have a time up to `skew` after the sample. No time may lie after its capture's, so the
//! instant that a capture states is the latched one plus `skew`, in every tick the same. It shifts the axis in time by less
//! than the filter does.
//!
//! # What is lost is told
//!
//! `overrun` is set where
//! - the ring has fewer edges than the count moved, or a number that differs from it in parity: a time was lost, or the ring
//!   went round whole laps and shows only the rest;
//! - more than half the ring is unread, or the DMA passed both the middle and the end since the last tick, as its two flags
//!   tell: that takes half a ring at least, so a whole lap cannot hide behind a reversal that keeps the count still;
//! - the timer says that a capture overwrote another.
//!
//! A tick whose times were lost for want of room gives no edges but the newest; the next one starts from there.
//!
//! # Why nobody writes what a slice borrows
//!
//! A capture borrows the ring itself: a copy of 1 200 words a tick would cost as much as their evaluation. [`Span`] says
//! which words; making slices of them is the board's, as the ring is memory that hardware writes, and sound for these reasons:
//! 1. The words of a span are finished: they lie before the DMA's position as it was read, and the DMA moves on only.
//! 2. The DMA comes back to them after `WORDS` − unread further edges, and a span is given only where at most half the ring is
//!    unread. So at least half a ring has to come while the slices live, which is until the tick ends, less than a period after
//!    its sample. [`hold`] refuses a ring that is shorter than four ticks at the highest rate of edges, or in which the filter of
//!    the inputs, which no noise outruns, would let half a ring through in a tick.
//! 3. A tick that does not end in time is counted, and the watchdog ends it. Whether the DMA did come round is found by the
//!    next tick, by the second rule of `overrun`, for it then wrote half a ring at least.
//! 4. The position is read by a volatile access before the words are, with a compiler fence (acquire) between; slices are made
//!    after it. Cortex-M4 has no data cache.
//!
//! # What the board keeps to
//!
//! - In the handler it reads the latched sample first, the DMA's flags next, its position last: an edge before the sample then
//!   had all those bus cycles to arrive. Flags that were read as set are cleared, and no others.
//! - The stream runs in direct mode, so that its position is ahead of memory by one word at most and for some clocks only. A
//!   newest word that is older than the last sample was not written yet, and is left for the next tick.
//! - The handler starts within a tick of the sample; the timer's overcapture flag says if a latch was overwritten.
//! - The counter's two low bits are preset to tell the levels (`leadscrew::hal::Capture`).

mod hold;
mod stamp;
mod taken;
mod widen;

pub use hold::{HoldError, hold};
pub use stamp::count_at;
pub use taken::{Span, Taken};
pub use widen::{Clock16, Counter16};

/// What hardware latched at the sampling instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sample {
    /// The x4 count.
    pub count: u32,
    /// The timer of the edges.
    pub time: u32,
}

/// What the handler read of the DMA stream, some time after the sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Words that are left of the lap (NDTR): the ring's length at its start.
    pub remaining: u16,
    /// The half-transfer flag was set since the last tick.
    pub passed_middle: bool,
    /// The transfer-complete flag was set since the last tick.
    pub passed_end: bool,
    /// A time was lost: the timer's overcapture flag, or an error of the stream.
    pub is_lossy: bool,
}

/// Reader of a ring of `WORDS` edge times, a power of two from 8 to 32 768.
#[derive(Clone, Debug)]
pub struct EdgeRing<const WORDS: usize> {
    skew: u32,
    read: usize,
    last: Option<Sample>,
}

/// The newest unread edges, sorted by what the sample's time says of them; all older ones belong to the sample.
struct Newest {
    /// Those that came after it, or are not written yet.
    later: usize,
    /// Those before, in doubt.
    doubtful: usize,
    /// Of those in doubt, the ones whose time is not after the sample's.
    by_time: usize,
}

impl Newest {
    /// How many of those in doubt were counted, where `certain` edges are not in doubt and the count moved by `wanted`.
    const fn counted(&self, certain: usize, wanted: usize) -> usize {
        if let Some(rest) = wanted.checked_sub(certain)
            && rest <= self.doubtful
        {
            return rest;
        }
        let is_even = certain.wrapping_add(self.by_time).wrapping_sub(wanted) & 1 == 0;
        if is_even || self.doubtful == 0 {
            self.by_time
        } else if self.by_time < self.doubtful {
            self.by_time.wrapping_add(1)
        } else {
            self.by_time.wrapping_sub(1)
        }
    }
}

impl<const WORDS: usize> EdgeRing<WORDS> {
    const MASK: usize = {
        assert!(
            WORDS.is_power_of_two() && WORDS >= 8 && WORDS <= 0x8000,
            "the ring's length is a power of two from 8 to 32 768: what a DMA counter of 16 bits holds"
        );
        WORDS - 1
    };

    /// A reader of a ring whose counter and timer see an edge up to `skew` clocks of the timer apart.
    #[must_use]
    pub const fn new(skew: u16) -> Self {
        Self {
            skew: skew as u32,
            read: 0,
            last: None,
        }
    }

    /// The edges that belong to a sample. `word` reads one word of the ring, by its index, below `WORDS`.
    ///
    /// The first call takes the origin and gives no edges. Its time grows with the edges that came between sample and call,
    /// by one read of a word each.
    pub fn take(
        &mut self,
        sample: Sample,
        progress: Progress,
        word: impl Fn(usize) -> u32,
    ) -> Taken<WORDS> {
        let write = WORDS.wrapping_sub(usize::from(progress.remaining)) & Self::MASK;
        let unread = write.wrapping_sub(self.read) & Self::MASK;
        let last = self.last.replace(sample);
        let moved = last.map_or(0, |last| {
            sample.count.wrapping_sub(last.count).cast_signed()
        });
        // Of the first sample nothing is too old.
        let elapsed = last.map_or(u32::MAX, |last| sample.time.wrapping_sub(last.time));

        let newest = self.sort(unread, elapsed, |back| {
            let at = write.wrapping_sub(back).wrapping_sub(1) & Self::MASK;
            sample.time.wrapping_sub(word(at)).cast_signed()
        });
        let certain = unread
            .wrapping_sub(newest.later)
            .wrapping_sub(newest.doubtful);
        let wanted = moved.unsigned_abs() as usize;
        let counted = newest.counted(certain, wanted);
        let edges = certain.wrapping_add(counted);
        let left = unread.wrapping_sub(edges);
        self.read = write.wrapping_sub(left) & Self::MASK;

        let is_lapped = (progress.passed_middle && progress.passed_end) || unread > WORDS / 2;
        let is_explained = edges >= wanted && edges.wrapping_sub(wanted) & 1 == 0;
        let len = if is_lapped || last.is_none() {
            0
        } else {
            edges
        };
        Taken {
            count: sample.count,
            moved,
            sampled_at: sample.time.wrapping_add(self.skew),
            last_edge_at: (edges > 0 && last.is_some())
                .then(|| word(self.read.wrapping_sub(1) & Self::MASK)),
            overrun: last.is_some() && (progress.is_lossy || is_lapped || !is_explained),
            span: Span {
                start: self.read.wrapping_sub(len) & Self::MASK,
                len,
            },
        }
    }

    /// Sorts the newest of `unread` edges; `age` gives by how much an edge, counted back from the newest, lies before the
    /// sample.
    fn sort(&self, unread: usize, elapsed: u32, age: impl Fn(usize) -> i32) -> Newest {
        let skew = self.skew.cast_signed();
        let oldest = elapsed.saturating_add(self.skew);
        let is_unwritten = unread > 0 && u32::try_from(age(0)).is_ok_and(|age| age > oldest);
        let mut later = usize::from(is_unwritten);
        while later < unread && age(later) < skew.wrapping_neg() {
            later = later.wrapping_add(1);
        }
        let (mut doubtful, mut by_time) = (0_usize, 0_usize);
        while let back = later.wrapping_add(doubtful)
            && back < unread
            && age(back) <= skew
        {
            by_time = by_time.wrapping_add(usize::from(age(back) >= 0));
            doubtful = doubtful.wrapping_add(1);
        }
        Newest {
            later,
            doubtful,
            by_time,
        }
    }
}
