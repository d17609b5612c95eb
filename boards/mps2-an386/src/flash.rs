//! A NOR flash: cells in memory, and a file of the host that keeps them when QEMU ends.
//!
//! [`leadscrew_hal_mock::flash`] says what may be written and erased. Every word is in the file before
//! the next one, so killing QEMU at any moment is a power cut.

use core::ffi::CStr;

use heapless::Vec;
pub use leadscrew_hal_mock::flash::CAPACITY;
use leadscrew_hal_mock::flash::{Cells, ERASED, NotKept, SimulatedFlash};
use semihosting::fs::{File, OpenOptions};
use semihosting::io::{self, Read, Seek, SeekFrom, Write};
use static_cell::ConstStaticCell;

const LONGEST_PATH: usize = 256;

static CELLS: ConstStaticCell<[u8; CAPACITY]> = ConstStaticCell::new([0; CAPACITY]);

/// The flash of the board.
pub type Flash = SimulatedFlash<FileCells>;

/// Its cells.
pub struct FileCells {
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

/// The flash in the file `path`, which is made if it is not there; without a path one that forgets.
///
/// # Errors
/// The file cannot be had, or is another one.
///
/// # Panics
/// On the second call.
pub fn open(path: Option<&str>) -> Result<Flash, OpenError> {
    let cells = CELLS.take();
    cells.fill(ERASED);
    let Some(path) = path else {
        return Ok(SimulatedFlash(FileCells { cells, file: None }));
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
    Ok(SimulatedFlash(FileCells {
        cells,
        file: Some(file),
    }))
}

impl Cells for FileCells {
    fn look<R>(&self, look: impl FnOnce(&[u8]) -> R) -> R {
        look(self.cells)
    }

    fn set(&mut self, offset: usize, new: &[u8]) -> Result<(), NotKept> {
        if let Some(file) = &mut self.file {
            file.seek(SeekFrom::Start(offset as u64))
                .and_then(|_| file.write_all(new))
                .map_err(|_| NotKept)?;
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
