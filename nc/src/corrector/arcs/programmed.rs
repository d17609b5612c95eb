//! The arc that a block says.

use super::super::Task;
use super::super::instruction::{Found, Said, count, parameter};
use super::super::places::Goals;
use super::super::refusal::Reason;
use super::super::write::Scale;
use crate::coordinates::{Axis, Coordinates};
use crate::path::arc::Arc;

/// What says where the centre is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    Radius(usize),
    Centre,
}

pub(super) const LETTERS: [u8; 3] = *b"IJK";

impl Task<'_> {
    pub(super) fn form(&self) -> Result<Form, Found> {
        let radius = self.block.words.iter().position(|word| word.letter == b'R');
        let centre = self.said.centre.iter().flatten().next();
        match (radius, centre) {
            (Some(word), None) => Ok(Form::Radius(word)),
            (None, Some(_)) => Ok(Form::Centre),
            (Some(word), Some(_)) => Err((
                self.start_of(word),
                Reason::Unexpected {
                    letter: 'R',
                    with: "I, J and K",
                },
            )),
            (None, None) => Err((
                self.at(),
                Reason::MissingWord {
                    letter: 'R',
                    of: "an arc without I, J, K",
                },
            )),
        }
    }

    /// What a word of the block says of the plane, mm.
    pub(super) fn value(&self, word: usize) -> Result<f64, Found> {
        let word = &self.block.words[word];
        match word.number() {
            Some(number) => Ok(self.centre_scale().read(number)),
            None => Err((
                word.span().start,
                Reason::Expression(char::from(word.letter)),
            )),
        }
    }

    pub(super) fn centre_scale(&self) -> Scale {
        Scale::of_centre(&self.known.dialect, &self.now.modes)
    }

    /// The word of the centre along an axis.
    pub(super) fn centre_word(&self, axis: Axis) -> Option<usize> {
        self.said.centre[axis.index()]
    }

    pub(super) fn programmed_arc(
        &self,
        goals: &Goals,
        from: Coordinates,
        to: Coordinates,
        form: Form,
        clockwise: bool,
    ) -> Result<Arc, Found> {
        let plane = self.now.modes.plane;
        let tolerance = self.known.radius_tolerance_mm;
        let turns = match parameter(self.block, b'P') {
            Said::Nothing => 1,
            _ => count(self.block, b'P')
                .filter(|turns| (1..=1000).contains(turns))
                .ok_or_else(|| {
                    (
                        self.at(),
                        Reason::Number {
                            letter: 'P',
                            expected: "a number of turns, 1 to 1000",
                        },
                    )
                })?,
        };
        let arc = match form {
            Form::Radius(word) => Arc::from_radius(
                plane,
                from,
                to,
                self.value(word)?,
                clockwise,
                turns,
                tolerance,
            ),
            Form::Centre => {
                let centre = plane
                    .axes()
                    .map(|axis| self.centre_along(axis, goals, &from, &to));
                let [first, second] = centre;
                Arc::from_centre(
                    plane,
                    from,
                    to,
                    [first?, second?],
                    clockwise,
                    turns,
                    tolerance,
                )
            }
        };
        arc.map_err(|error| (self.at(), Reason::Path(error)))
    }

    /// The programmed centre, in the coordinates of `from` and `to`.
    pub(super) fn centre_along(
        &self,
        axis: Axis,
        goals: &Goals,
        from: &Coordinates,
        to: &Coordinates,
    ) -> Result<f64, Found> {
        let said = self
            .centre_word(axis)
            .map(|word| self.value(word))
            .transpose()?;
        if !self.now.modes.centre_absolute {
            return Ok(from[axis] + said.unwrap_or(0.0));
        }
        let goal = &goals[axis.index()];
        let origin = goal
            .program
            .map(|place| to[axis] - place)
            .ok_or_else(|| (self.at(), self.unknown(axis, goal)))?;
        let said = said.ok_or_else(|| {
            let letter = char::from(LETTERS[axis.index()]);
            (
                self.at(),
                Reason::MissingWord {
                    letter,
                    of: "an arc under G90.1",
                },
            )
        })?;
        Ok(said + origin)
    }
}
