//! The record of a content, and the keys under which it and its chunks are stored.

use super::{CHUNK, Kind};

/// Most chunks: their number is a byte.
pub(super) const MOST_CHUNKS: usize = 255;
/// Most bytes of a content.
pub(super) const MOST_BYTES: usize = MOST_CHUNKS * CHUNK;
/// Bytes of a record.
pub(super) const RECORD: usize = 18;

/// What is known of a content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Which it is.
    pub kind: Kind,
    /// Version of its format.
    pub version: u16,
    /// How often it was saved or erased, this time included.
    pub generation: u32,
    /// Bytes.
    pub len: usize,
    /// CRC-32C (Castagnoli, as of iSCSI) of its bytes.
    pub crc: u32,
    pub(super) slot: u8,
    /// Chunks that there are, or may be, in each slot.
    pub(super) chunks: [u8; 2],
}

impl Entry {
    /// What a save of `len` bytes makes of the record `before`: it goes to the other slot.
    pub(super) fn after(before: Option<Self>, kind: Kind, len: usize, crc: u32) -> Self {
        let mut after = Self {
            kind,
            version: kind.version(),
            generation: before.map_or(1, |entry| entry.generation.wrapping_add(1)),
            len,
            crc,
            slot: before.map_or(0, |entry| 1 - entry.slot),
            chunks: before.map_or([0; 2], |entry| entry.chunks),
        };
        let used = after.used() as u8;
        let chunks = &mut after.chunks[usize::from(after.slot)];
        *chunks = used.max(*chunks);
        after
    }

    pub(super) fn to_record(self) -> [u8; RECORD] {
        let mut record = [0; RECORD];
        record[..2].copy_from_slice(&self.version.to_le_bytes());
        record[2] = self.slot;
        record[4..8].copy_from_slice(&self.generation.to_le_bytes());
        record[8..12].copy_from_slice(&(self.len as u32).to_le_bytes());
        record[12..16].copy_from_slice(&self.crc.to_le_bytes());
        record[16..].copy_from_slice(&self.chunks);
        record
    }

    pub(super) fn of_record(kind: Kind, record: [u8; RECORD]) -> Self {
        let word = |at: usize| {
            let mut word = [0; 4];
            word.copy_from_slice(&record[at..at + 4]);
            u32::from_le_bytes(word)
        };
        Self {
            kind,
            version: u16::from_le_bytes([record[0], record[1]]),
            slot: record[2] & 1,
            generation: word(4),
            len: word(8) as usize,
            crc: word(12),
            chunks: [record[16], record[17]],
        }
    }

    /// Chunks of its bytes.
    pub(super) const fn used(&self) -> usize {
        self.len.div_ceil(CHUNK)
    }

    /// It needs no more chunks in its slot than there are.
    pub(super) fn fits(&self, before: Option<Self>) -> bool {
        let slot = usize::from(self.slot);
        before.is_some_and(|before| before.chunks[slot] >= self.chunks[slot])
    }
}

/// Key of a content's record.
pub(super) const fn record_key(kind: Kind) -> u16 {
    kind.number() << 12
}

/// Key of a chunk.
pub(super) const fn chunk_key(kind: Kind, slot: u8, chunk: usize) -> u16 {
    kind.number() << 12 | 1 << 11 | (slot as u16) << 10 | chunk as u16
}
