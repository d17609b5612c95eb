//! A NOR flash: writing clears bits, erasing sets those of a sector. What keeps its cells is given to it.

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

/// Bytes of a sector.
pub const SECTOR: usize = 4096;
/// Bytes of the whole flash: room for a set of parameters, an encoder map and a screw table, twice.
pub const CAPACITY: usize = 16 * SECTOR;
/// Bytes that are written at a time.
pub const WORD: usize = 4;
/// What an erased cell reads as.
pub const ERASED: u8 = 0xff;
/// An erasure comes in pieces, so that it can be cut like any other operation.
const ERASED_AT_ONCE: usize = 1024;

/// What keeps the [`CAPACITY`] cells.
pub trait Cells {
    /// Shows the cells to `look`.
    fn look<R>(&self, look: impl FnOnce(&[u8]) -> R) -> R;

    /// Brings the cells from `offset` on to `new`, as one operation that a power cut leaves done or not. Within the
    /// capacity.
    ///
    /// # Errors
    /// They could not be kept.
    fn set(&mut self, offset: usize, new: &[u8]) -> Result<(), NotKept>;
}

/// The cells could not be kept: a file could not be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotKept;

/// A flash over cells.
#[derive(Clone, Debug)]
pub struct SimulatedFlash<C>(pub C);

/// Why an operation failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlashError {
    /// Not at the bounds of words, or of sectors.
    NotAligned,
    /// Beyond the end.
    OutOfBounds,
    /// The word was written already, and a bit cannot be set without erasing.
    NotErased {
        /// Where.
        offset: u32,
    },
    /// [`NotKept`].
    NotKept,
}

impl From<NotKept> for FlashError {
    fn from(_: NotKept) -> Self {
        Self::NotKept
    }
}

impl NorFlashError for FlashError {
    fn kind(&self) -> NorFlashErrorKind {
        match self {
            Self::NotAligned => NorFlashErrorKind::NotAligned,
            Self::OutOfBounds => NorFlashErrorKind::OutOfBounds,
            Self::NotErased { .. } | Self::NotKept => NorFlashErrorKind::Other,
        }
    }
}

/// Place and length as indices, if they are within the flash and both multiples of `unit`.
fn within(offset: u32, len: usize, unit: usize) -> Result<usize, FlashError> {
    let offset = offset as usize;
    if !offset.is_multiple_of(unit) || !len.is_multiple_of(unit) {
        return Err(FlashError::NotAligned);
    }
    match offset.checked_add(len) {
        Some(end) if end <= CAPACITY => Ok(offset),
        _ => Err(FlashError::OutOfBounds),
    }
}

impl<C> ErrorType for SimulatedFlash<C> {
    type Error = FlashError;
}

impl<C: Cells> ReadNorFlash for SimulatedFlash<C> {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        let offset = within(offset, bytes.len(), Self::READ_SIZE)?;
        self.0
            .look(|cells| bytes.copy_from_slice(&cells[offset..][..bytes.len()]));
        Ok(())
    }

    fn capacity(&self) -> usize {
        CAPACITY
    }
}

impl<C: Cells> NorFlash for SimulatedFlash<C> {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        let len = to.checked_sub(from).ok_or(FlashError::OutOfBounds)?;
        let from = within(from, len as usize, SECTOR)?;
        for piece in (from..to as usize).step_by(ERASED_AT_ONCE) {
            self.0.set(piece, &[ERASED; ERASED_AT_ONCE])?;
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        let offset = within(offset, bytes.len(), WORD)?;
        for (at, word) in bytes.chunks(WORD).enumerate() {
            let place = offset + at * WORD;
            let is_clear = self.0.look(|cells| {
                let cells = cells[place..][..WORD].iter();
                cells.zip(word).all(|(cell, new)| cell & new == *new)
            });
            if !is_clear {
                return Err(FlashError::NotErased {
                    offset: place as u32,
                });
            }
            self.0.set(place, word)?;
        }
        Ok(())
    }
}
