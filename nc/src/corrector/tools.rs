//! Tools in use, their lengths and radii.

use super::instruction::{Found, Said, count, parameter};
use super::refusal::{Lost, Reason};
use super::state::{Offset, Part, axis};
use super::{Task, known};
use crate::coordinates::{AXES, Axis};
use crate::dialect::{Code, Letter, Meaning, ToolSelection};
use crate::machine_state::Tool;

impl Task<'_> {
    /// Where H is modal, H alone brings another length into force.
    pub fn check_length_alone(&self) -> Result<(), Found> {
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

    pub fn select_tool(&mut self) -> Result<(), Found> {
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

    /// D of G41 names the offset that has the radius; of G41.1 it is the diameter.
    pub fn set_radius(&mut self, word: usize) {
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

    pub fn set_tool_length(&mut self, meaning: Meaning, _word: usize) -> Result<(), Found> {
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

    /// Another tool offset comes into force.
    pub fn take_tool_offset(&mut self, number: Option<u32>, sign: f64, added: bool) {
        self.now.offset_of = Some(number);
        self.now.radius_of = number;
        self.now.radius_mm = None;
        for index in 0..AXES {
            let mut part = self.known.tool_part(number, sign, axis(index));
            let before = self.now.axes[index].offsets[Offset::Tool as usize];
            if added {
                part.value = before.value.zip(part.value).map(|(old, new)| old + new);
            }
            self.change_offset(index, part);
        }
        self.now.tool_offset = known::tool_offset(&self.now.axes);
    }

    /// Another tool offset of one axis: on some controls the axis moves, on some its coordinates change.
    pub fn change_offset(&mut self, index: usize, part: Part) {
        let stands = self.known.dialect.offsets_stand_still();
        let state = &mut self.now.axes[index];
        let same = state.offsets[Offset::Tool as usize].value == part.value && part.value.is_some();
        state.set(Offset::Tool, part);
        self.counts_anew |= !same;
        if !same && !stands {
            state.machine = None;
            state.program = None;
            state.lost = Lost::ToolOffset;
        }
    }

    pub fn set_tool(&mut self, number: u32) -> Result<(), Found> {
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

    pub fn tool_offset_given(&mut self) -> Result<(), Found> {
        for index in 0..AXES {
            if let Some(said) = self.axis_value(index)? {
                self.change_offset(index, Part::of(Some(said)));
            }
        }
        self.now.tool_offset = known::tool_offset(&self.now.axes);
        Ok(())
    }
}
