//! How a refusal reads.

use std::fmt;

use super::{Missing, Reason, Within, name};

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
            Self::SplineStart { by_mm } => {
                write!(
                    f,
                    "the spline would begin {by_mm:.4} mm beside where it should"
                )
            }
            Self::RadiusForm { off_mm } => {
                write!(
                    f,
                    "with R in whole steps the corrected arc would be {off_mm:.4} mm off its place"
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
