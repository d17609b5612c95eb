//! The output converter and its wires to the drive.

use leadscrew::units::Command;

/// What the converter puts out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Converter {
    /// What it is told.
    #[default]
    Good,
    /// Always this.
    Stuck(Command),
    /// What it is told and this, within full command.
    OffBy(Command),
}

impl Converter {
    /// What it puts out when it is told `command`.
    #[must_use]
    pub fn output(self, command: Command) -> Command {
        match self {
            Self::Good => command,
            Self::Stuck(output) => output,
            Self::OffBy(offset) => command
                .saturating_add(offset)
                .clamp(-Command::ONE, Command::ONE),
        }
    }
}
