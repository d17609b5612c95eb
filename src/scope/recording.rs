//! What a scope recorded, for whoever reads it outside the tick.

use super::interruptions::{Interruption, Interruptions};
use super::readers::Wide;
use super::signal::Kind;
use super::unwrap::nearest;
use super::{MOST_SIGNALS, Scope, Setup, State};

/// An interruption of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Interrupted {
    /// It lies between this sample and the one before.
    pub sample: u32,
    /// What it is.
    pub what: Interruption,
}

/// What a scope recorded, oldest sample first. Sample n is that of tick [`Self::first_tick`] + n × `every`, and later by the
/// ticks [missed](Interruption::Missed) until then.
#[derive(Clone, Copy, Debug)]
pub struct Recording<'s> {
    setup: &'s Setup,
    words: &'s [i32],
    /// Place in the ring of the first sample.
    start: u32,
    length: u32,
    /// Number of the first sample, counted from arming on.
    first: u64,
    trigger: Option<(u32, u32)>,
    newest_tick: u32,
    wide: &'s Wide,
    interruptions: &'s Interruptions,
}

impl<'s> Recording<'s> {
    pub(super) fn of(scope: &'s Scope<'_>) -> Self {
        let setup = &scope.setup;
        let is_triggered = scope.left > 0 || matches!(scope.state, State::Complete);
        let length = if is_triggered {
            setup.samples.wrapping_sub(scope.left)
        } else {
            u32::try_from(scope.taken).map_or(setup.samples, |taken| taken.min(setup.samples))
        };
        let width = setup.signals.len();
        let next = scope.next.checked_div(width).unwrap_or(0) as u32;
        // Back from the place that comes next, once round where that is before the beginning.
        let start = next.checked_sub(length);
        let start = start.unwrap_or_else(|| next.wrapping_add(setup.samples).wrapping_sub(length));
        Self {
            setup,
            words: scope.memory.get(..scope.end).unwrap_or_default(),
            start,
            length,
            first: scope.taken.wrapping_sub(u64::from(length)),
            trigger: is_triggered.then_some((scope.before, scope.trigger_tick)),
            newest_tick: scope.newest_tick,
            wide: &scope.wide,
            interruptions: &scope.interruptions,
        }
    }

    /// What was to be recorded.
    #[must_use]
    pub const fn setup(&self) -> &'s Setup {
        self.setup
    }

    /// Number of samples.
    #[must_use]
    pub const fn len(&self) -> u32 {
        self.length
    }

    /// True without samples: stopped before the first tick.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// The sample of the trigger: the first of its tick or behind it. None without a trigger, and [`Self::len`] where the
    /// scope was stopped between the two.
    #[must_use]
    pub fn trigger_sample(&self) -> Option<u32> {
        self.trigger.map(|(sample, _)| sample)
    }

    /// The tick in which the trigger was seen.
    #[must_use]
    pub fn trigger_tick(&self) -> Option<u32> {
        self.trigger.map(|(_, tick)| tick)
    }

    /// Number of the first sample's tick, as in [`Outputs::tick`](crate::axis::Outputs::tick).
    #[must_use]
    pub fn first_tick(&self) -> u32 {
        let mut missed = self.interruptions.after(self.first);
        let missed = missed.find(|entry| matches!(entry.what, Interruption::Missed { .. }));
        // The last sample of those that follow evenly, and its tick.
        let (last, tick) = match missed {
            Some(entry) => (
                entry.sample.wrapping_sub(self.first) as u32,
                entry.tick_before,
            ),
            None => (self.length, self.newest_tick),
        };
        let steps = last.saturating_sub(1);
        tick.wrapping_sub(steps.wrapping_mul(u32::from(self.setup.every)))
    }

    /// A sample: a word of each signal, in their order.
    #[must_use]
    pub fn sample(&self, index: u32) -> Option<&'s [i32]> {
        if index >= self.length {
            return None;
        }
        let samples = self.setup.samples;
        let place = self.start.wrapping_add(index);
        let place = place.checked_sub(samples).unwrap_or(place);
        let width = self.setup.signals.len();
        let begin = (place as usize).wrapping_mul(width);
        self.words.get(begin..begin.wrapping_add(width))
    }

    /// All samples.
    pub fn samples(&self) -> impl Iterator<Item = &'s [i32]> {
        let recording = *self;
        (0..self.length).filter_map(move |index| recording.sample(index))
    }

    /// The whole value of each signal in the first sample, 0 behind the last signal.
    #[must_use]
    pub fn bases(&self) -> [i64; MOST_SIGNALS] {
        let mut bases = [0; MOST_SIGNALS];
        let signals = self.setup.signals.as_slice().iter();
        for (index, (base, signal)) in bases.iter_mut().zip(signals).enumerate() {
            let word = self.word(0, index);
            *base = match signal.kind() {
                Kind::Narrow => i64::from(word),
                Kind::Word => i64::from(word.cast_unsigned()),
                Kind::Wide => self.wide_base(index),
            };
        }
        bases
    }

    fn word(&self, sample: u32, signal: usize) -> i32 {
        let words = self.sample(sample).unwrap_or_default();
        words.get(signal).copied().unwrap_or(0)
    }

    /// Back from the newest value, sample by sample.
    fn wide_base(&self, index: usize) -> i64 {
        let mut value = self.wide.newest(index);
        for sample in (1..self.length).rev() {
            let jump = self
                .interruptions()
                .find_map(|interrupted| match interrupted.what {
                    Interruption::Jump { signal, from, .. }
                        if usize::from(signal) == index && interrupted.sample == sample =>
                    {
                        Some(from)
                    }
                    _ => None,
                });
            let before = self.word(sample.wrapping_sub(1), index);
            value = jump.unwrap_or_else(|| nearest(value, before));
        }
        value
    }

    /// Where the samples do not follow one another evenly, in their order.
    pub fn interruptions(&self) -> impl Iterator<Item = Interrupted> + use<'s> {
        let first = self.first;
        self.interruptions
            .after(first)
            .map(move |entry| Interrupted {
                sample: entry.sample.wrapping_sub(first) as u32,
                what: entry.what,
            })
    }

    /// True if there were more interruptions than are kept: times, and wide values as wholes, are then not to be trusted.
    #[must_use]
    pub fn is_torn(&self) -> bool {
        self.interruptions.are_dropped_after(self.first)
    }
}
