//! Blocks out of a stream.

use std::io::{self, BufRead};

/// The longest block read, bytes: what bounds the memory. Controls read far shorter ones.
pub const MAX_BLOCK: usize = 65_536;

/// Bytes of a block before what ends it.
#[must_use]
pub fn body_len(block: &[u8]) -> usize {
    match block {
        [body @ .., b'\r', b'\n'] | [body @ .., b'\n' | b'\r'] => body.len(),
        _ => block.len(),
    }
}

/// Reads one block after the other.
#[derive(Debug)]
pub struct Blocks<R> {
    reader: R,
}

impl<R: BufRead> Blocks<R> {
    /// From a reader.
    pub const fn new(reader: R) -> Self {
        Self { reader }
    }

    /// Reads the next block into `block`, with what ends it; `false` at the end. A block longer than [`MAX_BLOCK`] comes in
    /// pieces that long.
    ///
    /// # Errors
    /// Those of the reader.
    pub fn next_into(&mut self, block: &mut Vec<u8>) -> io::Result<bool> {
        block.clear();
        loop {
            let available = match self.reader.fill_buf() {
                Ok(available) => available,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(error),
            };
            if available.is_empty() {
                return Ok(!block.is_empty());
            }
            if block.last() == Some(&b'\r') {
                if available[0] == b'\n' {
                    block.push(b'\n');
                    self.reader.consume(1);
                }
                return Ok(true);
            }
            let room = MAX_BLOCK - block.len();
            let piece = &available[..available.len().min(room)];
            let end = piece.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            let taken = end.map_or(piece.len(), |at| at + 1);
            block.extend_from_slice(&piece[..taken]);
            self.reader.consume(taken);
            if block.last() == Some(&b'\n') || block.len() >= MAX_BLOCK {
                return Ok(true);
            }
        }
    }
}
