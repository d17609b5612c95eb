//! Modes, offsets and tools, and what takes the words of the axes without moving to them.

use super::instruction::{Found, Said, count, parameter};
use super::known::{self, mode};
use super::refusal::{Lost, Reason};
use super::state::{AxisState, Motion, Offset, Part, axis};
use super::{Profile, Task};
use crate::coordinates::{AXES, Axis};
use crate::dialect::{Code, Letter, Meaning, ToolSelection};
use crate::machine_state::Tool;

/// Parameters of LinuxCNC below this number hang on nothing.
const FREE_PARAMETERS: u32 = 5000;

impl Task<'_> {
    /// Parameters of the control's own are not set behind the correction's back.
    pub fn check_assignments(&self) -> Result<(), Found> {
        for span in &self.block.assignments {
            let text = &self.bytes[span.clone()];
            let name = text[1..].trim_ascii_start();
            let digits = name.iter().take_while(|byte| byte.is_ascii_digit()).count();
            let number = std::str::from_utf8(&name[..digits])
                .ok()
                .and_then(|digits| digits.parse().ok());
            let free = name.starts_with(b"<")
                || number.is_some_and(|number: u32| number < FREE_PARAMETERS);
            if !free {
                let shown = String::from_utf8_lossy(text).into_owned();
                return Err((span.start, Reason::Parameter(shown)));
            }
        }
        Ok(())
    }

    /// All codes that come into force before anything moves, in the order in which controls take them.
    pub fn settle(&mut self) -> Result<(), Found> {
        self.check_diameter()?;
        self.check_length_alone()?;
        self.select_tool()?;
        if let Some((meaning, _)) = self.said.cancel {
            self.now.modes.motion = match meaning {
                Meaning::CancelCycleAndPosition => Motion::Rapid,
                _ => self.now.modes.before_cycle,
            };
            self.now.cycle.clear();
        }
        for (code, word) in &self.said.settings {
            if let Code::Of(meaning) = code
                && !mode(&mut self.now.modes, *meaning)
            {
                self.set(*meaning, *word)?;
            }
        }
        self.now.scales.follow(&self.known.dialect, &self.now.modes);
        for (code, word) in &self.said.settings {
            match code {
                Code::WorkOffset(tenths) => self.take_work_offset(*tenths),
                Code::Of(meaning) => self.set_tool_length(*meaning, *word)?,
                Code::Cycle(_) | Code::Refused(_) => {}
            }
        }
        if let Some((motion, _)) = self.said.motion {
            self.begin(motion);
        }
        Ok(())
    }

    fn begin(&mut self, motion: Motion) {
        let modal = match motion {
            Motion::Cycle(number) => {
                let modal = self.known.dialect.cycle(number).modal;
                if self.now.modes.motion != motion {
                    self.now.cycle.clear();
                }
                if !matches!(self.now.modes.motion, Motion::Cycle(_)) {
                    self.now.modes.before_cycle = self.now.modes.motion;
                }
                modal
            }
            _ => {
                self.now.cycle.clear();
                self.now.modes.before_cycle = motion;
                true
            }
        };
        self.now.modes.motion = motion;
        self.now.cycle.once = !modal;
    }

    /// Whether a word beside G7 is a diameter already depends on the control.
    fn check_diameter(&self) -> Result<(), Found> {
        let changes = |code: &Code| matches!(code, Code::Of(Meaning::Diameter | Meaning::Radius));
        match self.said.settings.iter().find(|(code, _)| changes(code)) {
            Some((_, word)) if self.said.has_axes() => Err((
                self.start_of(*word),
                Reason::Unsupported("G7 and G8 stand in a block without words of axes"),
            )),
            _ => Ok(()),
        }
    }

    /// Where H is modal, H alone brings another length into force.
    fn check_length_alone(&self) -> Result<(), Found> {
        let dialect = &self.known.dialect;
        if dialect.length_of_tool_in_use() || dialect.letter(b'H') != Letter::Parameter {
            return Ok(());
        }
        let in_force = self.now.offset_of.flatten().filter(|number| *number != 0);
        let Some(number) = in_force.filter(|_| parameter(self.block, b'H') != Said::Nothing) else {
            return Ok(());
        };
        let named = self.said.settings.iter().any(|(code, _)| {
            matches!(
                code,
                Code::Of(
                    Meaning::ToolLength
                        | Meaning::ToolLengthNegative
                        | Meaning::ToolLengthAdded
                        | Meaning::ToolLengthOff
                )
            )
        });
        if named || count(self.block, b'H') == Some(number) {
            return Ok(());
        }
        let word = self.block.words.iter().position(|word| word.letter == b'H');
        let what = "H alone brings another tool length into force: write G43 or G44 beside it";
        Err((
            word.map_or(0, |word| self.start_of(word)),
            Reason::Unsupported(what),
        ))
    }

    fn select_tool(&mut self) -> Result<(), Found> {
        let number = match parameter(self.block, b'T') {
            Said::Nothing => return Ok(()),
            Said::Unknown => None,
            Said::Number(number) => Some(number),
        };
        let whole = number.and_then(|number| u32::try_from(number.whole()?).ok());
        match self.known.dialect.tools() {
            ToolSelection::ToolChange => self.now.selected = whole,
            ToolSelection::Plain => {
                self.now.tool = whole;
                self.now.radius_of = whole;
            }
            ToolSelection::Turret => {
                let digits = number.map_or(4, |number| number.integer_digits());
                if !(3..=4).contains(&digits) {
                    let word = self.block.words.iter().position(|word| word.letter == b'T');
                    let reason = Reason::Number {
                        letter: 'T',
                        expected: "two digits of the tool and two of its offset",
                    };
                    return Err((word.map_or(0, |word| self.start_of(word)), reason));
                }
                self.now.tool = whole.map(|whole| whole / 100);
                self.take_tool_offset(whole.map(|whole| whole % 100), 1.0, false);
            }
        }
        Ok(())
    }

    fn set(&mut self, meaning: Meaning, word: usize) -> Result<(), Found> {
        match meaning {
            Meaning::ToolChange => {
                self.now.tool = self.now.selected;
                self.now.radius_of = self.now.tool;
                let places = self.known.tool_change.clone();
                for (axis, place) in places {
                    self.now.axes[axis.index()].at_machine(Some(place), Lost::Offset);
                }
            }
            Meaning::SetTool => self.now.tool = count(self.block, b'Q'),
            Meaning::CompensationOff => self.now.modes.compensation = false,
            Meaning::CompensationOn => {
                self.now.modes.compensation = true;
                self.set_radius(word);
            }
            _ => {}
        }
        Ok(())
    }

    /// D of G41 names the offset that has the radius; of G41.1 it is the diameter.
    fn set_radius(&mut self, word: usize) {
        let given = self.block.words[word]
            .number()
            .is_some_and(|number| number.whole().is_none());
        match parameter(self.block, b'D') {
            Said::Nothing => {}
            Said::Unknown => self.now.radius_of = None,
            Said::Number(number) if given => {
                let scale = super::write::Scale::of_centre(&self.known.dialect, &self.now.modes);
                self.now.radius_mm = Some(scale.read(number) / 2.0);
            }
            Said::Number(_) => {
                self.now.radius_of = count(self.block, b'D');
                self.now.radius_mm = None;
            }
        }
    }

    fn set_tool_length(&mut self, meaning: Meaning, _word: usize) -> Result<(), Found> {
        let number = match parameter(self.block, b'H') {
            Said::Nothing if self.known.dialect.length_of_tool_in_use() => self.now.tool,
            Said::Nothing => None,
            Said::Number(_) | Said::Unknown => count(self.block, b'H'),
        };
        match meaning {
            Meaning::ToolLength => self.take_tool_offset(number, 1.0, false),
            Meaning::ToolLengthNegative => self.take_tool_offset(number, -1.0, false),
            Meaning::ToolLengthAdded => self.take_tool_offset(number, 1.0, true),
            Meaning::ToolLengthOff => {
                self.take_tool_offset(Some(0), 1.0, false);
                self.now.offset_of = None;
            }
            _ => {}
        }
        Ok(())
    }

    fn take_work_offset(&mut self, code: u16) {
        self.now.modes.work = code;
        for axis in Axis::ALL {
            let part = self.known.work_part(code, axis);
            self.now.axes[axis.index()].set(Offset::Work, part);
        }
    }

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

    fn axis_value(&self, index: usize) -> Result<Option<f64>, Found> {
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

    fn set_tool(&mut self, number: u32) -> Result<(), Found> {
        let mut tool = self
            .known
            .tools
            .get(&number)
            .cloned()
            .unwrap_or_else(Tool::default);
        for index in 0..AXES {
            if let Some(said) = self.axis_value(index)? {
                tool.offset.insert(axis(index), said);
            }
        }
        if let Said::Number(radius) = parameter(self.block, b'R') {
            tool.radius_mm = Some(self.scale(Axis::Z).read(radius));
        }
        self.known.tools.insert(number, tool);
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

    fn tool_offset_given(&mut self) -> Result<(), Found> {
        for index in 0..AXES {
            if let Some(said) = self.axis_value(index)? {
                self.change_offset(index, Part::of(Some(said)));
            }
        }
        self.now.tool_offset = known::tool_offset(&self.now.axes);
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
