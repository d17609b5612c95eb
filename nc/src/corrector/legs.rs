//! Movements over several blocks: the block of the program and others beside it.

use super::instruction::Found;
use super::places::Goals;
use super::refusal::{Reason, Within};
use super::{Task, arcs};
use crate::coordinates::{Axis, AxisSet, Coordinates};
use crate::dialect::Meaning;
use crate::terms::Circumstances;

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
