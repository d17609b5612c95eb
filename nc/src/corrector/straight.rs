//! Straight movements: positioning, lines, threads, probing, splines.

use super::instruction::Found;
use super::known::Known;
use super::places::Goals;
use super::refusal::{Lost, Reason, Within};
use super::{Task, arcs};
use crate::coordinates::{AXES, Axis, AxisSet, Coordinates};
use crate::dialect::Meaning;
use crate::path::line;
use crate::terms::{Circumstances, Shape};

/// Part of a movement that is written as a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg {
    /// Where it ends, as programmed; the axes' own origin where no term depends on them.
    pub to: Coordinates,
    /// K there.
    pub k: Coordinates,
    /// Its circle, where it is one.
    pub circle: Option<arcs::Circle>,
}

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

    /// A movement over several blocks: the block itself, with the first place of its own kind, and others beside it.
    pub fn lead(
        &mut self,
        goals: &Goals,
        from: &Coordinates,
        legs: &[Leg],
        with: &Circumstances,
    ) -> Result<(), Found> {
        let Some(end) = legs.last().map(|leg| leg.to) else {
            return Ok(());
        };
        let is_arc = legs.iter().any(|leg| leg.circle.is_some());
        let host = legs
            .iter()
            .position(|leg| leg.circle.is_some() == is_arc)
            .unwrap_or(0);
        // In the block itself the movement's code may be in force from before.
        let mut in_force = None;
        let mut from = *from;
        for (index, leg) in legs.iter().enumerate() {
            let goals = part_of(goals, &end, &from, &leg.to);
            let arc = leg.circle.is_some();
            if index == host {
                if !self.before.is_empty() {
                    self.check_before(legs.len())?;
                    self.name_motion()?;
                }
                self.say_leg(&goals, leg)?;
                in_force = Some(arc);
            } else {
                let code = if in_force == Some(arc) {
                    None
                } else {
                    self.code_for(arc, index < host)
                };
                if self.beside(&goals, leg, code, index < host)? {
                    in_force = Some(arc);
                }
            }
            from = leg.to;
        }
        // What follows relies on the movement's own code.
        if in_force != Some(is_arc) {
            return Err((
                self.at(),
                Reason::Unsupported("an arc ends in a line that takes up a reversal"),
            ));
        }
        self.now.approach = with.approach;
        Ok(())
    }

    /// A block before this one is read in the modes and with the offsets of before.
    fn check_before(&self, pieces: usize) -> Result<(), Found> {
        let within = self.counts_anew.then_some(Within::BeforeMotion);
        self.check_pieces(pieces, within)
    }

    fn say_leg(&mut self, goals: &Goals, leg: &Leg) -> Result<(), Found> {
        match &leg.circle {
            None => self.say(goals, &leg.k, self.named()),
            Some(circle) => {
                let plane = self.now.modes.plane.axes();
                let moves = plane.iter().any(|axis| goals[axis.index()].way != 0.0);
                let plane = if moves {
                    plane.into_iter().collect()
                } else {
                    AxisSet::NONE
                };
                let force = self.named().union(plane);
                self.say_circle(goals, &leg.k, circle, force)
            }
        }
    }

    /// A block beside the one of the program; false where no word of it would be another.
    fn beside(
        &mut self,
        goals: &Goals,
        leg: &Leg,
        code: Option<u16>,
        before: bool,
    ) -> Result<bool, Found> {
        let mut text = std::mem::take(if before {
            &mut *self.before
        } else {
            &mut *self.after
        });
        let start = text.len();
        self.begin_block(code, &mut text);
        let begun = text.len();
        let plane: AxisSet = self.now.modes.plane.axes().into_iter().collect();
        let force = if leg.circle.is_some() {
            self.named().union(plane)
        } else {
            self.named()
        };
        let started = self.applied();
        for (axis, goal) in Axis::ALL.into_iter().zip(goals) {
            let stays = self.scale(axis).says(
                goal.way + leg.k[axis] - self.now.axes[axis.index()].applied,
                0.0,
            );
            if stays && !(leg.circle.is_some() && plane.contains(axis)) {
                // It stands while its goal goes on by less than a step.
                self.now.axes[axis.index()].applied -= goal.way;
                continue;
            }
            if let Some(wanted) = self.wanted(axis, goal, leg.k[axis], force.contains(axis))? {
                let style = wanted.word.and_then(|word| self.block.words[word].number());
                let style = style.unwrap_or_else(|| self.style_of(wanted.letter, &wanted.scale));
                let written =
                    self.add_word(wanted.letter, wanted.value, &wanted.scale, style, &mut text)?;
                self.now.axes[axis.index()].applied = written - wanted.base;
            }
        }
        if let Some(circle) = &leg.circle {
            self.add_circle(goals, &started, circle, &mut text)?;
        }
        let is_needed = text.len() > begun;
        if !is_needed {
            text.truncate(start);
        } else {
            if before {
                self.copy_feed(&mut text);
            }
            text.extend_from_slice(self.now.line_end);
        }
        *(if before {
            &mut *self.before
        } else {
            &mut *self.after
        }) = text;
        self.arrive(goals);
        Ok(is_needed)
    }

    /// A line before the block may need the feed that the block brings.
    fn copy_feed(&self, text: &mut Vec<u8>) {
        if let Some(feed) = self.block.word(b'F') {
            if self.is_spaced() {
                text.push(b' ');
            }
            text.extend_from_slice(&self.bytes[feed.span()]);
        }
    }

    fn code_for(&self, arc: bool, before: bool) -> Option<u16> {
        if arc {
            let clockwise = matches!(
                self.now.modes.motion,
                super::Motion::Arc { clockwise: true }
            );
            let meaning = if clockwise {
                Meaning::ArcClockwise
            } else {
                Meaning::ArcCounterclockwise
            };
            return self.known.dialect.code_of(meaning);
        }
        // Behind a line of the program its code is in force.
        let own = matches!(
            self.now.modes.motion,
            super::Motion::Line | super::Motion::Thread
        ) && !before;
        if own {
            None
        } else {
            self.known.dialect.code_of(Meaning::Line)
        }
    }

    /// The block names its movement, because one before it is of another kind.
    fn name_motion(&mut self) -> Result<(), Found> {
        if self.said.motion.is_some() {
            return Ok(());
        }
        let Some(code) = self.code_for(true, true) else {
            return Ok(());
        };
        let at = self.at();
        let name = super::refusal::name('G', code);
        let spaced = self.is_spaced();
        self.edits.put(at..at, |text| {
            text.extend_from_slice(name.as_bytes());
            if spaced {
                text.push(b' ');
            }
            Ok(())
        })
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
            return Err((self.at(), Reason::ArcStart { by_mm: away }));
        }
        self.single(&goals)
    }
}

/// The goals of a leg: `end` is where the whole goes, `from` where the leg begins.
fn part_of(goals: &Goals, end: &Coordinates, from: &Coordinates, to: &Coordinates) -> Goals {
    let mut part = *goals;
    for (axis, goal) in Axis::ALL.into_iter().zip(&mut part) {
        let rest = to[axis] - end[axis];
        goal.program = goal.program.map(|place| place + rest);
        goal.machine = goal.machine.map(|place| place + rest);
        goal.way = to[axis] - from[axis];
    }
    part
}
