//! The flash of a simulated axis: an image in memory, and a file that keeps it.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

/// Bytes of a sector; sector, word and length are those of the board in QEMU, so that either reads the other's image.
const SECTOR: usize = 4096;
/// Bytes of the whole flash.
pub const CAPACITY: usize = 16 * SECTOR;
/// Bytes that are written at a time.
const WORD: usize = 4;
const ERASED: u8 = 0xff;

/// A flash. Clones are the same flash, as an axis that is switched on again finds it.
#[derive(Clone, Debug)]
pub struct FlashImage(Arc<Mutex<Image>>);

#[derive(Debug)]
struct Image {
    cells: Vec<u8>,
    file: Option<File>,
}

/// Why an image cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// It cannot be opened, made or read.
    #[error("{}: the flash image cannot be used ({reason}): give another path", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
    /// It is no image.
    #[error(
        "{}: {found} bytes are no flash image of {CAPACITY}: give another path, or remove it to begin blank",
        path.display()
    )]
    Length {
        /// The file.
        path: PathBuf,
        /// Its bytes.
        found: usize,
    },
}

impl FlashImage {
    /// A blank one that forgets.
    #[must_use]
    pub fn blank() -> Self {
        Self::of(vec![ERASED; CAPACITY])
    }

    /// One with these contents, which forgets what changes.
    #[must_use]
    pub fn of(cells: Vec<u8>) -> Self {
        Self::holding(cells, None)
    }

    /// The image in a file; a blank one is made where there is none.
    ///
    /// # Errors
    /// [`ImageError`]
    pub fn open(path: &Path) -> Result<Self, ImageError> {
        let failed = |reason| ImageError::File {
            path: path.to_owned(),
            reason,
        };
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(failed)?;
        let mut cells = Vec::new();
        file.read_to_end(&mut cells).map_err(failed)?;
        if cells.is_empty() {
            cells = vec![ERASED; CAPACITY];
            file.write_all(&cells).map_err(failed)?;
        }
        if cells.len() != CAPACITY {
            return Err(ImageError::Length {
                path: path.to_owned(),
                found: cells.len(),
            });
        }
        Ok(Self::holding(cells, Some(file)))
    }

    fn holding(cells: Vec<u8>, file: Option<File>) -> Self {
        Self(Arc::new(Mutex::new(Image { cells, file })))
    }

    fn image(&self) -> MutexGuard<'_, Image> {
        // A write that panicked is as a power cut.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What is in it now.
    #[must_use]
    pub fn cells(&self) -> Vec<u8> {
        self.image().cells.clone()
    }
}

impl Image {
    fn set(&mut self, at: usize, bytes: &[u8]) -> Result<(), FlashError> {
        self.cells[at..at + bytes.len()].copy_from_slice(bytes);
        if let Some(file) = &mut self.file {
            let written = file
                .seek(SeekFrom::Start(at as u64))
                .and_then(|_| file.write_all(bytes));
            written.map_err(|_| FlashError::Other)?;
        }
        Ok(())
    }
}

/// Why an operation failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlashError {
    /// Not at the bounds of words or sectors.
    NotAligned,
    /// Beyond the end.
    OutOfBounds,
    /// A bit cannot be set without erasing, or the file failed.
    Other,
}

impl NorFlashError for FlashError {
    fn kind(&self) -> NorFlashErrorKind {
        match self {
            Self::NotAligned => NorFlashErrorKind::NotAligned,
            Self::OutOfBounds => NorFlashErrorKind::OutOfBounds,
            Self::Other => NorFlashErrorKind::Other,
        }
    }
}

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

impl ErrorType for FlashImage {
    type Error = FlashError;
}

impl ReadNorFlash for FlashImage {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        let at = within(offset, bytes.len(), Self::READ_SIZE)?;
        bytes.copy_from_slice(&self.image().cells[at..at + bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        CAPACITY
    }
}

impl NorFlash for FlashImage {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        let len = to.checked_sub(from).ok_or(FlashError::OutOfBounds)? as usize;
        let at = within(from, len, SECTOR)?;
        self.image().set(at, &vec![ERASED; len])
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        let at = within(offset, bytes.len(), WORD)?;
        let mut image = self.image();
        let cells = &image.cells[at..at + bytes.len()];
        if cells
            .iter()
            .zip(bytes)
            .any(|(cell, new)| cell & new != *new)
        {
            return Err(FlashError::Other);
        }
        image.set(at, bytes)
    }
}
