//! Signals of an axis over time, whole and in the units of people.

use leadscrew::scope::{Signal, Unwrap};

use crate::scale::{Physical, Scale};

/// Signals of an axis, sample by sample; of the scope, or of a live view.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// What the bits are in the units of people.
    pub scale: Scale,
    /// The signals.
    pub signals: Vec<Signal>,
    /// Ticks from sample to sample, where none is missing.
    pub every: u16,
    /// The tick of each sample; the first one as the axis counts it, and without wrap from there on.
    pub ticks: Vec<i64>,
    /// Signal by signal the whole values, in bits.
    pub columns: Vec<Vec<i64>>,
    /// The sample of the trigger, if there was one.
    pub trigger: Option<usize>,
    /// There were more interruptions than the axis keeps: before the last ones times and positions are not to be trusted.
    pub is_torn: bool,
}

impl Recording {
    /// One without samples.
    #[must_use]
    pub fn new(scale: Scale, signals: &[Signal], every: u16) -> Self {
        Self {
            scale,
            signals: signals.to_vec(),
            every,
            ticks: Vec::new(),
            columns: vec![Vec::new(); signals.len()],
            trigger: None,
            is_torn: false,
        }
    }

    /// Number of samples.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.ticks.len()
    }

    /// True without samples.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.ticks.is_empty()
    }

    /// The whole values of a signal, in bits, if it was recorded.
    #[must_use]
    pub fn bits(&self, signal: Signal) -> Option<&[i64]> {
        let place = self.signals.iter().position(|&one| one == signal)?;
        self.columns.get(place).map(Vec::as_slice)
    }

    /// The values of a signal in its unit, if it was recorded.
    #[must_use]
    pub fn values(&self, signal: Signal) -> Option<Vec<f64>> {
        let physical = self.physical(signal);
        let bits = self.bits(signal)?;
        Some(bits.iter().map(|&bits| physical.value(bits)).collect())
    }

    /// Unit of a signal, and its bit.
    #[must_use]
    pub fn physical(&self, signal: Signal) -> Physical {
        self.scale.of(signal)
    }

    /// Times of the samples, s: from the trigger, or from the first one where there is none.
    #[must_use]
    pub fn times(&self) -> Vec<f64> {
        let at = self.trigger.unwrap_or(0);
        let zero = self.ticks.get(at).or(self.ticks.last());
        let zero = zero.copied().unwrap_or(0);
        let time = |&tick: &i64| (tick - zero) as f64 / self.scale.tick_hz;
        self.ticks.iter().map(time).collect()
    }

    /// Samples that are missing between the first one and the last.
    #[must_use]
    pub fn missing(&self) -> u64 {
        let every = i64::from(self.every.max(1));
        let missing = |pair: &[i64]| ((pair[1] - pair[0]) / every - 1).max(0).cast_unsigned();
        self.ticks.windows(2).map(missing).sum()
    }

    /// True if it has each of these signals.
    #[must_use]
    pub fn has(&self, signals: &[Signal]) -> bool {
        signals.iter().all(|signal| self.signals.contains(signal))
    }

    /// Adds a sample of whole values, in the order of the signals.
    pub fn push(&mut self, tick: i64, values: impl IntoIterator<Item = i64>) {
        self.ticks.push(tick);
        for (column, value) in self.columns.iter_mut().zip(values) {
            column.push(value);
        }
    }
}

/// Makes a recording of ticks that wrap and of low words.
#[derive(Debug)]
pub(crate) struct Builder {
    pub recording: Recording,
    unwraps: Vec<Unwrap>,
}

impl Builder {
    /// From whole values at the first sample, or near it.
    pub fn new(recording: Recording, bases: &[i64]) -> Self {
        let signals = recording.signals.iter();
        let unwraps = signals
            .zip(bases)
            .map(|(&signal, &base)| Unwrap::new(signal, base))
            .collect();
        Self { recording, unwraps }
    }

    /// A signal goes on from another value.
    pub fn jump(&mut self, signal: usize, to: i64) {
        if let Some(unwrap) = self.unwraps.get_mut(signal) {
            unwrap.set(to);
        }
    }

    /// Adds a sample.
    pub fn push(&mut self, tick: u32, words: &[i32]) {
        let whole = match self.recording.ticks.last() {
            Some(&last) => last + i64::from(tick.wrapping_sub(last as u32).cast_signed()),
            None => i64::from(tick),
        };
        let values = self.unwraps.iter_mut().zip(words);
        let values: Vec<_> = values.map(|(unwrap, &word)| unwrap.take(word)).collect();
        self.recording.push(whole, values);
    }
}
