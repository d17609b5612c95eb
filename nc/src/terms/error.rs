//! Why a term has no correction for a place.

use std::fmt;

use crate::coordinates::Axis;

/// A term that cannot say what K is.
#[derive(Clone, Debug, PartialEq)]
pub struct TermError {
    /// Name of the term.
    pub term: String,
    /// What it lacks.
    pub trouble: Trouble,
}

/// What a term lacks.
#[derive(Clone, Debug, PartialEq)]
pub enum Trouble {
    /// The place is outside of the table; there is no extrapolation.
    OutOfRange {
        /// The coordinate that is.
        axis: Axis,
        /// Its value, mm or degrees.
        value: f64,
        /// First and last place of the table.
        range: (f64, f64),
    },
    /// The axis has not moved yet, so it is not known from which side it stands where it stands.
    ApproachUnknown {
        /// The axis.
        axis: Axis,
    },
    /// No tool number is known.
    ToolUnknown,
    /// It is not known which tool offset is in force.
    ToolOffsetUnknown,
    /// The term was made for another tool offset.
    ToolOffset {
        /// Axis of the offset.
        axis: Axis,
        /// In force, mm.
        value: f64,
        /// What the term holds for, mm.
        range: (f64, f64),
    },
}

impl fmt::Display for TermError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { term, trouble } = self;
        match trouble {
            Trouble::OutOfRange { axis, value, range } => {
                let unit = axis.unit();
                write!(
                    f,
                    "{axis} = {value:.4} {unit} (machine) is outside of the table of term \"{term}\", {:.4} to {:.4} {unit}: \
                     extend the table or move the work",
                    range.0, range.1
                )
            }
            Trouble::ApproachUnknown { axis } => write!(
                f,
                "term \"{term}\" needs to know from which side {axis} came, and {axis} has not moved yet: \
                 move {axis} first, or state the start position in the setup"
            ),
            Trouble::ToolUnknown => write!(
                f,
                "term \"{term}\" depends on the tool, and no tool number is known: call the tool in the program, or state \
                 the tool at the start in the setup"
            ),
            Trouble::ToolOffsetUnknown => write!(
                f,
                "term \"{term}\" depends on where the tool's tip is, and the tool offset in force is not known: add the tool \
                 to the tool table of the setup"
            ),
            Trouble::ToolOffset { axis, value, range } => write!(
                f,
                "term \"{term}\" was made for a tool offset of {:.4} to {:.4} mm in {axis}, and {value:.4} mm is in force: \
                 make the table for this tool",
                range.0, range.1
            ),
        }
    }
}

impl std::error::Error for TermError {}
