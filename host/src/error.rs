//! Errors of the command, and the exit code that each means.

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::axis::ProcedureError;
use crate::plot::PlotError;

/// Why a command could not do its job.
#[derive(Debug, Error)]
pub enum CommandError {
    /// The command line asks for something that cannot be.
    #[error("{0}")]
    Usage(String),
    /// A capture cannot be read.
    #[error(transparent)]
    Recording(#[from] crate::recording::RecordingError),
    /// A file gives no text.
    #[error(transparent)]
    TextFile(#[from] crate::text_file::TextFileError),
    /// A machine or a scenario file cannot be used.
    #[error(transparent)]
    TomlFile(#[from] crate::toml_file::TomlFileError),
    /// A file says something that is not understood or not allowed.
    #[error("{}:{complaint}", file.display())]
    Content {
        /// The file.
        file: PathBuf,
        /// What is wrong, and where.
        complaint: leadscrew_nc::source::Complaint,
    },
    /// A recording of an axis cannot be read.
    #[error(transparent)]
    Recorded(#[from] crate::recorded::ReadError),
    /// An encoder map cannot be used.
    #[error(transparent)]
    MapFile(#[from] crate::map_file::MapFileError),
    /// A scenario cannot run.
    #[error(transparent)]
    Scenario(#[from] leadscrew_hal_mock::scenario::ScenarioError),
    /// A plot cannot be made.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// A file cannot be written.
    #[error(
        "{}: cannot be written ({reason}): check that its directory exists and may be written to",
        file.display()
    )]
    Write {
        /// The file.
        file: PathBuf,
        /// Why.
        reason: std::io::Error,
    },
    /// Standard output cannot be written.
    #[error("the report cannot be printed: {0}")]
    Print(std::io::Error),
    /// The axis does not do it, or cannot be reached.
    #[error(transparent)]
    Axis(#[from] leadscrew_client::Error),
    /// Something is wrong with the data.
    #[error("{0}")]
    Data(String),
}

impl From<ProcedureError> for CommandError {
    fn from(error: ProcedureError) -> Self {
        match error {
            ProcedureError::Axis(error) => Self::Axis(error),
            ProcedureError::Answer(text) => Self::Usage(text),
            error => Self::Data(error.to_string()),
        }
    }
}

impl CommandError {
    /// A write error of `file`.
    pub fn write(file: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let file = file.to_owned();
        move |reason| Self::Write { file, reason }
    }

    /// What is wrong in the text of `file`.
    pub fn content(file: &Path) -> impl FnOnce(leadscrew_nc::source::Complaint) -> Self {
        let file = file.to_owned();
        move |complaint| Self::Content { file, complaint }
    }

    /// 2 for bad usage, 3 for an axis that was lost, 1 for another job that failed.
    #[must_use]
    pub const fn exit_code(&self) -> u8 {
        use leadscrew_client::Error as AxisError;
        match self {
            Self::Axis(error) if error.is_lost() => 3,
            Self::Axis(
                AxisError::NoSuchPort { .. }
                | AxisError::UnknownParameter { .. }
                | AxisError::ParameterOutOfRange { .. }
                | AxisError::NoNumber { .. },
            )
            | Self::Usage(_)
            | Self::Scenario(_)
            | Self::Plot(PlotError::Extension { .. }) => 2,
            _ => 1,
        }
    }
}
