//! Samples of signals on their own channel, several to a frame.
//!
//! A body is the tick of its first sample (4 bytes), ticks a sample (2), the number of signals (1), then sample by
//! sample the signals, 4 bytes each; the low byte first, everywhere. What is lost shows by a gap in the sequence of
//! the frames, or of the ticks from one frame to the next.

use super::frame::MAX_BODY;

/// Most signals of a sample.
pub const MAX_SIGNALS: usize = 8;
/// Bytes before the samples.
const HEAD: usize = 7;

/// Samples of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Samples<'a> {
    /// Tick of the first sample.
    pub tick: u32,
    /// Ticks a sample.
    pub every: u16,
    /// Signals of a sample.
    pub signals: usize,
    bytes: &'a [u8],
}

impl<'a> Samples<'a> {
    /// The samples in a body; `None` for one that is none.
    #[must_use]
    pub fn of(body: &'a [u8]) -> Option<Self> {
        let (&[t0, t1, t2, t3, e0, e1, signals], bytes) = body.split_first_chunk::<HEAD>()?;
        let signals = usize::from(signals);
        let is_whole = bytes.len().checked_rem(signals.wrapping_mul(4)) == Some(0);
        let may_be = (1..=MAX_SIGNALS).contains(&signals) && is_whole;
        may_be.then_some(Self {
            tick: u32::from_le_bytes([t0, t1, t2, t3]),
            every: u16::from_le_bytes([e0, e1]),
            signals,
            bytes,
        })
    }

    /// Sample by sample: its tick and its signals, those that are not there as 0.
    pub fn iter(&self) -> impl Iterator<Item = (u32, [i32; MAX_SIGNALS])> + use<'a> {
        let Self { tick, every, .. } = *self;
        let samples = self.bytes.chunks_exact(self.signals.wrapping_mul(4).max(1));
        samples.enumerate().map(move |(number, bytes)| {
            let after = u32::from(every).wrapping_mul(number as u32);
            let mut values = [0; MAX_SIGNALS];
            let (words, _) = bytes.as_chunks::<4>();
            for (value, word) in values.iter_mut().zip(words) {
                *value = i32::from_le_bytes(*word);
            }
            (tick.wrapping_add(after), values)
        })
    }
}

/// Samples on their way into a frame.
#[derive(Clone, Debug)]
pub struct Batch {
    every: u16,
    signals: usize,
    body: [u8; MAX_BODY],
    length: usize,
    /// Tick of the first sample, and of the one that is to come next.
    ticks: [u32; 2],
    /// Ticks that the first sample may wait.
    patience: u32,
}

impl Batch {
    /// An empty one of samples of `signals` (8 at most) every so many ticks, which waits at most `patience` ticks.
    #[must_use]
    pub fn new(signals: usize, every: u16, patience: u32) -> Self {
        Self {
            every,
            signals: signals.clamp(1, MAX_SIGNALS),
            body: [0; MAX_BODY],
            length: 0,
            ticks: [0; 2],
            patience,
        }
    }

    /// Adds the sample of `tick`. Bodies that are full, or interrupted by a gap before it, go to `send`.
    pub fn add(&mut self, tick: u32, values: &[i32; MAX_SIGNALS], send: &mut dyn FnMut(&[u8])) {
        let [_, next] = self.ticks;
        if self.length > 0 && tick != next {
            self.flush(send);
        }
        if self.length == 0 {
            self.begin(tick);
        }
        for value in values.iter().take(self.signals) {
            self.put(&value.to_le_bytes());
        }
        let [first, _] = self.ticks;
        self.ticks = [first, tick.wrapping_add(u32::from(self.every))];
        let is_full = self.length.wrapping_add(self.sample()) > MAX_BODY;
        if is_full || tick.wrapping_sub(first) >= self.patience {
            self.flush(send);
        }
    }

    fn sample(&self) -> usize {
        self.signals.wrapping_mul(4)
    }

    fn begin(&mut self, tick: u32) {
        self.ticks = [tick; 2];
        self.put(&tick.to_le_bytes());
        self.put(&self.every.to_le_bytes());
        self.put(&[self.signals as u8]);
    }

    fn put(&mut self, bytes: &[u8]) {
        let end = self.length.wrapping_add(bytes.len());
        if let Some(place) = self.body.get_mut(self.length..end) {
            place.copy_from_slice(bytes);
            self.length = end;
        }
    }

    fn flush(&mut self, send: &mut dyn FnMut(&[u8])) {
        send(self.body.get(..self.length).unwrap_or_default());
        self.length = 0;
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec::Vec;

    use super::*;

    /// What arrives of samples at `ticks`.
    fn arrived(signals: usize, every: u16, patience: u32, ticks: &[u32]) -> (Vec<u32>, usize) {
        let mut batch = Batch::new(signals, every, patience);
        let (mut heard, mut frames) = (Vec::new(), 0);
        for &tick in ticks {
            let values = core::array::from_fn(|place| (tick ^ place as u32).cast_signed());
            batch.add(tick, &values, &mut |body| {
                frames += 1;
                let samples = Samples::of(body).unwrap();
                assert_eq!((samples.signals, samples.every), (signals, every));
                for (tick, values) in samples.iter() {
                    for (place, value) in values.iter().take(signals).enumerate() {
                        assert_eq!(*value, (tick ^ place as u32).cast_signed());
                    }
                    heard.push(tick);
                }
            });
        }
        (heard, frames)
    }

    #[test]
    fn eight_signals_go_seven_to_a_frame() {
        let ticks: Vec<u32> = (u32::MAX - 10..=u32::MAX).chain(0..10).collect();
        assert_eq!(arrived(8, 1, 1000, &ticks), (ticks, 3));
    }

    #[test]
    fn a_gap_begins_a_new_frame_and_the_first_waits_no_longer_than_it_may() {
        let (heard, frames) = arrived(2, 5, 1000, &[0, 5, 10, 20, 25, 26]);
        assert_eq!((heard, frames), (std::vec![0, 5, 10, 20, 25], 2));
        let (heard, frames) = arrived(1, 1, 3, &[0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!((heard.len(), frames), (8, 2));
    }

    #[test]
    fn what_is_no_samples_is_none() {
        for body in [
            &[][..],
            &[0; 6],
            &[0; 7],
            &[0, 0, 0, 0, 1, 0, 9, 0, 0, 0, 0],
        ] {
            assert_eq!(Samples::of(body), None, "{body:?}");
        }
        assert_eq!(Samples::of(&[0, 0, 0, 0, 1, 0, 1, 0, 0, 0]), None);
        assert!(Samples::of(&[0, 0, 0, 0, 1, 0, 1]).is_some_and(|none| none.iter().count() == 0));
    }
}
