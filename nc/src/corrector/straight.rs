//! Straight movements: positioning, lines, threads, probing, splines; what of them takes several blocks is in `legs`.

use super::Task;
use super::instruction::Found;
use super::known::Known;
use super::legs::Leg;
use super::places::Goals;
use super::refusal::{Lost, Reason, Within};
use crate::coordinates::{AXES, Axis, AxisSet, Coordinates};
use crate::path::line;
use crate::terms::{Circumstances, Shape};

impl Task<'_> {
    pub fn rapid(&mut self) -> Result<(), Found> {
        if self.said.machine_coordinates.is_some() {
            return self.rapid_of_the_machine();
        }
        self.check_machine_coordinates()?;
        let goals = self.goals()?;
        self.single(&goals)
    }

    /// G53 positions the machine, not the work: to its limits, to change tools. It stays as it is.
    fn rapid_of_the_machine(&mut self) -> Result<(), Found> {
        self.check_machine_coordinates()?;
        let goals = self.goals()?;
        self.now.approach = self.circumstances(&goals).approach;
        for (state, goal) in self.now.axes.iter_mut().zip(&goals) {
            if goal.word.is_some() {
                state.at_machine(goal.machine, Lost::Offset);
            }
        }
        Ok(())
    }

    fn check_machine_coordinates(&self) -> Result<(), Found> {
        match self.said.machine_coordinates {
            Some(word) if self.now.modes.incremental => Err((
                self.start_of(word),
                Reason::Unsupported("G53 has no meaning while G91 is in force"),
            )),
            _ => Ok(()),
        }
    }

    pub fn line(&mut self, within: Option<Within>) -> Result<(), Found> {
        self.check_machine_coordinates()?;
        let goals = self.goals()?;
        if self.known.shape < Shape::Curved {
            return self.single(&goals);
        }
        let (from, to) = self.ends(&goals)?;
        let with = self.circumstances(&goals);
        let here = self.correction_here(&from)?;
        let started = self.started_with(&here);
        let at_start = if with == self.standing_circumstances() {
            here
        } else {
            self.correction(&from, &with, self.at())?
        };
        let Known {
            terms, tolerance, ..
        } = &*self.known;
        if line::is_short(&from, &to, &started, &at_start, terms, tolerance) {
            return self.single_to(&goals, &to, with);
        }
        let pieces = line::split(
            &from,
            &to,
            &started,
            &self.known.terms,
            &with,
            &self.known.tolerance,
        );
        let pieces = pieces.map_err(|error| (self.at(), Reason::Path(error)))?;
        self.check_pieces(pieces.len(), within)?;
        if pieces.len() == 1 {
            return self.single(&goals);
        }
        let mut legs = Vec::with_capacity(pieces.len());
        for to in pieces {
            let k = self.correction(&to, &with, self.at())?;
            legs.push(Leg {
                to,
                k,
                circle: None,
            });
        }
        self.lead(&goals, &from, &legs, &with)
    }

    /// Where a movement begins and ends, in machine coordinates where terms depend on them.
    pub fn ends(&self, goals: &Goals) -> Result<(Coordinates, Coordinates), Found> {
        let at = self.at();
        let to = self.place(goals, at)?;
        let mut from = to;
        let direct = self.said.machine_coordinates.is_some();
        for (axis, goal) in Axis::ALL.into_iter().zip(goals) {
            let state = &self.now.axes[axis.index()];
            let known = if direct { state.machine } else { state.program };
            if goal.word.is_some() && !goal.as_way && known.is_none() {
                let lost = state.lost;
                return Err((at, Reason::Place { axis, lost }));
            }
            from[axis] = match (state.machine, goal.machine) {
                (Some(machine), Some(_)) => machine,
                (None, _) if self.known.depends_on.contains(axis) => {
                    return Err((at, self.unknown(axis, &self.standing()[axis.index()])));
                }
                _ => to[axis] - goal.way,
            };
        }
        Ok((from, to))
    }

    pub fn check_pieces(&self, pieces: usize, within: Option<Within>) -> Result<(), Found> {
        match within {
            Some(within) if pieces > 1 => Err((self.at(), Reason::NotSplit { pieces, within })),
            _ => Ok(()),
        }
    }

    /// A movement in one block.
    pub fn single(&mut self, goals: &Goals) -> Result<(), Found> {
        let at = self.at();
        let place = self.place(goals, at)?;
        self.single_to(goals, &place, self.circumstances(goals))
    }

    /// The same with its place and circumstances known.
    fn single_to(
        &mut self,
        goals: &Goals,
        place: &Coordinates,
        with: Circumstances,
    ) -> Result<(), Found> {
        let k = self.correction(place, &with, self.at())?;
        self.say(goals, &k, AxisSet::NONE)?;
        self.now.approach = with.approach;
        self.now.last_k = Some((*place, with, k));
        Ok(())
    }

    /// Writes the goals and K into the block, and is there.
    pub fn say(&mut self, goals: &Goals, k: &Coordinates, force: AxisSet) -> Result<(), Found> {
        for (axis, goal) in Axis::ALL.into_iter().zip(goals) {
            if let Some(wanted) = self.wanted(axis, goal, k[axis], force.contains(axis))? {
                self.write_axis(axis, &wanted)?;
            }
        }
        self.arrive(goals);
        Ok(())
    }

    /// The probe stops where it touches; where it was sent stays as it is.
    pub fn probe(&mut self) -> Result<(), Found> {
        for index in 0..AXES {
            if self.said.axes[index].is_some() {
                self.now.axes[index].at_machine(None, Lost::Probe);
            }
        }
        Ok(())
    }

    /// Inner points of a spline are ways from its ends: it can only be moved as a whole.
    pub fn spline(&mut self) -> Result<(), Found> {
        let goals = self.goals()?;
        let touched = self.known.involved.iter().any(|axis| !axis.is_rotary());
        if touched && self.known.shape > Shape::Constant {
            let what = "a spline under a correction that changes with the place: write it as lines or arcs";
            return Err((self.at(), Reason::Unsupported(what)));
        }
        let place = self.place(&goals, self.at())?;
        let k = self.correction(&place, &self.circumstances(&goals), self.at())?;
        let away = (k - self.applied()).length_mm();
        let by_mm = self
            .known
            .tolerance
            .mm
            .max(2.0 * self.scale(Axis::Y).step());
        if away > by_mm {
            return Err((self.at(), Reason::SplineStart { by_mm: away }));
        }
        self.single(&goals)
    }
}
