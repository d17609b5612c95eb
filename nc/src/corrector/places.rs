//! Where a block goes, and K there.

use super::Task;
use super::instruction::Found;
use super::refusal::{Lost, Missing, Reason};
use super::state::{Offset, axis};
use super::write::Scale;
use crate::coordinates::{AXES, Axis, Coordinates};
use crate::path::PathError;
use crate::terms::{Circumstances, Region, Shape};

/// Where an axis goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Goal {
    /// In the coordinates of the program, as it means it.
    pub program: Option<f64>,
    /// In machine coordinates.
    pub machine: Option<f64>,
    /// How far that is from where it was meant to be; 0 where unknown.
    pub way: f64,
    /// Its word in the block.
    pub word: Option<usize>,
    /// The word is a way.
    pub as_way: bool,
    /// Its word says the place to the last digit, not to half a step alone.
    pub exact: bool,
    /// Why its place is unknown, where it is.
    pub lost: Lost,
}

pub(super) type Goals = [Goal; AXES];

impl Task<'_> {
    /// How the words of an axis count now.
    pub fn scale(&self, axis: Axis) -> Scale {
        *self.now.scales.of(axis)
    }

    /// What the words of the axes say.
    pub fn goals(&self) -> Result<Goals, Found> {
        let mut goals = self.standing();
        for (index, word) in self.said.axes.iter().enumerate() {
            let Some(word) = word else { continue };
            let (axis, state, goal) = (axis(index), &self.now.axes[index], &mut goals[index]);
            let Some(number) = word.number else {
                if self.known.involved.contains(axis) {
                    let letter = char::from(self.block.words[word.word].letter);
                    return Err((self.start_of(word.word), Reason::Expression(letter)));
                }
                (goal.program, goal.machine, goal.lost) = (None, None, Lost::Expression);
                continue;
            };
            let said = self.scale(axis).read(number);
            goal.word = Some(word.word);
            goal.as_way = word.way || self.now.modes.incremental;
            if self.said.machine_coordinates.is_some() {
                goal.machine = Some(said);
                goal.program = state.offset().map(|offset| said - offset);
                goal.way = state.machine.map_or(0.0, |from| said - from);
                goal.lost = Lost::Offset;
            } else if goal.as_way {
                goal.way = said;
                goal.program = goal.program.map(|from| from + said);
                goal.machine = goal.machine.map(|from| from + said);
            } else {
                goal.program = Some(said);
                goal.machine = state.offset().map(|offset| said + offset);
                goal.way = state.program.map_or(0.0, |from| said - from);
                goal.lost = Lost::Offset;
            }
        }
        Ok(goals)
    }

    /// All axes where they are.
    pub fn standing(&self) -> Goals {
        self.now.axes.map(|state| Goal {
            program: state.program,
            machine: state.machine,
            way: 0.0,
            word: None,
            as_way: self.now.modes.incremental,
            exact: false,
            lost: state.lost,
        })
    }

    /// The axes are there now, as the program means it.
    pub fn arrive(&mut self, goals: &Goals) {
        for (state, goal) in self.now.axes.iter_mut().zip(goals) {
            state.program = goal.program;
            state.machine = goal.machine;
            state.lost = goal.lost;
            state.placed |= goal.word.is_some() && !goal.as_way;
        }
    }

    /// What K depends on besides the place, after a movement to the goals.
    pub fn circumstances(&self, goals: &Goals) -> Circumstances {
        let by = Coordinates::new(goals.map(|goal| goal.way));
        Circumstances {
            approach: self.now.approach.after(&by),
            ..self.standing_circumstances()
        }
    }

    /// What K depends on besides the place, here.
    pub fn standing_circumstances(&self) -> Circumstances {
        Circumstances {
            tool: self.now.tool,
            tool_offset: self.now.tool_offset,
            approach: self.now.approach,
        }
    }

    /// Machine coordinates of goals; those that no term depends on may be of another origin.
    pub fn place(&self, goals: &Goals, at: usize) -> Result<Coordinates, Found> {
        let mut place = Coordinates::ZERO;
        for (index, goal) in goals.iter().enumerate() {
            let axis = axis(index);
            place[axis] = match goal.machine {
                Some(machine) => machine,
                None if self.known.depends_on.contains(axis) => {
                    return Err((at, self.unknown(axis, goal)));
                }
                None => goal.program.unwrap_or(0.0),
            };
        }
        Ok(place)
    }

    /// K at a place.
    pub fn correction(
        &self,
        place: &Coordinates,
        with: &Circumstances,
        at: usize,
    ) -> Result<Coordinates, Found> {
        let k = self.known.terms.correction(place, with);
        k.map_err(|error| (at, Reason::Path(PathError::Term(error))))
    }

    /// K at a place with what it depends on as it is now.
    pub fn correction_here(&self, place: &Coordinates) -> Result<Coordinates, Found> {
        let with = self.standing_circumstances();
        match &self.now.last_k {
            Some((last, last_with, k)) if last == place && *last_with == with => Ok(*k),
            _ => self.correction(place, &with, self.at()),
        }
    }

    /// What is missing to know a place.
    pub fn unknown(&self, axis: Axis, goal: &Goal) -> Reason {
        if goal.program.is_none() {
            return Reason::Place {
                axis,
                lost: goal.lost,
            };
        }
        let offsets = &self.now.axes[axis.index()].offsets;
        let missing = if offsets[Offset::Work as usize].value.is_none() {
            Missing::Work(self.now.modes.work)
        } else if offsets[Offset::Tool as usize].value.is_none() {
            Missing::Tool(self.now.offset_of.flatten())
        } else {
            Missing::Shift
        };
        Reason::Offset { axis, missing }
    }

    /// What the control has more than the program means, of all axes.
    pub fn applied(&self) -> Coordinates {
        Coordinates::new(self.now.axes.map(|state| state.applied))
    }

    /// With compensation the control point is up to a radius beside the programmed place: K must not change over that.
    pub fn check_radius(&self) -> Result<(), Found> {
        if self.known.shape <= Shape::Constant {
            return Ok(());
        }
        let tool = self.now.radius_of;
        let listed = tool.and_then(|tool| self.known.tools.get(&tool)?.radius_mm);
        let Some(radius_mm) = self.now.radius_mm.or(listed) else {
            return Err((self.at(), Reason::Radius { tool }));
        };
        let place = self.place(&self.goals()?, self.at())?;
        let beside = |sign: f64| {
            let beside = place.iter().map(|(axis, value)| {
                let by = if axis.is_rotary() {
                    0.0
                } else {
                    sign * radius_mm
                };
                (axis, value + by)
            });
            beside.collect::<Coordinates>()
        };
        let around = Region::around(&beside(-1.0), &beside(1.0));
        let error_mm = radius_mm * self.known.terms.steepness(&around).slope;
        if error_mm > self.known.tolerance.mm {
            return Err((
                self.at(),
                Reason::RadiusTooLarge {
                    radius_mm,
                    error_mm,
                },
            ));
        }
        Ok(())
    }
}
