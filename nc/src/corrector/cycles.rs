//! Canned cycles: which of their words are places, what the repeated ones need, where they leave the axes.

use super::Task;
use super::instruction::{Found, Said, parameter};
use super::places::{Goal, Goals};
use super::refusal::Reason;
use super::state::axis;
use crate::coordinates::{AXES, Axis, AxisSet, Coordinates};
use crate::dialect::{Cycle, CycleEnd};
use crate::path::arc::Plane;
use crate::path::{PathError, line};
use crate::terms::{Approach, Shape};

/// A word of a cycle that goes on holding.
#[derive(Clone, Copy, Debug)]
struct Held {
    /// What it says as the program means it, mm or degrees.
    said: f64,
    /// What was written.
    written: f64,
    /// It is a way.
    as_way: bool,
}

/// What a cycle keeps from block to block.
#[derive(Clone, Debug, Default)]
pub(super) struct Sticky {
    held: [Option<Held>; AXES],
    /// R of a drilling cycle.
    retract: Option<f64>,
    /// The cycle is of one block.
    pub once: bool,
}

impl Sticky {
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

impl Task<'_> {
    pub fn cycle(&mut self, number: u8) -> Result<(), Found> {
        let cycle = self.known.dialect.cycle(number);
        if let Some(word) = self.said.machine_coordinates {
            return Err((
                self.start_of(word),
                Reason::Unsupported("G53 has no meaning with a cycle"),
            ));
        }
        for (axis, word) in Axis::ALL.into_iter().zip(&self.said.axes) {
            if let Some(word) = word
                && !cycle.targets.contains(axis)
                && !axis.is_rotary()
            {
                let letter = char::from(self.block.words[word.word].letter);
                return Err((
                    self.start_of(word.word),
                    Reason::Unexpected {
                        letter,
                        with: "the cycle",
                    },
                ));
            }
        }
        let done = match cycle.end {
            CycleEnd::Start => self.returning(&cycle),
            CycleEnd::Retract | CycleEnd::Height => self.drilling(&cycle),
        };
        if self.now.cycle.once {
            self.now.modes.motion = self.now.modes.before_cycle;
        }
        done
    }

    /// What a word of a cycle says now, or said before.
    fn hold(&mut self, axis: Axis, goal: &Goal) -> Option<Held> {
        let held = &mut self.now.cycle.held[axis.index()];
        if goal.word.is_some() {
            let said = if goal.as_way { goal.way } else { goal.program? };
            *held = Some(Held {
                said,
                written: f64::NAN,
                as_way: goal.as_way,
            });
        }
        *held
    }

    /// Writes the word of a cycle's place, or adds it where the one that holds says something else.
    fn write_held(&mut self, axis: Axis, goal: &Goal, value: f64) -> Result<(), Found> {
        let scale = self.scale(axis);
        let written = match goal.word {
            Some(word) => self.rewrite(word, value, &scale)?,
            None => {
                let holds = self.now.cycle.held[axis.index()].map_or(f64::NAN, |held| held.written);
                if scale.says(holds, value) {
                    return Ok(());
                }
                let goal = Goal {
                    program: Some(value),
                    ..*goal
                };
                let wanted = super::words::Wanted {
                    letter: axis.letter() as u8,
                    value,
                    base: value,
                    word: goal.word,
                    exact: false,
                    scale,
                };
                let applied = self.now.axes[axis.index()].applied;
                self.write_axis(axis, &wanted)?;
                let by = self.now.axes[axis.index()].applied;
                self.now.axes[axis.index()].applied = applied;
                value + by
            }
        };
        if let Some(held) = &mut self.now.cycle.held[axis.index()] {
            held.written = written;
        }
        Ok(())
    }

    /// A cycle that ends where it began: a thread, a box, a pecking cycle of a lathe.
    fn returning(&mut self, cycle: &Cycle) -> Result<(), Found> {
        let goals = self.goals()?;
        let mut ends = goals;
        let mut targets = AxisSet::NONE;
        for axis in cycle.targets.iter() {
            let Some(held) = self.hold(axis, &goals[axis.index()]) else {
                continue;
            };
            targets = targets.with(axis);
            self.reach(axis, &held, &mut ends[axis.index()]);
        }
        if targets.is_empty() {
            return Ok(());
        }
        let at = self.at();
        let place = self.place(&ends, at)?;
        let with = self.circumstances(&ends);
        let k = self.correction(&place, &with, at)?;
        self.check_along(&ends, targets, &place, &k)?;
        for axis in targets.iter() {
            let state = &self.now.axes[axis.index()];
            let Some(held) = self.now.cycle.held[axis.index()] else {
                continue;
            };
            let value = if held.as_way {
                held.said + k[axis] - state.applied
            } else {
                held.said + k[axis] - state.bias()
            };
            if held.as_way
                && goals[axis.index()].word.is_none()
                && !self.scale(axis).says(held.written, value)
            {
                let what = "a way of a cycle that holds would have to change: write its word in every block";
                return Err((at, Reason::Unsupported(what)));
            }
            self.write_held(axis, &goals[axis.index()], value)?;
        }
        // It comes back to its start against the way it went.
        let back = Coordinates::new(ends.map(|end| -end.way));
        self.now.approach = with.approach.after(&back);
        Ok(())
    }

    fn reach(&self, axis: Axis, held: &Held, end: &mut Goal) {
        let state = &self.now.axes[axis.index()];
        if held.as_way {
            end.way = held.said;
            end.program = state.program.map(|from| from + held.said);
            end.machine = state.machine.map(|from| from + held.said);
        } else {
            end.way = state.program.map_or(0.0, |from| held.said - from);
            end.program = Some(held.said);
            end.machine = state.offset().map(|offset| held.said + offset);
        }
    }

    /// The cuts of a cycle are led by its end alone: K must not change along them by more than the tolerance.
    fn check_along(
        &self,
        ends: &Goals,
        targets: AxisSet,
        end: &Coordinates,
        k: &Coordinates,
    ) -> Result<(), Found> {
        if self.known.shape <= Shape::Constant {
            return Ok(());
        }
        let at = self.at();
        let applied = self.applied();
        let from = self.place(&self.standing(), at)?;
        for along in targets.iter() {
            let corner = end.with(along, from[along]);
            let by = Coordinates::ZERO.with(along, ends[along.index()].way);
            let with = crate::terms::Circumstances {
                approach: self.now.approach.after(&by),
                ..self.standing_circumstances()
            };
            let at_corner = self.correction(&corner, &with, at)?;
            let mut off = Coordinates::ZERO;
            for axis in self.known.corrects.iter() {
                let stands = if axis != along && targets.contains(axis) {
                    k[axis]
                } else {
                    applied[axis]
                };
                let at_end = if targets.contains(axis) {
                    0.0
                } else {
                    k[axis] - stands
                };
                let here = at_corner[axis] - stands;
                off[axis] = if here.abs() > at_end.abs() {
                    here
                } else {
                    at_end
                };
            }
            let mut share = self.known.tolerance.share(&off);
            let pieces = line::split(
                &corner,
                end,
                &at_corner,
                &self.known.terms,
                &with,
                &self.known.tolerance,
            );
            if pieces
                .map_err(|error: PathError| (at, Reason::Path(error)))?
                .len()
                > 1
            {
                share = share.max(1.1);
            }
            if share > 1.0 {
                return Err((
                    at,
                    Reason::Changes {
                        what: "cut of the cycle",
                        share,
                    },
                ));
            }
        }
        Ok(())
    }

    /// Drilling: over X and Y, down to Z, up again.
    fn drilling(&mut self, cycle: &Cycle) -> Result<(), Found> {
        let at = self.at();
        if self.now.modes.plane != Plane::Xy {
            return Err((
                at,
                Reason::Unsupported("a drilling cycle is known in plane X, Y (G17) alone"),
            ));
        }
        self.check_repeats()?;
        let goals = self.goals()?;
        let z = Axis::Z.index();
        let Some(held) = self.hold(Axis::Z, &goals[z]) else {
            return Err((
                at,
                Reason::MissingWord {
                    letter: 'Z',
                    of: "the cycle",
                },
            ));
        };
        self.hold_retract()?;
        let state = self.now.axes[z];
        // R counts from where the tool stands, Z from R, where words are ways.
        let retract = if self.now.modes.incremental {
            let way = self.now.cycle.retract.unwrap_or(0.0);
            state.program.map(|from| from + way)
        } else {
            self.now.cycle.retract
        };
        let mut bottom = goals;
        if held.as_way {
            let way = self.now.cycle.retract.unwrap_or(0.0) + held.said;
            bottom[z].program = state.program.map(|from| from + way);
            bottom[z].machine = state.machine.map(|from| from + way);
        } else {
            self.reach(Axis::Z, &held, &mut bottom[z]);
        }
        // The tool goes down last.
        bottom[z].way = -1.0;
        let place = self.place(&bottom, at)?;
        let with = self.circumstances(&bottom);
        let k = self.correction(&place, &with, at)?;
        for index in (0..AXES).filter(|index| *index != z) {
            let axis = axis(index);
            if let Some(wanted) = self.wanted(axis, &goals[index], k[axis], false)? {
                self.write_axis(axis, &wanted)?;
            }
        }
        let value = if held.as_way {
            held.said + k[Axis::Z] - state.applied
        } else {
            held.said + k[Axis::Z] - state.bias()
        };
        self.write_held(Axis::Z, &goals[z], value)?;
        let mut over = goals;
        (over[z].program, over[z].machine) = (state.program, state.machine);
        self.arrive(&over);
        self.rise(cycle, retract, with.approach);
        Ok(())
    }

    fn hold_retract(&mut self) -> Result<(), Found> {
        match parameter(self.block, b'R') {
            Said::Nothing => Ok(()),
            Said::Number(number) => {
                self.now.cycle.retract = Some(self.scale(Axis::Z).read(number));
                Ok(())
            }
            Said::Unknown => Err((self.at(), Reason::Expression('R'))),
        }
    }

    /// Repeated ways go on from hole to hole.
    fn check_repeats(&self) -> Result<(), Found> {
        for letter in [b'L', b'K'] {
            let once = match parameter(self.block, letter) {
                Said::Nothing => true,
                Said::Number(number) => number.whole() == Some(1),
                Said::Unknown => false,
            };
            if !once && self.now.modes.incremental {
                let what = "a cycle repeated by ways: write the holes one by one";
                return Err((self.at(), Reason::Unsupported(what)));
            }
        }
        Ok(())
    }

    /// Where a drilling cycle leaves Z: at R, which stays as it is written, or where it began, if that is higher.
    fn rise(&mut self, cycle: &Cycle, retract: Option<f64>, approach: Approach) {
        let up = Coordinates::ZERO.with(Axis::Z, 1.0);
        self.now.approach = approach.after(&up);
        if cycle.end == CycleEnd::Height {
            return;
        }
        let to_retract = self.now.modes.return_to_retract;
        let state = &mut self.now.axes[Axis::Z.index()];
        if self.now.modes.incremental {
            // R is a way from where the control stands: what it has more stays.
            if let (Some(from), Some(to)) = (state.program, retract)
                && (to_retract || from < to)
            {
                state.by(to - from);
            }
            return;
        }
        let (Some(retract), true) = (retract, to_retract || state.program.is_some()) else {
            // It went back to where it was, or to R: unknown either way.
            state.program = None;
            state.machine = None;
            return;
        };
        // What the program means, and what the control does, which stands elsewhere and reads R as it is written.
        let from = state
            .program
            .filter(|_| !to_retract)
            .unwrap_or(f64::NEG_INFINITY);
        let bias = state.bias();
        let stands = (from + state.applied - bias).max(retract);
        let meant = from.max(retract);
        state.at_program(meant);
        state.applied = stands + bias - meant;
    }
}
