//! Where the shaft was lately: means of edges at their times, as far back as a touch may need.

use super::config::TIME_FRAC;
use crate::edges::{EdgeSample, Span};
use crate::estimator::polynomial::window::PLACE_FRAC;
use crate::estimator::shift_rounded;
use crate::units::Position;

/// Samples that are kept.
pub const CAPACITY: usize = 24;

/// The mean of some edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sample {
    /// Time, ticks with [`TIME_FRAC`] fractional bits; wraps.
    pub time: u32,
    /// Place, d with [`PLACE_FRAC`] fractional bits; wraps.
    pub place: i32,
    /// Edges.
    pub edges: u32,
}

impl Sample {
    /// The mean of both, weighed by their edges. What the share of the other one lacks moves place and time alike, along the
    /// motion.
    fn merge(&mut self, other: Self) {
        const SHARE_FRAC: u32 = 15;
        let edges = self.edges.wrapping_add(other.edges);
        let share = other
            .edges
            .wrapping_shl(SHARE_FRAC)
            .checked_div(edges)
            .unwrap_or(0);
        let part = |way: i32| {
            i64::from(way)
                .wrapping_mul(i64::from(share))
                .wrapping_shr(SHARE_FRAC) as i32
        };
        let later = part(other.time.wrapping_sub(self.time).cast_signed());
        self.time = self.time.wrapping_add_signed(later);
        let ahead = part(other.place.wrapping_sub(self.place));
        self.place = self.place.wrapping_add(ahead);
        self.edges = edges;
    }
}

/// No sample is older, ticks with [`TIME_FRAC`].
pub const OLDEST: u32 = 1024 << TIME_FRAC;
/// Edges above this in one sample would not fit its weights.
const MOST_EDGES: u32 = 1 << 16;

/// The newest [`CAPACITY`] samples, one a millisecond or a tick at the most.
#[derive(Clone, Debug)]
pub struct History {
    samples: [Sample; CAPACITY],
    newest: usize,
    count: usize,
    /// The sampling instant.
    now: u32,
    /// When the newest sample was begun.
    begun: u32,
}

impl History {
    /// Without a sample.
    pub const fn new() -> Self {
        Self {
            samples: [Sample {
                time: 0,
                place: 0,
                edges: 0,
            }; CAPACITY],
            newest: 0,
            count: 0,
            now: 0,
            begun: 0,
        }
    }

    /// Forgets all.
    pub const fn clear(&mut self) {
        self.count = 0;
    }

    /// The sampling instant; wraps.
    pub const fn now(&self) -> u32 {
        self.now
    }

    /// Goes on by a tick of `elapsed` with what its edges told; what comes within `sample` goes into one mean.
    pub fn note(&mut self, elapsed: Span, found: Option<EdgeSample>, sample: u32) {
        const BITS: u32 = Span::FRAC_NBITS - TIME_FRAC;
        self.now = self.now.wrapping_add(elapsed.to_bits().wrapping_shr(BITS));
        if self.newest_age() > OLDEST {
            // Before the times wrap.
            self.clear();
        }
        let Some(found) = found else {
            return;
        };
        let place = shift_rounded(found.position.to_bits(), Position::FRAC_NBITS - PLACE_FRAC);
        let found = Sample {
            time: self
                .now
                .wrapping_sub(found.age.to_bits().wrapping_shr(BITS)),
            place: place as i32,
            edges: found.edges,
        };
        // By half a tick, so that the jitter of a sampling instant does not decide.
        let age = self
            .now
            .wrapping_sub(self.begun)
            .wrapping_add(1 << (TIME_FRAC - 1));
        match self.samples.get_mut(self.newest) {
            Some(newest) if self.count > 0 && age < sample && newest.edges < MOST_EDGES => {
                newest.merge(found);
            }
            _ => self.push(found),
        }
    }

    fn newest_age(&self) -> u32 {
        let newest = self.newest_first().next();
        newest.map_or(0, |sample| self.now.wrapping_sub(sample.time))
    }

    fn push(&mut self, found: Sample) {
        self.begun = self.now;
        self.newest = self.newest.checked_sub(1).unwrap_or(CAPACITY - 1);
        if let Some(place) = self.samples.get_mut(self.newest) {
            *place = found;
        }
        self.count = self.count.saturating_add(1).min(CAPACITY);
    }

    /// Samples, newest first.
    pub fn newest_first(&self) -> impl Iterator<Item = &Sample> + Clone {
        let (after, from) = self.samples.split_at(self.newest.min(CAPACITY));
        from.iter().chain(after).take(self.count)
    }
}
