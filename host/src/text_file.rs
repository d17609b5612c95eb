//! Files of text: what cannot be read, or is no UTF-8, is told with its place.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use leadscrew_nc::source::{Complaint, text_of};
use thiserror::Error;

/// Why a file gives no text.
#[derive(Debug, Error)]
pub enum TextFileError {
    /// It cannot be read.
    #[error("{}: cannot be read ({reason}): {}", file.display(), remedy(reason))]
    Read {
        /// The file.
        file: PathBuf,
        /// Why.
        reason: io::Error,
    },
    /// It is no UTF-8.
    #[error("{}:{complaint}", file.display())]
    Encoding {
        /// The file.
        file: PathBuf,
        /// What was found, and where.
        complaint: Complaint,
    },
}

impl TextFileError {
    /// A read error of `file`.
    pub fn read(file: &Path) -> impl FnOnce(io::Error) -> Self {
        let file = file.to_owned();
        move |reason| Self::Read { file, reason }
    }
}

/// The text of a file, without the mark of UTF-8.
///
/// # Errors
/// [`TextFileError`].
pub fn read(path: &Path) -> Result<String, TextFileError> {
    let bytes = std::fs::read(path).map_err(TextFileError::read(path))?;
    text_of(bytes).map_err(|complaint| TextFileError::Encoding {
        file: path.to_owned(),
        complaint,
    })
}

/// What to do about a read error.
fn remedy(reason: &io::Error) -> &'static str {
    match reason.kind() {
        ErrorKind::IsADirectory => "give a file that is in it",
        _ => "check the path and its permissions",
    }
}
