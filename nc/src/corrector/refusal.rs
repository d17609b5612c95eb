//! Why a block is not corrected: where, what was found, what to do.

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
    /// The arc would begin apart from its circle.
    ArcStart {
        /// By how much, mm.
        by_mm: f64,
    },
    /// The centre that the control works out of R and the ends would be elsewhere, however R is rounded.
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

impl Reason {
    /// What to do; none where the reason says it.
    #[must_use]
    pub fn advice(&self) -> Option<String> {
        Some(match self {
            Self::Text(_) => "mend the block, or choose the dialect it is written in".into(),
            Self::TooLong => "it is no NC program, or of another line end".into(),
            Self::Letter(_) | Self::Code(_) => {
                "check it, or state its meaning in a dialect file of your own".into()
            }
            Self::Expression(_) => {
                "write the number, or leave the axis out of the correction".into()
            }
            Self::Flow | Self::NotFollowed { .. } => "write out what it does block by block".into(),
            Self::Parameter(_) => "set offsets by G10 or in the setup".into(),
            Self::Delete => "give control.block_delete = true or false in the setup".into(),
            Self::NoMotion => "put G0, G1 or another movement before it".into(),
            Self::Overflow { .. } => "move the work, or check the correction's size".into(),
            Self::Place { axis, lost } => lost.advice(*axis),
            Self::Offset { axis, missing } => missing.advice(*axis),
            Self::Radius { tool: Some(tool) } => {
                format!("give control.tools.{tool}.radius_mm in the setup")
            }
            Self::Radius { tool: None } => {
                "give the tool in use and its radius_mm in the setup".into()
            }
            Self::RadiusTooLarge { .. } => {
                "raise the tolerance, or program the centre's path".into()
            }
            Self::NotSplit { within, .. } => within.advice().into(),
            Self::ArcStart { .. } => "lead in with a straight movement".into(),
            Self::RadiusForm { .. } => "write the arc with I, J and K instead of R".into(),
            Self::Sweep { .. } => "write a short arc as a line, a full circle as two arcs".into(),
            Self::Changes { .. } => "write it as single movements, or raise the tolerance".into(),
            _ => return None,
        })
    }
}

impl Lost {
    fn advice(self, axis: Axis) -> String {
        match self {
            Self::Start => {
                format!("give control.start.{axis} in the setup, or place the axis first")
            }
            Self::Reference(code) => {
                format!(
                    "give control.references.{}.{axis} in the setup, or place the axis first",
                    name('G', code)
                )
            }
            Self::Probe | Self::Expression | Self::ToolOffset | Self::Offset => {
                format!("place {axis} by an absolute word before")
            }
        }
    }
}

impl Missing {
    fn advice(self, axis: Axis) -> String {
        match self {
            Self::Work(code) => format!(
                "give control.work_offsets.origins.{}.{axis} in the setup",
                name('G', code)
            ),
            Self::Shift => format!("give control.start.{axis} and the work offset in the setup"),
            Self::Tool(Some(tool)) => format!("give control.tools.{tool}.offset in the setup"),
            Self::Tool(None) => {
                "give the tool's number by H or T, or control.tool_offset in the setup".into()
            }
        }
    }
}

impl Within {
    const fn advice(self) -> &'static str {
        match self {
            Self::Compensation => {
                "raise the tolerance, shorten the movement in the program, or compensate there"
            }
            Self::Thread => "raise the tolerance or shorten the thread",
            Self::Profile => "raise the tolerance or shorten the movements of the profile",
            Self::InverseTime => "program the feed by G94, or shorten the movement",
            Self::AfterMotion => "put what acts after the movement into a block of its own",
            Self::BeforeMotion => {
                "put the codes that say how words count into a block of their own"
            }
        }
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

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(flaw) => flaw.fmt(f),
            Self::TooLong => f.write_str("the block is longer than 65 535 bytes"),
            Self::Letter(letter) => write!(f, "the letter {letter} has no meaning in this dialect"),
            Self::Code(code) => write!(f, "{code} has no meaning in this dialect"),
            Self::NotFollowed { code, why } => write!(f, "{code} is refused: {why}"),
            Self::NoValue(letter) => write!(f, "{letter} has no value"),
            Self::Twice(letter) => write!(f, "{letter} is there twice"),
            Self::TwoCodes(one, other) => write!(f, "{one} and {other} cannot stand in one block"),
            Self::Expression(letter) => {
                write!(
                    f,
                    "the value of {letter} is only known to the control, and the correction needs it"
                )
            }
            Self::Flow => f.write_str(
                "an O word steers the program: which block comes next is only known to the control",
            ),
            Self::Parameter(text) => write!(f, "`{text}` may set an offset of the control"),
            Self::Delete => {
                f.write_str("the block is left out or not as a switch of the control stands")
            }
            Self::NoMotion => f.write_str("there are words of axes and no code says how they move"),
            Self::Unexpected { letter, with } => write!(f, "{letter} has no meaning with {with}"),
            Self::MissingWord { letter, of } => write!(f, "{of} needs {letter}"),
            Self::Width {
                letter,
                found,
                digits,
                signed,
            } => {
                let sign = if *signed { "a sign and " } else { "" };
                write!(
                    f,
                    "{letter} has {found} digits, {sign}{digits} are expected"
                )
            }
            Self::Overflow {
                letter,
                steps,
                digits,
            } => {
                write!(
                    f,
                    "the corrected value of {letter}, {steps}, does not fit into {digits} digits"
                )
            }
            Self::Place { axis, .. } => write!(f, "the place of {axis} is not known"),
            Self::Offset {
                axis,
                missing: Missing::Work(code),
            } => {
                write!(
                    f,
                    "the origin of {} in {axis} is not known",
                    name('G', *code)
                )
            }
            Self::Offset {
                axis,
                missing: Missing::Shift,
            } => write!(
                f,
                "the coordinates of {axis} were set where its place was not known"
            ),
            Self::Offset {
                axis,
                missing: Missing::Tool(_),
            } => write!(f, "the tool's offset in {axis} is not known"),
            Self::Radius { .. } => f.write_str("the tool's radius is not known"),
            Self::RadiusTooLarge {
                radius_mm,
                error_mm,
            } => write!(
                f,
                "with a radius of {radius_mm} mm the correction is uncertain by {error_mm:.4} mm, more than the tolerance"
            ),
            Self::NotSplit { pieces, within } => write!(
                f,
                "the movement would have to be split into {pieces}, which must not be {}",
                match within {
                    Within::Compensation => "between G41 or G42 and G40",
                    Within::Thread => "in a thread",
                    Within::Profile => "in the profile of a cycle",
                    Within::InverseTime => "where F is an inverse time",
                    Within::AfterMotion => "with words that act after the movement",
                    Within::BeforeMotion => "with codes that change how its words count",
                }
            ),
            Self::Path(error) => error.fmt(f),
            Self::ArcStart { by_mm } => {
                write!(f, "the arc would begin {by_mm:.4} mm beside its circle")
            }
            Self::RadiusForm { off_mm } => {
                write!(
                    f,
                    "with R in whole steps the centre of the corrected arc would be {off_mm:.4} mm off"
                )
            }
            Self::Sweep {
                meant_deg,
                found_deg,
            } => write!(
                f,
                "with its ends in whole steps the arc of {meant_deg:.4} degrees turns through {found_deg:.0} degrees for the control"
            ),
            Self::Changes { what, share } => {
                write!(
                    f,
                    "the correction changes along the {what} by {share:.1} times the tolerance"
                )
            }
            Self::Number { letter, expected } => write!(f, "{letter} is not {expected}"),
            Self::Unsupported(what) => f.write_str(what),
        }
    }
}
