//! How the tick reads a list of signals.

use super::signal::{Kind, ReadValue, ReadWord, Signal};
use super::signals::{MOST_SIGNALS, Signals};
use crate::axis::Axis;

/// Reads the words of a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct WordReaders {
    readers: [ReadWord; MOST_SIGNALS],
    length: usize,
}

impl WordReaders {
    pub fn of(signals: &Signals) -> Self {
        let mut readers = [Signal::Tick.word_reader(); MOST_SIGNALS];
        for (reader, signal) in readers.iter_mut().zip(signals.as_slice()) {
            *reader = signal.word_reader();
        }
        Self {
            readers,
            length: signals.len(),
        }
    }

    /// Words of a sample.
    #[inline]
    pub const fn len(&self) -> usize {
        self.length
    }

    /// Writes a sample, as far as `words` go.
    #[inline]
    pub fn read(&self, axis: &Axis<'_>, words: &mut [i32]) {
        let readers = self.readers.get(..self.length).unwrap_or_default();
        for (word, read) in words.iter_mut().zip(readers) {
            *word = read(axis);
        }
    }
}

/// The wide signals of a list, with their values in the newest sample.
#[derive(Clone, Debug)]
pub(super) struct Wide {
    signals: [WideSignal; MOST_SIGNALS],
    length: usize,
}

#[derive(Clone, Copy, Debug)]
struct WideSignal {
    newest: i64,
    read: ReadValue,
    /// Place in the sample.
    place: u8,
}

/// A value that moved farther than a low word tells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jump {
    pub place: u8,
    pub from: i64,
    pub to: i64,
}

impl Wide {
    pub fn of(signals: &Signals) -> Self {
        let none = WideSignal {
            newest: 0,
            read: Signal::Tick.value_reader(),
            place: 0,
        };
        let mut wide = [none; MOST_SIGNALS];
        let is_wide = |(_, signal): &(u8, &Signal)| matches!(signal.kind(), Kind::Wide);
        let listed = (0_u8..).zip(signals.as_slice()).filter(is_wide);
        let length = listed.clone().count();
        for (entry, (place, signal)) in wide.iter_mut().zip(listed) {
            entry.read = signal.value_reader();
            entry.place = place;
        }
        Self {
            signals: wide,
            length,
        }
    }

    /// Takes the values of the sample that was just read; tells those that jumped since the one before.
    #[inline]
    pub fn note(&mut self, axis: &Axis<'_>, mut tell: impl FnMut(&Jump)) {
        let signals = self.signals.get_mut(..self.length).unwrap_or_default();
        for signal in signals {
            let to = (signal.read)(axis);
            let from = core::mem::replace(&mut signal.newest, to);
            let step = to.wrapping_sub(from);
            if step != i64::from(step as i32) {
                let place = signal.place;
                tell(&Jump { place, from, to });
            }
        }
    }

    /// The value in the newest sample of the wide signal at a place of the sample.
    pub fn newest(&self, place: usize) -> i64 {
        let mut signals = self.signals.iter().take(self.length);
        let signal = signals.find(|signal| usize::from(signal.place) == place);
        signal.map_or(0, |signal| signal.newest)
    }
}
