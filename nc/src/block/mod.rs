//! The lossless reader: a block is its bytes, its words are places in them.
//!
//! What ends a block (LF, CR LF, CR, or the end of the file) belongs to it, so that all blocks in a row are the file.

mod lexis;
mod number;
mod scan;
mod split;

pub use lexis::{Lexis, OWords};
pub use number::{Number, NumberError, Sign};
pub use scan::{Flaw, FlawKind};
pub use split::{Blocks, MAX_BLOCK, body_len};

use std::ops::Range;

/// What a word says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number as it is written.
    Number(Number),
    /// Something that only the control can work out: an expression, a parameter, a function.
    Expression,
    /// A letter alone.
    None,
}

/// A letter and its value, and where they stand in the block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Word {
    /// Letter, upper case; also `@`, `^` and `$`.
    pub letter: u8,
    /// What it says.
    pub value: Value,
    start: u32,
    value_start: u32,
    end: u32,
}

impl Word {
    /// Where letter and value stand in the block, bytes.
    #[must_use]
    pub fn span(&self) -> Range<usize> {
        self.start as usize..self.end as usize
    }

    /// Where the value stands in the block, bytes.
    #[must_use]
    pub fn value_span(&self) -> Range<usize> {
        self.value_start as usize..self.end as usize
    }

    /// The number it says, if it is one.
    #[must_use]
    pub fn number(&self) -> Option<Number> {
        match self.value {
            Value::Number(number) => Some(number),
            Value::Expression | Value::None => None,
        }
    }
}

/// What a block is made of. Kept from block to block, so that reading allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct Block {
    /// Its words, in their order.
    pub words: Vec<Word>,
    /// The place of a block delete `/` before the words.
    pub delete: Option<usize>,
    /// The place of a `%`: the rest of such a block is no words.
    pub percent: Option<usize>,
    /// Where an O word that steers the flow of the program stands (LinuxCNC); it takes the whole block.
    pub flow: Option<Range<usize>>,
    /// Where parameters are set, `#1 = 2`.
    pub assignments: Vec<Range<usize>>,
    /// Where comments stand, with their brackets or the semicolon.
    pub comments: Vec<Range<usize>>,
    /// Where what ends the block begins.
    pub end: usize,
}

impl Block {
    /// Reads a block anew.
    ///
    /// # Errors
    /// What is no word, and where. The block keeps what was read before it.
    pub fn read(&mut self, bytes: &[u8], lexis: &Lexis) -> Result<(), Flaw> {
        scan::scan(bytes, lexis, self)
    }

    /// True where the control has nothing to do but to go on: no word, no flow, no parameter.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        self.words.is_empty()
            && self.flow.is_none()
            && self.assignments.is_empty()
            && self.percent.is_none()
    }

    /// The first word of a letter.
    #[must_use]
    pub fn word(&self, letter: u8) -> Option<&Word> {
        self.words.iter().find(|word| word.letter == letter)
    }

    fn clear(&mut self, end: usize) {
        self.words.clear();
        self.assignments.clear();
        self.comments.clear();
        self.delete = None;
        self.percent = None;
        self.flow = None;
        self.end = end;
    }
}

/// Column of a byte of a block, from 1: characters where the bytes before it are UTF-8, bytes elsewhere.
#[must_use]
pub fn column(block: &[u8], byte: usize) -> usize {
    let before = &block[..byte.min(block.len())];
    1 + std::str::from_utf8(before).map_or(before.len(), |text| text.chars().count())
}
