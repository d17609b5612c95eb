//! The words of a block, by what they are for.

use super::refusal::Reason;
use super::state::Motion;
use crate::block::{Block, Number, Value, Word};
use crate::coordinates::{AXES, Axis};
use crate::dialect::{Code, Dialect, Letter, Meaning};

/// What was found, and the byte of the block where.
pub(super) type Found = (usize, Reason);

/// A word of an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct AxisWord {
    /// Its number in the block.
    pub word: usize,
    /// It is a way whatever the mode.
    pub way: bool,
    /// What it says; none where only the control knows.
    pub number: Option<Number>,
}

/// Kept from block to block.
#[derive(Debug, Default)]
pub(super) struct Instruction {
    pub axes: [Option<AxisWord>; AXES],
    /// I, J, K by number in the block.
    pub centre: [Option<usize>; 3],
    /// Codes that come into force before anything moves, with their words.
    pub settings: Vec<(Code, usize)>,
    /// The movement the block names.
    pub motion: Option<(Motion, usize)>,
    /// What takes the words of the axes instead of a movement.
    pub taker: Option<(Meaning, usize)>,
    pub machine_coordinates: Option<usize>,
    pub cancel: Option<(Meaning, usize)>,
    pub ends: bool,
    /// The first word that acts after the movement.
    pub after_motion: Option<usize>,
}

impl Instruction {
    /// Sorts the words of a block.
    pub fn sort(&mut self, block: &Block, bytes: &[u8], dialect: &Dialect) -> Result<(), Found> {
        self.axes = [None; AXES];
        self.centre = [None; 3];
        self.settings.clear();
        self.motion = None;
        self.taker = None;
        self.machine_coordinates = None;
        self.cancel = None;
        self.ends = false;
        self.after_motion = None;
        for (index, word) in block.words.iter().enumerate() {
            let found = |reason| (word.span().start, reason);
            let shown = char::from(word.letter);
            let letter = dialect.letter(word.letter);
            if letter == Letter::Unknown {
                return Err(found(Reason::Letter(shown)));
            }
            if word.value == Value::None {
                return Err(found(Reason::NoValue(shown)));
            }
            check_width(word, dialect).map_err(found)?;
            match letter {
                Letter::G | Letter::M => self.code(index, block, bytes, dialect)?,
                Letter::Axis(axis) => self.axis(index, word, axis, false).map_err(found)?,
                Letter::Way(axis) => self.axis(index, word, axis, true).map_err(found)?,
                Letter::Centre(axis) => {
                    if self.centre[axis.index()].replace(index).is_some() {
                        return Err(found(Reason::Twice(shown)));
                    }
                }
                Letter::Label | Letter::Parameter | Letter::Unknown => {}
            }
        }
        Ok(())
    }

    fn axis(&mut self, index: usize, word: &Word, axis: Axis, way: bool) -> Result<(), Reason> {
        let new = AxisWord {
            word: index,
            way,
            number: word.number(),
        };
        match self.axes[axis.index()].replace(new) {
            Some(_) => Err(Reason::Twice(axis.letter())),
            None => Ok(()),
        }
    }

    fn code(
        &mut self,
        index: usize,
        block: &Block,
        bytes: &[u8],
        dialect: &Dialect,
    ) -> Result<(), Found> {
        let word = &block.words[index];
        let at = word.span().start;
        let shown = || String::from_utf8_lossy(&bytes[word.span()]).to_ascii_uppercase();
        let Some(number) = word.number() else {
            return Err((at, Reason::Expression(char::from(word.letter))));
        };
        let code = dialect
            .code(word.letter, number)
            .ok_or_else(|| (at, Reason::Code(shown())))?;
        let two = |other: usize| {
            let other =
                String::from_utf8_lossy(&bytes[block.words[other].span()]).to_ascii_uppercase();
            (at, Reason::TwoCodes(other, shown()))
        };
        let mut motion = |motion| match self.motion.replace((motion, index)) {
            Some((_, other)) => Err(two(other)),
            None => Ok(()),
        };
        match code {
            Code::Refused(why) => {
                let why = dialect.why_refused(why).to_owned();
                return Err((at, Reason::NotFollowed { code: shown(), why }));
            }
            Code::Cycle(cycle) => motion(Motion::Cycle(cycle))?,
            Code::WorkOffset(_) => self.settings.push((code, index)),
            Code::Of(meaning) => match meaning {
                Meaning::Rapid => motion(Motion::Rapid)?,
                Meaning::Line => motion(Motion::Line)?,
                Meaning::ArcClockwise => motion(Motion::Arc { clockwise: true })?,
                Meaning::ArcCounterclockwise => motion(Motion::Arc { clockwise: false })?,
                Meaning::Spline => motion(Motion::Spline)?,
                Meaning::Thread => motion(Motion::Thread)?,
                Meaning::Probe => motion(Motion::Probe)?,
                Meaning::Harmless => {}
                Meaning::AfterMotion => {
                    self.after_motion.get_or_insert(index);
                }
                Meaning::End => {
                    self.after_motion.get_or_insert(index);
                    self.ends = true;
                }
                Meaning::MachineCoordinates => self.machine_coordinates = Some(index),
                Meaning::CancelCycle | Meaning::CancelCycleAndPosition => {
                    self.cancel = Some((meaning, index));
                }
                Meaning::Dwell
                | Meaning::Shift
                | Meaning::ShiftOff
                | Meaning::Local
                | Meaning::SetData
                | Meaning::Reference
                | Meaning::SetReference
                | Meaning::ToolOffsetGiven
                | Meaning::FinishProfile
                | Meaning::Profile => {
                    if let Some((_, other)) = self.taker.replace((meaning, index)) {
                        return Err(two(other));
                    }
                }
                _ => self.settings.push((code, index)),
            },
        }
        Ok(())
    }

    /// True where a word of an axis is there.
    pub fn has_axes(&self) -> bool {
        self.axes.iter().any(Option::is_some)
    }

    /// The first word of an axis or a centre.
    pub fn first_place(&self) -> Option<usize> {
        let axes = self.axes.iter().flatten().map(|word| word.word);
        axes.chain(self.centre.iter().flatten().copied()).min()
    }
}

fn check_width(word: &Word, dialect: &Dialect) -> Result<(), Reason> {
    let Some(field) = dialect.field(word.letter) else {
        return Ok(());
    };
    let Some(number) = word.number() else {
        return Ok(());
    };
    let signed = number.sign() != crate::block::Sign::None;
    if number.integer_digits() != field.digits || number.has_point() || signed != field.signed {
        return Err(Reason::Width {
            letter: char::from(word.letter),
            found: number.integer_digits() + number.decimals(),
            digits: field.digits,
            signed: field.signed,
        });
    }
    Ok(())
}

/// What a parameter of the block says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Said {
    /// The letter is not there.
    Nothing,
    /// A number.
    Number(Number),
    /// Something that only the control knows.
    Unknown,
}

/// The value of a parameter.
pub(super) fn parameter(block: &Block, letter: u8) -> Said {
    match block.word(letter) {
        None => Said::Nothing,
        Some(word) => word.number().map_or(Said::Unknown, Said::Number),
    }
}

/// The value of a parameter as a number of something; none where there is none that is known.
pub(super) fn count(block: &Block, letter: u8) -> Option<u32> {
    match parameter(block, letter) {
        Said::Number(number) => number.whole().and_then(|whole| u32::try_from(whole).ok()),
        Said::Nothing | Said::Unknown => None,
    }
}
