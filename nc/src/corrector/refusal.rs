//! Why a block is not corrected: where, what was found, what to do. Here what there is, in `text` how it reads, in `advice` what to
//! do.

mod advice;
mod text;

use std::fmt;

use crate::block::{Flaw, FlawKind};
use crate::coordinates::Axis;
use crate::path::PathError;

/// A block that is refused. Nothing of it was written; the corrector is of no more use for this program.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// Block, from 1: the line of the file.
    pub block: u64,
    /// Column, from 1, characters (bytes where the block is not UTF-8).
    pub column: usize,
    /// What was found.
    pub reason: Reason,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            block,
            column,
            reason,
        } = self;
        write!(f, "{block}:{column}: {reason}")?;
        match reason.advice() {
            Some(advice) => write!(f, ": {advice}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for Refusal {}

/// Why the place of an axis is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lost {
    /// The program has not said yet where it is.
    Start,
    /// It went to a reference: its code in tenths.
    Reference(u16),
    /// It stopped where a probe touched.
    Probe,
    /// The control was told to work a place out.
    Expression,
    /// A tool offset came into force; where the axes stand depends on the control.
    ToolOffset,
    /// Its offsets were not known.
    Offset,
}

/// An offset that is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// The work offset of a code, in tenths.
    Work(u16),
    /// The offset of G92, G50 or G52, set where the place was unknown.
    Shift,
    /// The offset of a tool; none where even its number is unknown.
    Tool(Option<u32>),
}

/// What was found in a block.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// Not made of words.
    Text(FlawKind),
    /// Longer than a control reads.
    TooLong,
    /// A letter without a meaning in the dialect.
    Letter(char),
    /// A code without a meaning in the dialect.
    Code(String),
    /// A code that is known and not followed.
    NotFollowed {
        /// The code.
        code: String,
        /// Why.
        why: String,
    },
    /// A letter without a value.
    NoValue(char),
    /// A word that is there twice, or two words of one axis.
    Twice(char),
    /// Two codes that both say what the axes' words are for.
    TwoCodes(String, String),
    /// A value only the control can work out, where it has to be known.
    Expression(char),
    /// An O word: which block comes next is only known to the control.
    Flow,
    /// Sets a parameter that offsets or modes hang on, or one not known which.
    Parameter(String),
    /// A block that is run only where a switch says so.
    Delete,
    /// Axes, and no code that says how they move.
    NoMotion,
    /// A word that has no meaning with the movement.
    Unexpected {
        /// Its letter.
        letter: char,
        /// The movement.
        with: &'static str,
    },
    /// A word that is missing.
    MissingWord {
        /// Its letter.
        letter: char,
        /// What for.
        of: &'static str,
    },
    /// Not the width that the dialect states.
    Width {
        /// Letter of the word.
        letter: char,
        /// Digits found.
        found: u8,
        /// Digits expected.
        digits: u8,
        /// A sign is expected.
        signed: bool,
    },
    /// The corrected number does not fit.
    Overflow {
        /// Letter of the word.
        letter: char,
        /// The corrected value, in the word's own steps.
        steps: i64,
        /// Digits there are.
        digits: u8,
    },
    /// The place of an axis is not known.
    Place {
        /// The axis.
        axis: Axis,
        /// Why.
        lost: Lost,
    },
    /// An offset is not known.
    Offset {
        /// The axis.
        axis: Axis,
        /// Which.
        missing: Missing,
    },
    /// The radius of the tool is not known, so with compensation the control point's place is not.
    Radius {
        /// Number that the radius was looked for by.
        tool: Option<u32>,
    },
    /// With compensation the control point is so far from the programmed place that K is not known well enough.
    RadiusTooLarge {
        /// Radius, mm.
        radius_mm: f64,
        /// By how much K may be off, mm.
        error_mm: f64,
    },
    /// The movement would have to be split where it must not be.
    NotSplit {
        /// Pieces needed.
        pieces: usize,
        /// Why it must not be.
        within: Within,
    },
    /// A movement has no corrected path.
    Path(PathError),
    /// A spline, which is only moved as a whole, would begin apart from where it should.
    SplineStart {
        /// By how much, mm.
        by_mm: f64,
    },
    /// With R in whole steps the arc that the control works out of R and its ends would lie elsewhere, however R is rounded.
    RadiusForm {
        /// By how much at least, mm.
        off_mm: f64,
    },
    /// The control would turn through another angle, the ends being in whole steps.
    Sweep {
        /// As the program means it, without whole turns.
        meant_deg: f64,
        /// As the control would.
        found_deg: f64,
    },
    /// A cycle, spline or thread whose correction changes along it.
    Changes {
        /// What it is.
        what: &'static str,
        /// By how much K changes, share of the tolerance.
        share: f64,
    },
    /// A number that nothing is looked up by.
    Number {
        /// Its letter.
        letter: char,
        /// What is expected.
        expected: &'static str,
    },
    /// A feature in a place where it is not followed.
    Unsupported(&'static str),
}

/// Where a movement must not be split.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Within {
    /// Between G41 or G42 and G40.
    Compensation,
    /// A thread.
    Thread,
    /// The profile of a cycle.
    Profile,
    /// F is the inverse of the block's time.
    InverseTime,
    /// The block has words that act when its movement has ended.
    AfterMotion,
    /// A piece before the block would be read in the modes and offsets of before.
    BeforeMotion,
}

impl From<Flaw> for Reason {
    fn from(flaw: Flaw) -> Self {
        Self::Text(flaw.what)
    }
}

/// Name of a code in tenths.
pub(crate) fn name(letter: char, tenths: u16) -> String {
    if tenths.is_multiple_of(10) {
        format!("{letter}{}", tenths / 10)
    } else {
        format!("{letter}{}.{}", tenths / 10, tenths % 10)
    }
}
