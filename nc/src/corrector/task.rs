//! One block at work: what comes into force, then what takes its axes or moves them.

use super::Now;
use super::instruction::{self, Found, Instruction};
use super::known::Known;
use super::refusal::{Reason, Within};
use super::state::Motion;
use super::write::Edits;
use crate::block::Block;

/// One block at work.
pub(super) struct Task<'a> {
    pub known: &'a mut Known,
    pub now: &'a mut Now,
    pub bytes: &'a [u8],
    pub block: &'a Block,
    pub said: &'a Instruction,
    pub edits: &'a mut Edits,
    /// Blocks before it.
    pub before: &'a mut Vec<u8>,
    /// Blocks behind it.
    pub after: &'a mut Vec<u8>,
    /// Words count otherwise than before the block.
    pub counts_anew: bool,
}

impl Task<'_> {
    pub fn run(&mut self) -> Result<(), Found> {
        self.note_blanks();
        self.check_assignments()?;
        let modes = self.now.modes;
        let compensated = modes.compensation;
        self.settle()?;
        self.counts_anew |= !self.now.modes.count_as(&modes);
        let compensated = compensated || self.now.modes.compensation;
        if let Some((meaning, word)) = self.said.taker {
            self.take(meaning, word)?;
        } else if self.moves() {
            self.movement(compensated)?;
        } else if let Some(word) = self.said.machine_coordinates {
            return Err((
                self.start_of(word),
                Reason::MissingWord {
                    letter: 'X',
                    of: "G53",
                },
            ));
        }
        self.leave_profile();
        self.now.ended |= self.said.ends;
        Ok(())
    }

    fn moves(&self) -> bool {
        let arc = matches!(self.now.modes.motion, Motion::Arc { .. });
        self.said.has_axes() || (arc && self.said.centre.iter().any(Option::is_some))
    }

    fn movement(&mut self, compensated: bool) -> Result<(), Found> {
        let motion = self.now.modes.motion;
        self.check_words(motion)?;
        if compensated {
            self.check_radius()?;
        }
        let within = if compensated {
            Some(Within::Compensation)
        } else if self.now.profile.is_some() {
            Some(Within::Profile)
        } else if self.now.modes.inverse_time {
            Some(Within::InverseTime)
        } else if self.said.after_motion.is_some() {
            Some(Within::AfterMotion)
        } else {
            None
        };
        match motion {
            Motion::None => Err((self.at(), Reason::NoMotion)),
            Motion::Rapid => self.rapid(),
            Motion::Line => self.line(within),
            Motion::Thread => self.line(Some(Within::Thread)),
            Motion::Spline => self.spline(),
            Motion::Probe => self.probe(),
            Motion::Arc { clockwise } => self.arc(clockwise, within),
            Motion::Cycle(number) => self.cycle(number),
        }
    }

    /// I, J, K and R only where they mean something known.
    fn check_words(&self, motion: Motion) -> Result<(), Found> {
        let with = motion.name();
        let plain = matches!(
            motion,
            Motion::Rapid | Motion::Line | Motion::Probe | Motion::None
        );
        let unexpected = |word: usize| {
            let letter = char::from(self.block.words[word].letter);
            Err((self.start_of(word), Reason::Unexpected { letter, with }))
        };
        if plain && let Some(word) = self.said.centre.iter().flatten().next() {
            return unexpected(*word);
        }
        // R of a straight movement rounds a corner on some controls.
        let radius = self.block.words.iter().position(|word| word.letter == b'R');
        if plain && let Some(word) = radius {
            return unexpected(word);
        }
        Ok(())
    }

    fn leave_profile(&mut self) {
        let Some(profile) = &self.now.profile else {
            return;
        };
        if instruction::count(self.block, b'N') == Some(profile.last) {
            self.now.axes = profile.axes;
            self.now.approach = profile.approach;
            self.now.profile = None;
        }
    }

    /// First byte of a word.
    pub fn start_of(&self, word: usize) -> usize {
        self.block.words[word].span().start
    }

    /// Where a message about the movement points: to its first place, or to the block.
    pub fn at(&self) -> usize {
        self.said
            .first_place()
            .map_or(0, |word| self.start_of(word))
    }
}
