//! Modes and offsets that come into force before anything moves; `tools` has those of tools, `takers` what takes the words of the axes.

use super::Task;
use super::instruction::{Found, count};
use super::known::mode;
use super::refusal::{Lost, Reason};
use super::state::{Motion, Offset};
use crate::coordinates::Axis;
use crate::dialect::{Code, Meaning};

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

    fn take_work_offset(&mut self, code: u16) {
        self.now.modes.work = code;
        for axis in Axis::ALL {
            let part = self.known.work_part(code, axis);
            self.now.axes[axis.index()].set(Offset::Work, part);
        }
    }
}
