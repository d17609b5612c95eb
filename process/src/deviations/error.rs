//! Why a deviation or its correction is not known.

use std::fmt;

use leadscrew_nc::coordinates::Axis;

/// A deviation that cannot be told.
#[derive(Clone, Debug, PartialEq)]
pub enum DeviationError {
    /// A coordinate beyond the ends of its unit.
    OutOfRange {
        /// Name of the unit.
        unit: String,
        /// Its axis.
        axis: Axis,
        /// The coordinate, mm or degrees.
        value: f64,
        /// The ends.
        range: (f64, f64),
    },
    /// The axes to correct with do not span independent directions at this place.
    Dependent {
        /// Letters of the axes.
        axes: String,
    },
}

impl fmt::Display for DeviationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange {
                unit,
                axis,
                value,
                range: (low, high),
            } => write!(
                f,
                "{axis} = {value} {unit_of} is beyond the ends of unit \"{unit}\", {low} to {high} {unit_of}: nothing is known there",
                unit_of = axis.unit()
            ),
            Self::Dependent { axes } => write!(
                f,
                "the axes {axes} do not move in independent directions here: set `corrected = false` for one of them"
            ),
        }
    }
}

impl std::error::Error for DeviationError {}
