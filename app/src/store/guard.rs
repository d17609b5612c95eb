//! The flash as the store sees it: locked unless the axis is off, and with erasures that a power cut does not spoil.

use core::ops::Range;

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use embedded_storage_async::nor_flash as asynchronous;

use super::erase_log::{EraseLog, LOG_SECTORS};

/// Why the flash was not read or written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GuardError<E> {
    /// Nobody gave a permission to write.
    Locked,
    /// The flash failed.
    Flash(E),
}

impl<E: core::fmt::Debug> NorFlashError for GuardError<E> {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

/// A flash with a lock. It is blocking below and never pends above, so that a plain poll drives it.
#[derive(Debug)]
pub(super) struct Guard<F> {
    flash: F,
    log: EraseLog,
    is_open: bool,
}

impl<F: NorFlash> Guard<F> {
    /// Over `range`, whose first sectors are the log's; an erasure that was cut is done again. Locked.
    pub fn mount(mut flash: F, range: &Range<u32>) -> Result<Self, F::Error> {
        let log = EraseLog::mount(&mut flash, range.start)?;
        Ok(Self {
            flash,
            log,
            is_open: false,
        })
    }

    /// What of `range` is left for content.
    pub const fn content(range: &Range<u32>) -> Range<u32> {
        range.start + LOG_SECTORS * F::ERASE_SIZE as u32..range.end
    }

    pub const fn open(&mut self, is_open: bool) {
        self.is_open = is_open;
    }

    pub const fn flash(&mut self) -> &mut F {
        &mut self.flash
    }

    pub fn into_flash(self) -> F {
        self.flash
    }

    const fn unlocked(&mut self) -> Result<&mut F, GuardError<F::Error>> {
        if self.is_open {
            Ok(&mut self.flash)
        } else {
            Err(GuardError::Locked)
        }
    }
}

impl<F: NorFlash> ErrorType for Guard<F> {
    type Error = GuardError<F::Error>;
}

impl<F: NorFlash> asynchronous::ReadNorFlash for Guard<F> {
    const READ_SIZE: usize = <F as ReadNorFlash>::READ_SIZE;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
        self.flash.read(offset, bytes).map_err(GuardError::Flash)
    }

    fn capacity(&self) -> usize {
        self.flash.capacity()
    }
}

impl<F: NorFlash> asynchronous::NorFlash for Guard<F> {
    const WRITE_SIZE: usize = <F as NorFlash>::WRITE_SIZE;
    const ERASE_SIZE: usize = <F as NorFlash>::ERASE_SIZE;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
        self.unlocked()?;
        for sector in (from..to).step_by(F::ERASE_SIZE) {
            self.log
                .erase(&mut self.flash, sector)
                .map_err(GuardError::Flash)?;
        }
        Ok(())
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
        self.unlocked()?
            .write(offset, bytes)
            .map_err(GuardError::Flash)
    }
}
