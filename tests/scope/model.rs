//! What a scope is to record, from rows of all ticks: without ring, without words, by looking back.

use leadscrew::scope::{
    Interruption, Kind, Recording, Setup, Side, Signal, Slope, State, Trigger, Unwrap,
};

use crate::puppet::Row;

/// A scope's life: what the axis gave in every tick from arming on, and what was told to the scope before a tick.
pub struct Life {
    pub setup: Setup,
    pub rows: Vec<Row>,
    /// What the axis gave in the tick before, if there was one.
    pub prior: Option<Row>,
    /// The tick that `trigger` was called before.
    pub forced: Option<usize>,
    /// Ticks told as missed before a tick.
    pub missed: Vec<u32>,
}

impl Life {
    /// The tick of the trigger.
    pub fn trigger(&self) -> Option<usize> {
        let rows = &self.rows;
        let value = |at: usize, signal: Signal| rows[at].value(signal);
        let before = |at: usize| at.checked_sub(1);
        let sees = |at: usize| match self.setup.trigger {
            Trigger::Now => true,
            Trigger::Force => false,
            Trigger::Level {
                signal,
                level,
                side: Side::Above,
            } => value(at, signal) > level,
            Trigger::Level { signal, level, .. } => value(at, signal) < level,
            Trigger::Edge {
                signal,
                level,
                slope,
            } => before(at).is_some_and(|before| {
                let (from, to) = (value(before, signal), value(at, signal));
                match slope {
                    Slope::Rising => from <= level && to > level,
                    Slope::Falling => from >= level && to < level,
                    Slope::Either => (from <= level && to > level) || (from >= level && to < level),
                }
            }),
            Trigger::Fault(wanted) => {
                let now = rows[at].outputs.fault;
                let row_before = before(at).map(|before| rows[before]).or(self.prior);
                let was = row_before.and_then(|row| row.outputs.fault);
                let is_new = was.is_none() || rows[at].is_cleared;
                now.is_some() && is_new && (wanted.is_none() || wanted == now)
            }
            Trigger::Warning => before(at).is_some_and(|before| {
                let was = rows[before].outputs.warnings.bits();
                rows[at].outputs.warnings.bits() & !was != 0
            }),
            Trigger::Command => before(at)
                .is_some_and(|before| !rows[before].outputs.moving && rows[at].outputs.moving),
        };
        (0..rows.len()).find(|at| sees(*at) || self.forced.is_some_and(|forced| forced <= *at))
    }

    /// Compares a scope that took all rows, and was then stopped, with what it is to be.
    pub fn assert_recorded(&self, state: State, recording: &Recording<'_>) {
        let every = usize::from(self.setup.every);
        let sampled: Vec<usize> = (0..self.rows.len()).step_by(every).collect();
        let (pre, samples) = (self.setup.pre as usize, self.setup.samples as usize);
        let trigger = self.trigger();
        let of_trigger = trigger.map(|tick| tick.div_ceil(every));
        let kept = if let Some(sample) = of_trigger {
            let first = sample.saturating_sub(pre);
            let last = (first + samples).min(sampled.len());
            &sampled[first..last]
        } else {
            &sampled[sampled.len().saturating_sub(samples)..]
        };
        let is_complete = trigger.is_some() && kept.len() == samples;
        let expected = if is_complete {
            State::Complete
        } else {
            State::Stopped
        };
        assert_eq!(state, expected);
        assert_eq!(recording.len() as usize, kept.len());
        let of_trigger = of_trigger.map(|sample| sample.min(pre));
        assert_eq!(recording.trigger_sample().map(|at| at as usize), of_trigger);
        let tick = trigger.map(|tick| self.rows[tick].outputs.tick);
        assert_eq!(recording.trigger_tick(), tick);
        self.assert_samples(kept, recording);
    }

    /// Words as they are, and values made whole.
    fn assert_samples(&self, kept: &[usize], recording: &Recording<'_>) {
        let signals = self.setup.signals.as_slice();
        let bases = recording.bases();
        let mut whole: Vec<Unwrap> = (signals.iter().zip(bases))
            .map(|(signal, base)| Unwrap::new(*signal, base))
            .collect();
        let mut samples = recording.samples();
        for (index, tick) in kept.iter().enumerate() {
            let row = &self.rows[*tick];
            let words = samples.next().unwrap();
            assert_eq!(words.len(), signals.len());
            self.set_jumps(index, recording, &mut whole);
            for (place, signal) in signals.iter().enumerate() {
                let value = row.value(*signal);
                assert_eq!(words[place], value as i32, "{signal}, sample {index}");
                let found = whole[place].take(words[place]);
                if !recording.is_torn() || signal.kind() != Kind::Wide {
                    assert_eq!(found, value, "{signal}, sample {index}, made whole");
                }
            }
        }
        assert!(samples.next().is_none());
        assert_eq!(recording.sample(kept.len() as u32), None);
        if let (Some(first), false) = (kept.first(), recording.is_torn()) {
            assert_eq!(recording.first_tick(), self.rows[*first].outputs.tick);
            self.assert_times(kept, recording);
        }
    }

    fn set_jumps(&self, index: usize, recording: &Recording<'_>, whole: &mut [Unwrap]) {
        for interrupted in recording.interruptions() {
            if let Interruption::Jump { signal, to, .. } = interrupted.what
                && interrupted.sample as usize == index
            {
                whole[usize::from(signal)].set(to);
            }
        }
    }

    /// Ticks missed lie where they were told.
    fn assert_times(&self, kept: &[usize], recording: &Recording<'_>) {
        let missed = |from: usize, to: usize| self.missed[from + 1..=to].iter().sum::<u32>();
        let expected: Vec<_> = (1..kept.len())
            .map(|index| (index as u32, missed(kept[index - 1], kept[index])))
            .filter(|(_, ticks)| *ticks > 0)
            .collect();
        let found: Vec<_> = recording
            .interruptions()
            .filter_map(|interrupted| match interrupted.what {
                Interruption::Missed { ticks } => Some((interrupted.sample, ticks)),
                Interruption::Jump { .. } => None,
            })
            .collect();
        assert_eq!(found, expected);
    }
}
