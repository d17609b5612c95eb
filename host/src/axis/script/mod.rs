//! Scripts of moves and checks, a step a line, for acceptance runs. `docs/commissioning.md` has their words.

mod expect;
mod parse;
mod run;

use std::path::{Path, PathBuf};

pub use expect::Expected;
pub use parse::{assignments, parse};
pub use run::{Done, Failure, Run, check, clear, run};

use crate::error::CommandError;
use crate::text_file;

/// A script that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Script {
    /// Its file.
    pub file: PathBuf,
    /// Its steps.
    pub steps: Vec<Step>,
}

/// A step.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Its line, from 1.
    pub line: usize,
    /// The line as it stands there, without its comment.
    pub text: String,
    /// What is to be done.
    pub action: Action,
}

/// What is to be done.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Put under control.
    Enable,
    /// Out of control.
    Disable,
    /// Find the origin.
    Home,
    /// Feed hold.
    Hold,
    /// End it.
    Resume,
    /// Stop.
    Stop,
    /// Clear fault and warnings.
    Clear,
    /// Save the parameters.
    Save,
    /// Start the firmware anew.
    Restart,
    /// Move.
    Move(Motion),
    /// Jog, for a time or until something else is ordered.
    Jog {
        /// mm/min.
        feed_mm_per_min: f64,
        /// s.
        seconds: Option<f64>,
    },
    /// Feed override, %.
    Override(u16),
    /// Wait, s.
    Wait(f64),
    /// Wait until it stands.
    WaitRest,
    /// Set parameters: name and value, as they stand there.
    Set(Vec<(String, String)>),
    /// Check.
    Expect(Expected),
    /// Say something.
    Print(String),
    /// Do steps several times.
    Repeat(u32, Vec<Step>),
}

/// A move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Where to, or by how far, mm.
    pub mm: f64,
    /// It is by how far.
    pub is_by: bool,
    /// mm/min.
    pub feed_mm_per_min: f64,
    /// Its end is waited for.
    pub is_awaited: bool,
}

impl Script {
    /// Reads a script.
    ///
    /// # Errors
    /// It cannot be read; file, line and what was expected.
    pub fn read(file: &Path) -> Result<Self, CommandError> {
        let shown = file.display();
        let text = text_file::read(file).map_err(|error| CommandError::Usage(error.to_string()))?;
        let steps = parse(&text)
            .map_err(|(line, message)| CommandError::Usage(format!("{shown}:{line}: {message}")))?;
        Ok(Self {
            file: file.to_owned(),
            steps,
        })
    }
}
