//! What a tick took from the ring.

use core::ops::Range;

use leadscrew::hal::Capture;

/// Words of the ring that hold the edges of a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span<const WORDS: usize> {
    pub(super) start: usize,
    pub(super) len: usize,
}

impl<const WORDS: usize> Span<WORDS> {
    /// Edges in it, at most half the ring.
    #[inline]
    #[must_use]
    pub const fn len(&self) -> usize {
        self.len
    }

    /// No edges.
    #[inline]
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The two runs of words, older first, within the ring; the second is empty unless the span goes over the ring's end.
    #[inline]
    #[must_use]
    pub fn runs(&self) -> [Range<usize>; 2] {
        let end = self.start.wrapping_add(self.len);
        let over = end.saturating_sub(WORDS);
        [self.start..end.wrapping_sub(over), 0..over]
    }

    /// The edges in a ring that nobody writes meanwhile; empty slices if the words were not there.
    #[inline]
    #[must_use]
    pub fn slices<'a>(&self, ring: &'a [u32; WORDS]) -> [&'a [u32]; 2] {
        self.runs().map(|run| ring.get(run).unwrap_or(&[]))
    }
}

/// A tick's sample with the edges that belong to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Taken<const WORDS: usize> {
    /// The x4 count at the sample.
    pub count: u32,
    /// Counts since the last sample; 0 in the first tick.
    pub moved: i32,
    /// The instant of the sample: latched time plus skew.
    pub sampled_at: u32,
    /// Time of the newest edge, if one came.
    pub last_edge_at: Option<u32>,
    /// Times were lost.
    pub overrun: bool,
    /// Where the edges lie.
    pub span: Span<WORDS>,
}

impl<const WORDS: usize> Taken<WORDS> {
    /// The capture with `edges`, which are the words of [`Self::span`]; latches are the caller's to fill in.
    // In place: the result is larger than 64 bytes.
    #[inline(always)]
    #[must_use]
    pub const fn capture<'a>(&self, edges: [&'a [u32]; 2]) -> Capture<'a> {
        Capture {
            count: self.count,
            sampled_at: self.sampled_at,
            last_edge_at: self.last_edge_at,
            edges,
            illegal: 0,
            overrun: self.overrun,
            touching: false,
            index: None,
            probe: None,
            home: None,
        }
    }
}
