//! Writes places into the words of a block, and blocks beside it.

use super::Task;
use super::instruction::Found;
use super::places::Goal;
use super::refusal::Reason;
use super::write::{Scale, default_style, number};
use crate::block::Number;
use crate::coordinates::{Axis, AxisSet};

/// Numbers nearer to each other than this, mm or degrees, are one: sums of them differ in their last bits.
const EXACT: f64 = 1e-9;

/// A word to be written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub letter: u8,
    /// The value it should have, mm or degrees.
    pub value: f64,
    /// That value without K: what is written less this is how far the control stands from where it is meant to be.
    pub base: f64,
    /// The word of the block whose style it has.
    pub word: Option<usize>,
    /// To the last digit: a word that says it to half a step is written anew.
    pub exact: bool,
    pub scale: Scale,
}

impl Task<'_> {
    /// The word that brings an axis to its goal and K; none where none is there and none is needed.
    pub fn wanted(
        &self,
        axis: Axis,
        goal: &Goal,
        k: f64,
        force: bool,
    ) -> Result<Option<Wanted>, Found> {
        let state = &self.now.axes[axis.index()];
        if goal.word.is_none() && !force && state.applied == k {
            return Ok(None);
        }
        let scale = self.scale(axis);
        if goal.word.is_none() && !force {
            // Pieces of a movement may have left a remainder on any axis.
            let stays = scale.says(state.applied, k);
            // A program that has not placed an axis yet has no target there.
            if stays || !state.placed {
                return Ok(None);
            }
        }
        let place = if self.said.machine_coordinates.is_some() {
            goal.machine
        } else {
            goal.program
        };
        let base = if goal.as_way {
            goal.way - state.applied
        } else if let Some(place) = place {
            let bias = if self.said.machine_coordinates.is_some() {
                0.0
            } else {
                state.bias()
            };
            place - bias
        } else {
            return Err((self.at(), self.unknown(axis, goal)));
        };
        let letter = goal
            .word
            .map_or(axis.letter() as u8, |word| self.block.words[word].letter);
        Ok(Some(Wanted {
            letter,
            value: base + k,
            base,
            word: goal.word,
            exact: goal.exact,
            scale,
        }))
    }

    /// Writes a word into the block, if it does not say it already; how far the control stands from the goal then.
    pub fn write_axis(&mut self, axis: Axis, wanted: &Wanted) -> Result<(), Found> {
        let written = match wanted.word {
            Some(word) if wanted.exact => {
                self.rewrite_unless(word, wanted.value, &wanted.scale, |says| {
                    (says - wanted.value).abs() < EXACT
                })?
            }
            Some(word) => self.rewrite(word, wanted.value, &wanted.scale)?,
            None => self.insert(axis, wanted)?,
        };
        self.now.axes[axis.index()].applied = written - wanted.base;
        Ok(())
    }

    /// Gives a word another value, if it does not say it to half a step; what it says then.
    pub fn rewrite(&mut self, index: usize, value: f64, scale: &Scale) -> Result<f64, Found> {
        self.rewrite_unless(index, value, scale, |says| scale.says(says, value))
    }

    fn rewrite_unless(
        &mut self,
        index: usize,
        value: f64,
        scale: &Scale,
        stays: impl FnOnce(f64) -> bool,
    ) -> Result<f64, Found> {
        let word = &self.block.words[index];
        let at = word.span().start;
        let Some(style) = word.number() else {
            return Err((at, Reason::Expression(char::from(word.letter))));
        };
        let says = scale.read(style);
        if stays(says) {
            return Ok(says);
        }
        let found = |reason| (at, reason);
        let (steps, written) = scale.nearest(value, word.letter).map_err(found)?;
        let dialect = &self.known.dialect;
        self.edits
            .put(word.value_span(), |text| {
                number(dialect, scale, style, word.letter, steps, text)
            })
            .map_err(found)?;
        Ok(written)
    }

    fn insert(&mut self, axis: Axis, wanted: &Wanted) -> Result<f64, Found> {
        let style = self.style_of(wanted.letter, &wanted.scale);
        let (at, behind) = self.place_for(axis);
        self.insert_word(
            at,
            behind,
            wanted.letter,
            wanted.value,
            &wanted.scale,
            style,
        )
    }

    /// Puts a word into the block, behind or before what is there.
    pub fn insert_word(
        &mut self,
        at: usize,
        behind: bool,
        letter: u8,
        value: f64,
        scale: &Scale,
        style: Number,
    ) -> Result<f64, Found> {
        let found = |reason| (at.min(self.bytes.len()), reason);
        let (steps, written) = scale.nearest(value, letter).map_err(found)?;
        let (spaced, lower) = (self.is_spaced(), self.is_lower());
        let dialect = &self.known.dialect;
        self.edits
            .put(at..at, |text| {
                if spaced && behind {
                    text.push(b' ');
                }
                text.push(if lower {
                    letter.to_ascii_lowercase()
                } else {
                    letter
                });
                number(dialect, scale, style, letter, steps, text)?;
                if spaced && !behind {
                    text.push(b' ');
                }
                Ok(())
            })
            .map_err(found)?;
        Ok(written)
    }

    /// Where a new word of an axis goes: behind those of the axes before it, else before those behind it, else behind the
    /// movement's code.
    fn place_for(&self, axis: Axis) -> (usize, bool) {
        let words = || {
            self.said
                .axes
                .iter()
                .enumerate()
                .filter_map(|(index, word)| Some((index, (*word)?.word)))
        };
        let end_of = |word: usize| self.block.words[word].span().end;
        if let Some(end) = words()
            .filter(|(index, _)| *index < axis.index())
            .map(|(_, word)| end_of(word))
            .max()
        {
            return (end, true);
        }
        if let Some(start) = words().map(|(_, word)| self.start_of(word)).min() {
            return (start, false);
        }
        if let Some(first) = self.said.centre.iter().flatten().min() {
            return (self.start_of(*first), false);
        }
        (
            self.block.words.last().map_or(0, |word| word.span().end),
            true,
        )
    }

    /// The style of new words of a letter: that of the first word of an axis of the same kind, without its leading zeros.
    pub fn style_of(&self, letter: u8, scale: &Scale) -> Number {
        let default = default_style(&self.known.dialect, letter);
        if self.known.dialect.field(letter).is_some() {
            return default;
        }
        let mut numbers = Axis::ALL
            .into_iter()
            .zip(&self.said.axes)
            .filter(|(axis, _)| axis.is_rotary() == scale.rotary)
            .filter_map(|(_, word)| word.as_ref()?.number);
        numbers.next().map_or(default, |number| {
            Number::style(
                number.sign_shown(),
                1,
                number.decimals(),
                number.has_point(),
            )
        })
    }

    /// How the program separates words; a block of one word does not tell.
    pub fn note_blanks(&mut self) {
        if let [first, second, ..] = self.block.words.as_slice() {
            self.now.spaced = first.span().end < second.span().start;
        }
    }

    pub fn is_spaced(&self) -> bool {
        self.now.spaced
    }

    fn is_lower(&self) -> bool {
        let last = self.block.words.last();
        last.is_some_and(|word| self.bytes[word.span().start].is_ascii_lowercase())
    }

    /// Begins a block beside this one: with its block delete, and what it needs for itself.
    pub fn begin_block(&self, code: Option<u16>, text: &mut Vec<u8>) {
        if let Some(delete) = self.block.delete {
            let until = self.bytes[delete + 1..]
                .iter()
                .take_while(|byte| byte.is_ascii_digit())
                .count();
            text.extend_from_slice(&self.bytes[delete..=delete + until]);
        }
        if self.said.machine_coordinates.is_some() {
            self.put_text("G53", text);
        }
        if let Some(code) = code {
            self.put_text(&super::refusal::name('G', code), text);
        }
    }

    fn put_text(&self, word: &str, text: &mut Vec<u8>) {
        if self.is_spaced()
            && text
                .last()
                .is_some_and(|byte| !matches!(byte, b'\n' | b'\r' | b'/'))
        {
            text.push(b' ');
        }
        let start = text.len();
        text.extend_from_slice(word.as_bytes());
        if self.is_lower() {
            text[start..].make_ascii_lowercase();
        }
    }

    /// Adds a word to a block beside this one; what it says.
    pub fn add_word(
        &self,
        letter: u8,
        value: f64,
        scale: &Scale,
        style: Number,
        text: &mut Vec<u8>,
    ) -> Result<f64, Found> {
        let found = |reason| (self.at(), reason);
        let (steps, written) = scale.nearest(value, letter).map_err(found)?;
        self.put_text(char::from(letter).encode_utf8(&mut [0; 4]), text);
        number(&self.known.dialect, scale, style, letter, steps, text).map_err(found)?;
        Ok(written)
    }

    /// The axes that have a word in the block.
    pub fn named(&self) -> AxisSet {
        let axes = Axis::ALL.into_iter().zip(&self.said.axes);
        axes.filter(|(_, word)| word.is_some())
            .map(|(axis, _)| axis)
            .collect()
    }
}
