//! Canned cycles: which of their words are places, what the repeated ones need, where they leave the axes. Here what all have,
//! then those `returning` to their start, and `drilling`.

mod drilling;
mod returning;

use super::Task;
use super::instruction::Found;
use super::places::Goal;
use super::refusal::Reason;
use crate::coordinates::{AXES, Axis};
use crate::dialect::CycleEnd;

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
    /// R of a drilling cycle, and whether it is a way.
    retract: Option<(f64, bool)>,
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

    /// What was said as a place is read as a way by some controls after G91, as a place by others; and the other way round.
    fn check_mode(&self, said_as_way: bool) -> Result<(), Found> {
        if said_as_way == self.now.modes.incremental {
            return Ok(());
        }
        let what =
            "a word of the cycle that holds from before G90 or G91: write it again in this block";
        Err((self.at(), Reason::Unsupported(what)))
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
}
