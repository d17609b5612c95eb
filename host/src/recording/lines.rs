//! Lines of a text file one at a time, with their numbers. The `csv` crate counts records where
//! rows end in CR LF or blank lines stand between, so its line numbers are not the editor's.

use std::io::{BufRead, Read};

use super::error::{Located, Problem, excerpt};

/// No row of a capture comes near; a binary file without line ends stops here, not at the end of
/// memory.
pub(super) const LONGEST_LINE_BYTES: usize = 1 << 16;

/// A cursor over the lines that are not blank.
pub(super) struct Lines<R> {
    reader: R,
    buffer: Vec<u8>,
    number: u64,
}

impl<R: BufRead> Lines<R> {
    pub(super) fn new(reader: R) -> Self {
        Lines {
            reader,
            buffer: Vec::new(),
            number: 0,
        }
    }

    /// Goes to the next line that is not blank; false at the end of the file.
    pub(super) fn advance(&mut self) -> Result<bool, Located> {
        loop {
            self.buffer.clear();
            let mut limited = (&mut self.reader).take(LONGEST_LINE_BYTES as u64);
            let read = limited
                .read_until(b'\n', &mut self.buffer)
                .map_err(Problem::Unreadable)?;
            if read == 0 {
                return Ok(false);
            }
            self.number += 1;
            if read == LONGEST_LINE_BYTES && !self.buffer.ends_with(b"\n") {
                return Err(self.too_long());
            }
            if !self.bytes().is_empty() {
                return Ok(true);
            }
        }
    }

    /// Number of the current line, from 1.
    pub(super) fn number(&self) -> u64 {
        self.number
    }

    /// The current line without its end and the spaces around it.
    pub(super) fn bytes(&self) -> &[u8] {
        self.buffer.trim_ascii()
    }

    /// The current line as text.
    pub(super) fn text(&self) -> Result<&str, Located> {
        str::from_utf8(self.bytes()).map_err(|_| Problem::NotUtf8.at(self.number))
    }

    /// The current line does not fit.
    pub(super) fn broken(&self, expected: impl Into<String>, advice: &'static str) -> Located {
        let found = excerpt(self.bytes());
        Problem::BrokenRow {
            expected: expected.into(),
            found,
            advice,
        }
        .at(self.number)
    }

    fn too_long(&self) -> Located {
        self.broken(
            format!("a line of at most {LONGEST_LINE_BYTES} bytes"),
            "this is no capture, or a damaged one; export it again",
        )
    }
}
