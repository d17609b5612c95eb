//! The person in front of the axis, at a terminal.

use std::io::{BufRead as _, IsTerminal as _, Write as _, stderr, stdin};

use indicatif::{ProgressBar, ProgressDrawTarget};
use leadscrew::settings::Settings;
use leadscrew_client::Axis;

use crate::axis::{Guide, ProcedureError, Room};
use crate::cli::{RoomArgs, YesArgs};
use crate::command::print;
use crate::error::CommandError;

/// A person who reads standard error, where questions and progress go, and standard output, where results go.
pub struct Person {
    /// Agrees to all.
    yes: bool,
    /// Standard output is for a program: results are told on standard error.
    is_json: bool,
    bar: ProgressBar,
    /// What was told last, where there is no terminal to show it on.
    told: String,
}

impl Person {
    /// `yes`: nothing is asked; `is_json`: standard output is left to the report.
    #[must_use]
    pub fn new(yes: &YesArgs, is_json: bool) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        Self {
            yes: yes.yes,
            is_json,
            bar,
            told: String::new(),
        }
    }

    /// Where an axis may go: between its soft limits if it is homed and has some, else as far as it is told.
    pub fn room(
        &mut self,
        axis: &mut Axis,
        settings: &Settings,
        args: &RoomArgs,
    ) -> Result<Room, CommandError> {
        let status = axis.status()?;
        if let Some(limits) = Room::of_limits(&status, settings) {
            let minus = args.room_minus.unwrap_or(f64::INFINITY);
            let plus = args.room_plus.unwrap_or(f64::INFINITY);
            return Ok(Room {
                low_mm: limits.low_mm.max(status.position_mm - minus),
                high_mm: limits.high_mm.min(status.position_mm + plus),
            });
        }
        let mut side = |given: Option<f64>, name: &str, side: &str| match given {
            Some(way) if way >= 0.0 => Ok(way),
            Some(way) => Err(CommandError::Usage(format!(
                "{name} {way}: a way is 0 mm or more"
            ))),
            None if self.yes => Err(CommandError::Usage(format!(
                "the axis is not homed, or has no soft limits: state the free travel to the {side} side of where it stands with {name} MM"
            ))),
            None => Ok(self.number(
                &format!("Free travel from where the axis stands to the {side} side, mm"),
                0.0,
            )?),
        };
        let minus = side(args.room_minus, "--room-minus", "minus")?;
        let plus = side(args.room_plus, "--room-plus", "plus")?;
        Ok(Room::around(&status, settings, minus, plus))
    }

    /// Asks; a no ends all.
    pub fn agreed(&mut self, question: &str) -> Result<(), ProcedureError> {
        if self.agree(question, true)? {
            Ok(())
        } else {
            Err(ProcedureError::Declined)
        }
    }

    fn show(&mut self, text: &str) {
        self.bar.set_message("");
        self.bar.suspend(|| {
            // Nobody may be listening.
            let _ = writeln!(stderr(), "{text}");
        });
    }

    fn answer(&mut self, question: &str) -> Result<String, ProcedureError> {
        self.bar.suspend(|| {
            let _ = write!(stderr(), "{question} ");
            let _ = stderr().flush();
        });
        let mut line = String::new();
        match stdin().lock().read_line(&mut line) {
            Ok(length) if length > 0 => Ok(line.trim().to_lowercase()),
            _ => Err(ProcedureError::Answer(
                "nobody answers on standard input: run it at a terminal, or with --yes".to_owned(),
            )),
        }
    }
}

impl Guide for Person {
    fn tell(&mut self, text: &str) {
        if self.is_json {
            self.show(text);
        } else {
            // A reader that went away is no reason to stop an axis half way.
            self.bar.suspend(|| _ = print(&format!("{text}\n")));
        }
    }

    fn progress(&mut self, text: &str) {
        if stderr().is_terminal() {
            self.bar.set_message(text.to_owned());
            self.bar.tick();
            return;
        }
        // In a log a line for each kind of work is enough, not one for each revolution.
        let kind = text.split([':', '%']).next().unwrap_or(text).to_owned();
        if kind != self.told {
            let _ = writeln!(stderr(), "  {kind}");
            self.told = kind;
        }
    }

    fn agree(&mut self, question: &str, default: bool) -> Result<bool, ProcedureError> {
        if self.yes {
            self.show(&format!("{question} yes"));
            return Ok(true);
        }
        let choice = if default { "[Y/n]" } else { "[y/N]" };
        loop {
            match self.answer(&format!("{question} {choice}"))?.as_str() {
                "" => return Ok(default),
                "y" | "yes" => return Ok(true),
                "n" | "no" => return Ok(false),
                _ => self.show("y or n"),
            }
        }
    }

    fn number(&mut self, question: &str, default: f64) -> Result<f64, ProcedureError> {
        if self.yes {
            self.show(&format!("{question}: {default}"));
            return Ok(default);
        }
        loop {
            let answer = self.answer(&format!("{question} [{default}]"))?;
            if answer.is_empty() {
                return Ok(default);
            }
            match answer.replace(',', ".").parse() {
                Ok(number) => return Ok(number),
                Err(_) => self.show(&format!("`{answer}` is no number")),
            }
        }
    }
}

impl Drop for Person {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
