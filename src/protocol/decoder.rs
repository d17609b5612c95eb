//! Frames out of a stream of bytes of which nothing is to be believed.
//!
//! After anything wrong the decoder waits for the next zero byte: a good frame after it is found, whatever came before.
//! Memory is `N` bytes; a byte takes constant time, the one that ends a frame time for the checksum of `N` bytes.

use cobs::{DecodeResult, DecoderState};

use super::frame::{Broken, Frame, MAX_CONTENT, open};

/// What was dropped, by why; the counts stay at their largest value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dropped {
    /// Frames whose stuffing was wrong: bytes were lost or added, or the line began within one.
    pub torn: u32,
    /// Frames longer than the room for them.
    pub too_long: u32,
    /// Frames too short for header and checksum.
    pub too_short: u32,
    /// Frames with a wrong checksum.
    pub checksum: u32,
    /// Frames of a channel, or with a message, that is not known here.
    pub unknown: u32,
    /// Messages that came twice, or after a later one.
    pub late: u32,
}

impl Dropped {
    /// All of them.
    #[must_use]
    pub const fn total(&self) -> u32 {
        self.torn
            .saturating_add(self.too_long)
            .saturating_add(self.too_short)
            .saturating_add(self.checksum)
            .saturating_add(self.unknown)
            .saturating_add(self.late)
    }

    /// A message that is not known.
    pub const fn count_unknown(&mut self) {
        self.unknown = self.unknown.saturating_add(1);
    }

    /// A message that came twice, or after a later one.
    pub const fn count_late(&mut self) {
        self.late = self.late.saturating_add(1);
    }

    fn count(&mut self, broken: Broken) {
        let counter = match broken {
            Broken::Short => &mut self.too_short,
            Broken::Checksum => &mut self.checksum,
            Broken::Channel => &mut self.unknown,
        };
        *counter = counter.saturating_add(1);
    }
}

/// A decoder with room for contents of `N` bytes.
#[derive(Debug)]
pub struct Decoder<const N: usize = MAX_CONTENT> {
    stuffing: DecoderState,
    content: [u8; N],
    length: usize,
    /// Until the next zero byte.
    is_skipping: bool,
    dropped: Dropped,
}

impl<const N: usize> Default for Decoder<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Decoder<N> {
    /// A decoder before the first byte.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            stuffing: DecoderState::Idle,
            content: [0; N],
            length: 0,
            is_skipping: false,
            dropped: Dropped {
                torn: 0,
                too_long: 0,
                too_short: 0,
                checksum: 0,
                unknown: 0,
                late: 0,
            },
        }
    }

    /// What was dropped so far.
    #[must_use]
    pub const fn dropped(&self) -> &Dropped {
        &self.dropped
    }

    /// The same, for whoever looks into the messages.
    pub const fn dropped_mut(&mut self) -> &mut Dropped {
        &mut self.dropped
    }

    /// Takes a byte; gives the frame that it ends, if it ends a good one.
    pub fn feed(&mut self, byte: u8) -> Option<Frame<'_>> {
        if !self.ends_content(byte) {
            return None;
        }
        let content = self.content.get(..self.length).unwrap_or_default();
        open(content)
            .inspect_err(|broken| self.dropped.count(*broken))
            .ok()
    }

    /// Takes bytes, any number of them, and gives each good frame that ends in them to `take`, with the counts.
    pub fn feed_all(&mut self, bytes: &[u8], mut take: impl FnMut(&Frame<'_>, &mut Dropped)) {
        for &byte in bytes {
            if self.ends_content(byte) {
                let content = self.content.get(..self.length).unwrap_or_default();
                match open(content) {
                    Ok(frame) => take(&frame, &mut self.dropped),
                    Err(broken) => self.dropped.count(broken),
                }
            }
        }
    }

    /// Takes a byte; true if it ends a content that was stuffed rightly and had room.
    fn ends_content(&mut self, byte: u8) -> bool {
        if self.is_skipping {
            self.is_skipping = byte != 0;
            return false;
        }
        match self.stuffing.feed(byte) {
            Ok(DecodeResult::NoData) => false,
            Ok(DecodeResult::DataStart) => {
                self.length = 0;
                false
            }
            Ok(DecodeResult::DataContinue(byte)) => {
                self.keep(byte);
                false
            }
            Ok(DecodeResult::DataComplete) => true,
            // It says so at a zero byte within a run, so what comes next may be a frame.
            Err(_) => {
                self.dropped.torn = self.dropped.torn.saturating_add(1);
                false
            }
        }
    }

    fn keep(&mut self, byte: u8) {
        if let Some(place) = self.content.get_mut(self.length) {
            *place = byte;
            self.length = self.length.wrapping_add(1);
        } else {
            self.dropped.too_long = self.dropped.too_long.saturating_add(1);
            self.stuffing = DecoderState::Idle;
            // A zero may stand for itself only at the end of a frame, so the byte kept here was none.
            self.is_skipping = true;
        }
    }
}
