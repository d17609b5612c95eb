//! What an experiment measured, 4 bytes a record, in memory that the board lends.

use super::experiment::{Experiment, POSITION_FRAC};
use crate::units::Command;

/// One record.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Record {
    /// Travel in the record, d.
    pub travel_d: f64,
    /// Mean command in force, of full command.
    pub command: f64,
}

/// Records of experiments; each is the travel of `decimation` ticks and the mean command under which it was made.
#[derive(Debug)]
pub struct Recorder<'w> {
    /// Travel in 1/16 d in the low half of an entry, mean command in 2⁻¹⁵ in the high one.
    memory: &'w mut [i32],
    length: usize,
    decimation: u32,
    /// Position at the end of the last record, as the records add up to it; none before the first tick.
    reached: Option<i64>,
    /// Ticks and sum of commands of the record under way.
    ticks: u32,
    sum: i64,
    is_full: bool,
}

impl<'w> Recorder<'w> {
    /// An empty recorder.
    #[must_use]
    pub const fn new(memory: &'w mut [i32]) -> Self {
        Self {
            memory,
            length: 0,
            decimation: 1,
            reached: None,
            ticks: 0,
            sum: 0,
            is_full: false,
        }
    }

    /// Forgets all records; further ones take `decimation` ticks each.
    pub fn clear(&mut self, decimation: u32) {
        self.length = 0;
        self.decimation = decimation.max(1);
        self.is_full = false;
        self.pause();
    }

    /// Travel until the next tick that is fed is not recorded.
    pub const fn pause(&mut self) {
        self.reached = None;
        self.ticks = 0;
        self.sum = 0;
    }

    /// Ticks of a record.
    #[must_use]
    pub const fn decimation(&self) -> u32 {
        self.decimation
    }

    /// Records that there is room for.
    #[must_use]
    pub const fn capacity(&self) -> usize {
        self.memory.len()
    }

    /// Number of records.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.length
    }

    /// True without records.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// True if there was no room for a record.
    #[must_use]
    pub const fn is_full(&self) -> bool {
        self.is_full
    }

    /// Takes what a tick of an experiment saw.
    pub fn feed(&mut self, experiment: &Experiment) {
        self.take(experiment.position(), experiment.in_force());
    }

    /// The same by its position (1/16 d) and the command under which the axis moved to it.
    pub fn take(&mut self, position: i64, in_force: Command) {
        let Some(reached) = self.reached else {
            self.reached = Some(position);
            return;
        };
        self.sum = self.sum.wrapping_add(i64::from(in_force.to_bits()));
        self.ticks = self.ticks.wrapping_add(1);
        if self.ticks < self.decimation {
            return;
        }
        let step = 1_i64 << (Command::FRAC_NBITS - 15);
        let unit = step.wrapping_mul(i64::from(self.decimation));
        let mean = self
            .sum
            .wrapping_add(unit >> 1)
            .checked_div_euclid(unit)
            .unwrap_or(0);
        let travel = position.wrapping_sub(reached);
        let travel = travel.clamp(i64::from(i16::MIN), i64::from(i16::MAX));
        self.reached = Some(reached.wrapping_add(travel));
        self.ticks = 0;
        self.sum = 0;
        let mean = mean.clamp(i64::from(i16::MIN), i64::from(i16::MAX)) as i32;
        let entry = (mean << 16) | (travel as i32 & 0xffff);
        match self.memory.get_mut(self.length) {
            Some(place) => {
                *place = entry;
                self.length = self.length.wrapping_add(1);
            }
            None => self.is_full = true,
        }
    }

    /// The same as words: the travel in 1/16 d in the low half, the mean command in 2⁻¹⁵ in the high one.
    #[must_use]
    pub fn words(&self) -> &[i32] {
        self.memory.get(..self.length).unwrap_or_default()
    }

    /// Puts records that were made elsewhere, of `decimation` ticks, in place of its own; those that find no room are left
    /// out, and it is full.
    pub fn load(&mut self, words: &[i32], decimation: u32) {
        self.clear(decimation);
        for (place, word) in self.memory.iter_mut().zip(words) {
            *place = *word;
        }
        self.length = words.len().min(self.memory.len());
        self.is_full = words.len() > self.memory.len();
    }

    /// Gives the memory back.
    #[must_use]
    pub fn into_memory(self) -> &'w mut [i32] {
        self.memory
    }

    /// The records, in order.
    #[must_use]
    pub fn records(&self) -> Records<'_> {
        Records {
            entries: self.memory.get(..self.length).unwrap_or_default(),
        }
    }
}

/// Records to look at.
#[derive(Clone, Copy, Debug)]
pub struct Records<'w> {
    entries: &'w [i32],
}

impl<'w> Records<'w> {
    /// Number of records.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.entries.len()
    }

    /// True without records.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Record number `index`.
    #[must_use]
    pub fn get(&self, index: usize) -> Option<Record> {
        self.entries.get(index).copied().map(Record::unpack)
    }

    /// Command of record number `index`; zero outside.
    #[must_use]
    pub fn command(&self, index: isize) -> f64 {
        let entry = usize::try_from(index).ok().and_then(|i| self.get(i));
        entry.map_or(0.0, |record| record.command)
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = Record> + use<'w> {
        self.entries.iter().copied().map(Record::unpack)
    }
}

impl Record {
    fn unpack(entry: i32) -> Self {
        Self {
            travel_d: libm::ldexp(
                f64::from(entry as i16),
                POSITION_FRAC.cast_signed().wrapping_neg(),
            ),
            command: f64::from(entry >> 16) / 32_768.0,
        }
    }
}
