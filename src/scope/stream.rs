//! Signals as a live view has them: a sample at a time, given away.

use super::error::ScopeError;
use super::readers::WordReaders;
use super::signals::{MOST_SIGNALS, Signals};
use crate::axis::Axis;

/// A sample of a live view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// Number of its tick, by which a gap shows.
    pub tick: u32,
    /// A word of each signal, in their order, 0 behind the last.
    pub words: [i32; MOST_SIGNALS],
}

/// Samples signals every so many ticks.
#[derive(Clone, Debug)]
pub struct Stream {
    signals: Signals,
    every: u16,
    rest: u16,
    words: WordReaders,
}

impl Stream {
    /// Samples from the next tick on, every `every` ticks.
    ///
    /// # Errors
    /// [`ScopeError::NoDecimation`].
    pub fn new(signals: Signals, every: u16) -> Result<Self, ScopeError> {
        if every == 0 {
            return Err(ScopeError::NoDecimation);
        }
        Ok(Self {
            signals,
            every,
            rest: 0,
            words: WordReaders::of(&signals),
        })
    }

    /// What is sampled.
    #[must_use]
    pub const fn signals(&self) -> &Signals {
        &self.signals
    }

    /// Ticks from sample to sample.
    #[must_use]
    pub const fn every(&self) -> u16 {
        self.every
    }

    /// The sample of the step just past, where there is one. To be called after every step.
    #[inline(never)]
    pub fn take(&mut self, axis: &Axis<'_>) -> Option<Sample> {
        if let Some(rest) = self.rest.checked_sub(1) {
            self.rest = rest;
            return None;
        }
        self.rest = self.every.wrapping_sub(1);
        let mut words = [0; MOST_SIGNALS];
        self.words.read(axis, &mut words);
        Some(Sample {
            tick: axis.outputs().tick,
            words,
        })
    }
}

impl Signals {
    /// The whole values in the step just past, in order and 0 behind the last: what a stream's low words begin from.
    #[must_use]
    pub fn values(&self, axis: &Axis<'_>) -> [i64; MOST_SIGNALS] {
        let mut values = [0; MOST_SIGNALS];
        for (value, signal) in values.iter_mut().zip(self.as_slice()) {
            *value = signal.value_reader()(axis);
        }
        values
    }
}
