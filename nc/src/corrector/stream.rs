//! Whole programs: from a reader to a writer.

use std::fmt;
use std::io::{self, BufRead, Write};

use super::{Corrector, Refusal};
use crate::block::Blocks;

/// What was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Blocks read.
    pub blocks: u64,
    /// Blocks that came out otherwise than they went in.
    pub changed: u64,
    /// Blocks written beyond those read, where movements were split.
    pub added: u64,
    /// Bytes read.
    pub bytes_read: u64,
    /// Bytes written.
    pub bytes_written: u64,
}

/// Why a program was not corrected.
#[derive(Debug)]
pub enum CorrectError {
    /// A block is refused; the blocks before it were written.
    Refused(Refusal),
    /// The reader.
    Read(io::Error),
    /// The writer.
    Write(io::Error),
}

impl fmt::Display for CorrectError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(refusal) => refusal.fmt(f),
            Self::Read(error) => write!(f, "cannot read the program: {error}"),
            Self::Write(error) => write!(f, "cannot write the program: {error}"),
        }
    }
}

impl std::error::Error for CorrectError {}

/// Corrects a program from a reader into a writer, a block at a time; the memory is that of the longest block.
///
/// # Errors
/// The first block that is refused, or what reader or writer say. What was corrected before is written.
pub fn correct(
    reader: impl BufRead,
    mut writer: impl Write,
    corrector: &mut Corrector,
) -> Result<Report, CorrectError> {
    let mut blocks = Blocks::new(reader);
    let (mut block, mut out) = (Vec::new(), Vec::new());
    let mut report = Report::default();
    while blocks.next_into(&mut block).map_err(CorrectError::Read)? {
        out.clear();
        corrector
            .block(&block, &mut out)
            .map_err(CorrectError::Refused)?;
        report.blocks += 1;
        report.bytes_read += block.len() as u64;
        report.bytes_written += out.len() as u64;
        if out != block {
            report.changed += 1;
            report.added += count_more(&block, &out);
        }
        writer.write_all(&out).map_err(CorrectError::Write)?;
    }
    writer.flush().map_err(CorrectError::Write)?;
    Ok(report)
}

/// Blocks in `out` beyond the one of `block`.
fn count_more(block: &[u8], out: &[u8]) -> u64 {
    if !out.contains(&b'\r') {
        let ends = |bytes: &[u8]| bytes.iter().filter(|byte| **byte == b'\n').count() as u64;
        return u64::saturating_sub(ends(out), ends(block));
    }
    let ends = |bytes: &[u8]| {
        let mut ends = 0;
        let mut before = 0;
        for byte in bytes {
            if *byte == b'\r' || (*byte == b'\n' && before != b'\r') {
                ends += 1;
            }
            before = *byte;
        }
        ends
    };
    u64::saturating_sub(ends(out), ends(block))
}
