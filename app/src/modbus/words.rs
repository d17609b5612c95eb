//! Values as registers.

/// A value in registers of 16 bits, its highest word first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Words {
    words: [u16; Self::MOST],
    count: usize,
}

impl Words {
    /// Registers of the longest value.
    pub const MOST: usize = 4;

    /// The words of a value's bytes, highest first, up to 8 of them.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Self {
        let mut words = [0; Self::MOST];
        let (pairs, _) = bytes.as_chunks();
        for (word, pair) in words.iter_mut().zip(pairs) {
            *word = u16::from_be_bytes(*pair);
        }
        Self {
            words,
            count: pairs.len().min(Self::MOST),
        }
    }

    /// The words, in the order of their registers.
    #[must_use]
    pub fn as_slice(&self) -> &[u16] {
        &self.words[..self.count]
    }
}
