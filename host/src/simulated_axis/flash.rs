//! The flash of a simulated axis: an image in memory, and a file that keeps it.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

pub use leadscrew_hal_mock::flash::CAPACITY;
use leadscrew_hal_mock::flash::{Cells, ERASED, NotKept};

/// The cells of a flash. Clones are the same ones, as an axis that is switched on again finds them; the board in QEMU reads
/// the same images.
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

impl Cells for FlashImage {
    fn look<R>(&self, look: impl FnOnce(&[u8]) -> R) -> R {
        look(&self.image().cells)
    }

    fn set(&mut self, offset: usize, new: &[u8]) -> Result<(), NotKept> {
        let mut image = self.image();
        if let Some(file) = &mut image.file {
            let written = file
                .seek(SeekFrom::Start(offset as u64))
                .and_then(|_| file.write_all(new));
            written.map_err(|_| NotKept)?;
        }
        image.cells[offset..][..new.len()].copy_from_slice(new);
        Ok(())
    }
}
