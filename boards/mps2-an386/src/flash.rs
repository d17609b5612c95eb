//! A NOR flash: cells in memory, and a file of the host that keeps them when QEMU ends.
//!
//! [`WORD`] bytes are written at a time and clear bits only; a sector is erased as one. Every word is in the file before
//! the next one, so killing QEMU at any moment is a power cut.

use core::ffi::CStr;

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use heapless::Vec;
use semihosting::fs::{File, OpenOptions};
use semihosting::io::{self, Read, Seek, SeekFrom, Write};
use static_cell::ConstStaticCell;

/// Bytes of a sector.
pub const SECTOR: usize = 4096;
/// Bytes of the whole flash: room for a set of parameters, an encoder map and a screw table, twice.
pub const CAPACITY: usize = 16 * SECTOR;
/// Bytes that are written at a time.
pub const WORD: usize = 4;
/// An erasure reaches the file in pieces, so that it can be cut like any other operation.
const ERASED_AT_ONCE: usize = 1024;
const ERASED: u8 = 0xff;
const LONGEST_PATH: usize = 256;

static CELLS: ConstStaticCell<[u8; CAPACITY]> = ConstStaticCell::new([0; CAPACITY]);

/// The flash.
pub struct Flash {
    cells: &'static mut [u8; CAPACITY],
    file: Option<File>,
}

/// Why there is no flash.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum OpenError {
    /// The path is longer than this many bytes: use a shorter one.
    PathTooLong(usize),
    /// The file cannot be opened, made, read or written: see that it is a file and its permissions, or give another path.
    Unusable,
    /// The file is no image of this flash: give another path, or remove it to begin with a blank flash.
    Length {
        /// Its bytes.
        found: u64,
        /// Those of the flash.
        expected: u64,
    },
}

/// Why an operation failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
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
    /// The file could not be written.
    File,
}

impl NorFlashError for FlashError {
    fn kind(&self) -> NorFlashErrorKind {
        match self {
            Self::NotAligned => NorFlashErrorKind::NotAligned,
            Self::OutOfBounds => NorFlashErrorKind::OutOfBounds,
            Self::NotErased { .. } | Self::File => NorFlashErrorKind::Other,
        }
    }
}

impl Flash {
    /// The flash in the file `path`, which is made if it is not there; without a path one that forgets.
    ///
    /// # Errors
    /// The file cannot be had, or is another one.
    ///
    /// # Panics
    /// On the second call.
    pub fn open(path: Option<&str>) -> Result<Self, OpenError> {
        let cells = CELLS.take();
        cells.fill(ERASED);
        let Some(path) = path else {
            return Ok(Self { cells, file: None });
        };
        let mut name = Vec::<u8, LONGEST_PATH>::new();
        let is_short = name.extend_from_slice(path.as_bytes()).is_ok() && name.push(0).is_ok();
        if !is_short {
            return Err(OpenError::PathTooLong(LONGEST_PATH - 1));
        }
        let name = CStr::from_bytes_with_nul(&name).map_err(|_| OpenError::Unusable)?;
        let file = match OpenOptions::new().read(true).write(true).open(name) {
            Ok(mut file) => {
                load(&mut file, cells)?;
                file
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => create(name, cells)?,
            Err(_) => return Err(OpenError::Unusable),
        };
        Ok(Self {
            cells,
            file: Some(file),
        })
    }

    /// Brings the cells from `offset` on to `new`, in the file too.
    fn set(&mut self, offset: usize, new: &[u8]) -> Result<(), FlashError> {
        if let Some(file) = &mut self.file {
            file.seek(SeekFrom::Start(offset as u64))
                .and_then(|_| file.write_all(new))
                .map_err(|_| FlashError::File)?;
        }
        self.cells[offset..][..new.len()].copy_from_slice(new);
        Ok(())
    }
}

fn load(file: &mut File, cells: &mut [u8]) -> Result<(), OpenError> {
    let found = file.metadata().map_err(|_| OpenError::Unusable)?.len();
    if found != CAPACITY as u64 {
        return Err(OpenError::Length {
            found,
            expected: CAPACITY as u64,
        });
    }
    file.read_exact(cells).map_err(|_| OpenError::Unusable)
}

fn create(name: &CStr, cells: &[u8]) -> Result<File, OpenError> {
    let mut options = OpenOptions::new();
    options.read(true).write(true).create(true).truncate(true);
    let made = options.open(name).and_then(|mut file| {
        file.write_all(cells)?;
        Ok(file)
    });
    made.map_err(|_| OpenError::Unusable)
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

impl ErrorType for Flash {
    type Error = FlashError;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        let offset = within(offset, bytes.len(), Self::READ_SIZE)?;
        bytes.copy_from_slice(&self.cells[offset..][..bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        CAPACITY
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        let len = to.checked_sub(from).ok_or(FlashError::OutOfBounds)?;
        let from = within(from, len as usize, SECTOR)?;
        for piece in (from..to as usize).step_by(ERASED_AT_ONCE) {
            self.set(piece, &[ERASED; ERASED_AT_ONCE])?;
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        let offset = within(offset, bytes.len(), WORD)?;
        for (at, word) in bytes.chunks(WORD).enumerate() {
            let place = offset + at * WORD;
            let cells = &self.cells[place..][..WORD];
            if cells.iter().zip(word).any(|(cell, new)| cell & new != *new) {
                return Err(FlashError::NotErased {
                    offset: place as u32,
                });
            }
            self.set(place, word)?;
        }
        Ok(())
    }
}
