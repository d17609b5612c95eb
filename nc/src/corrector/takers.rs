//! Codes that take the words of the axes without moving to them: dwells, origins, references, G10, profiles.

use super::instruction::{Found, Said, count, parameter};
use super::refusal::{Lost, Reason};
use super::state::{AxisState, Offset, Part, axis};
use super::{Profile, Task};
use crate::coordinates::AXES;
use crate::dialect::Meaning;

impl Task<'_> {
    /// What takes the words of the axes.
    pub fn take(&mut self, meaning: Meaning, word: usize) -> Result<(), Found> {
        match meaning {
            Meaning::Dwell => self.dwell(word),
            Meaning::Shift => self.for_axes(|state, place| state.set_here(Offset::Shift, place)),
            Meaning::ShiftOff => {
                for state in &mut self.now.axes {
                    state.set(Offset::Shift, Part::ZERO);
                }
                Ok(())
            }
            Meaning::Local => {
                let shift = self.known.dialect.local_is_shift();
                let which = if shift { Offset::Shift } else { Offset::Local };
                self.for_axes(|state, place| state.set(which, Part::of(Some(place))))
            }
            Meaning::SetData => self.set_data(word),
            Meaning::Reference => self.reference(word),
            Meaning::SetReference => self.set_reference(word),
            Meaning::ToolOffsetGiven => self.tool_offset_given(),
            Meaning::Profile => self.profile(),
            _ => Ok(()),
        }
    }

    /// With what each word of an axis says. None is left in the dark where it matters.
    fn for_axes(&mut self, mut act: impl FnMut(&mut AxisState, f64)) -> Result<(), Found> {
        for index in 0..AXES {
            if let Some(said) = self.axis_value(index)? {
                act(&mut self.now.axes[index], said);
            }
        }
        Ok(())
    }

    pub fn axis_value(&self, index: usize) -> Result<Option<f64>, Found> {
        let Some(word) = self.said.axes[index] else {
            return Ok(None);
        };
        let shown = char::from(self.block.words[word.word].letter);
        if word.way {
            let with = "an origin";
            return Err((
                self.start_of(word.word),
                Reason::Unexpected {
                    letter: shown,
                    with,
                },
            ));
        }
        match word.number {
            Some(number) => Ok(Some(self.scale(axis(index)).read(number))),
            None => Err((self.start_of(word.word), Reason::Expression(shown))),
        }
    }

    /// X and U may be the time of a dwell, in a block that does nothing else with them.
    fn dwell(&mut self, word: usize) -> Result<(), Found> {
        if self.said.has_axes() && parameter(self.block, b'P') != Said::Nothing {
            let reason =
                Reason::Unsupported("a dwell of P stands in a block without words of axes");
            return Err((self.start_of(word), reason));
        }
        Ok(())
    }

    fn set_data(&mut self, word: usize) -> Result<(), Found> {
        let at = self.start_of(word);
        let l = count(self.block, b'L').filter(|l| self.known.dialect.sets_data(*l));
        let Some(l) = l else {
            let expected = "one that is known for G10 in this dialect";
            return Err((
                at,
                Reason::Number {
                    letter: 'L',
                    expected,
                },
            ));
        };
        let p = count(self.block, b'P');
        if l == 1 {
            return self.set_tool(p.ok_or((
                at,
                Reason::MissingWord {
                    letter: 'P',
                    of: "G10 L1",
                },
            ))?);
        }
        if self.now.modes.incremental && !self.known.dialect.local_is_shift() {
            let what = "G10 changes offsets by ways while G91 is in force: write it under G90";
            return Err((at, Reason::Unsupported(what)));
        }
        if !matches!(parameter(self.block, b'R'), Said::Nothing) {
            return Err((
                at,
                Reason::Unsupported(
                    "G10 L2 R turns the coordinates: turned coordinates are not followed",
                ),
            ));
        }
        let offsets = self.known.dialect.work_offsets();
        let code = match p {
            Some(0) if self.known.dialect.local_is_shift() => Some(self.now.modes.work),
            Some(p) => p
                .checked_sub(1)
                .and_then(|index| offsets.get(index as usize))
                .copied(),
            None => None,
        };
        let Some(code) = code else {
            return Err((
                at,
                Reason::Number {
                    letter: 'P',
                    expected: "the number of a work offset",
                },
            ));
        };
        for index in 0..AXES {
            let Some(said) = self.axis_value(index)? else {
                continue;
            };
            let here = l == 20;
            let part = if here {
                self.now.axes[index].part_here(Offset::Work, said)
            } else {
                Part::of(Some(said))
            };
            self.known.set_origin(code, axis(index), part, here);
            if code == self.now.modes.work {
                let part = self.known.work_part(code, axis(index));
                self.now.axes[index].set(Offset::Work, part);
            }
        }
        Ok(())
    }

    /// On the way to the reference the place given is passed uncorrected: it is no target of the work.
    fn reference(&mut self, word: usize) -> Result<(), Found> {
        let number = self.block.words[word].number();
        let code = number
            .and_then(|number| u16::try_from(number.tenths()?).ok())
            .unwrap_or(280);
        let all = !self.said.has_axes();
        for index in 0..AXES {
            let goes = self.said.axes[index].is_some() || all;
            if goes && self.known.dialect.axes().contains(axis(index)) {
                let place = self
                    .known
                    .references
                    .get(&code)
                    .and_then(|places| places.get(&axis(index)));
                self.now.axes[index].at_machine(place.copied(), Lost::Reference(code));
            }
        }
        Ok(())
    }

    fn set_reference(&mut self, word: usize) -> Result<(), Found> {
        let number = self.block.words[word].number();
        let tenths = number
            .and_then(|number| u16::try_from(number.tenths()?).ok())
            .unwrap_or(281);
        let stands = self
            .now
            .axes
            .iter()
            .enumerate()
            .filter_map(|(index, state)| Some((axis(index), state.machine? + state.applied)));
        self.known
            .references
            .insert(tenths - tenths % 10, stands.collect());
        Ok(())
    }

    /// Blocks P to Q are a profile that follows.
    fn profile(&mut self) -> Result<(), Found> {
        if let (Some(_), Some(last)) = (count(self.block, b'P'), count(self.block, b'Q')) {
            self.now.profile = Some(Box::new(Profile {
                last,
                axes: self.now.axes,
                approach: self.now.approach,
            }));
        }
        Ok(())
    }
}
