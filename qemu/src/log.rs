use std::fmt;
use std::fs;
use std::path::Path;

use defmt_decoder::{DecodeError, Frame, Table};

use crate::Error;

/// One message of the guest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogLine {
    /// Virtual time, as the guest's `defmt::timestamp!` formats it; empty if it has none.
    pub timestamp: String,
    /// `trace` to `error`; empty for `defmt::println!`.
    pub level: String,
    /// The text.
    pub message: String,
}

impl fmt::Display for LogLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:>10} {:<5} ", self.timestamp, self.level)?;
        f.write_str(&self.message)
    }
}

/// Decodes the bytes that `image` logged.
///
/// A damaged message becomes a line that says so, of level `error`; an unfinished last one is left
/// out.
pub fn decode(image: &Path, bytes: &[u8]) -> Result<Vec<LogLine>, Error> {
    let elf = fs::read(image).map_err(|source| Error::File {
        path: image.to_owned(),
        source,
    })?;
    let refused = |reason: String| Error::Image {
        path: image.to_owned(),
        reason,
    };
    let table = Table::parse(&elf)
        .map_err(|e| refused(format!("{e:#}")))?
        .ok_or_else(|| refused("no .defmt section".to_owned()))?;
    let mut decoder = table.new_stream_decoder();
    decoder.received(bytes);
    let mut lines = Vec::new();
    loop {
        match decoder.decode() {
            Ok(frame) => lines.push(line(&frame)),
            Err(DecodeError::UnexpectedEof) => return Ok(lines),
            Err(DecodeError::Malformed) => {
                lines.push(LogLine {
                    timestamp: String::new(),
                    level: "error".to_owned(),
                    message: "(a damaged message)".to_owned(),
                });
                if !table.encoding().can_recover() {
                    return Ok(lines);
                }
            }
        }
    }
}

fn line(frame: &Frame<'_>) -> LogLine {
    LogLine {
        timestamp: frame
            .display_timestamp()
            .map(|timestamp| timestamp.to_string())
            .unwrap_or_default(),
        level: frame
            .level()
            .map(|level| level.as_str().to_owned())
            .unwrap_or_default(),
        message: frame.display_message().to_string(),
    }
}
