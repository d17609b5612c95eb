//! Where a recording is not even: ticks that were missed, and values that jumped.

/// Most of them that are kept of a recording.
pub const MOST_INTERRUPTIONS: usize = 4;

/// Why a sample does not follow the one before evenly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Interruption {
    /// Ticks were missed: the sample lies so many more behind the one before.
    Missed {
        /// How many.
        ticks: u32,
    },
    /// A wide value moved by 2³¹ or more, which its low words do not tell.
    Jump {
        /// Which signal, by its place in the sample.
        signal: u8,
        /// Its value in the sample before.
        from: i64,
        /// Its value in this sample.
        to: i64,
    },
}

/// An interruption and the sample that it comes before, counted from arming on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub sample: u64,
    /// Number that the tick of the sample before had.
    pub tick_before: u32,
    pub what: Interruption,
}

/// The interruptions of a ring of samples, oldest first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interruptions {
    entries: [Option<Entry>; MOST_INTERRUPTIONS],
    /// The sample of the newest one that there was no room for.
    dropped: Option<u64>,
}

impl Interruptions {
    pub const fn new() -> Self {
        Self {
            entries: [None; MOST_INTERRUPTIONS],
            dropped: None,
        }
    }

    /// Keeps one that comes before `sample`, the newest in a ring of `samples`; those that it no longer has make room.
    #[cold]
    #[inline(never)]
    pub fn keep(&mut self, sample: u64, tick_before: u32, what: &Interruption, samples: u32) {
        let oldest = sample.wrapping_add(1).saturating_sub(u64::from(samples));
        let entries = self.entries;
        let mut in_ring = entries
            .into_iter()
            .flatten()
            .filter(|entry| entry.sample > oldest);
        self.entries = core::array::from_fn(|_| in_ring.next());
        match self.entries.iter_mut().find(|place| place.is_none()) {
            Some(place) => {
                *place = Some(Entry {
                    sample,
                    tick_before,
                    what: *what,
                });
            }
            None => self.dropped = Some(sample),
        }
    }

    /// Those within a recording that begins with the sample `first`.
    pub fn after(&self, first: u64) -> impl Iterator<Item = &Entry> {
        let entries = self.entries.iter().flatten();
        entries.filter(move |entry| entry.sample > first)
    }

    /// True if one of them could not be kept.
    pub fn are_dropped_after(&self, first: u64) -> bool {
        self.dropped.is_some_and(|sample| sample > first)
    }
}
