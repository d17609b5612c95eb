//! The flash of the store: six pieces of 16 KiB, each a sector or the beginning of one.
//!
//! ```text
//! sector     1      2      3     4 ... 8     9        10        11
//! size      16     16     16                128       128       128 KiB
//! store   [log]  [log]  [   ]   program    [   ]····  [   ]····  [   ]····
//! ```
//!
//! The store wants sectors of one size, two for its log of erasures and four for all of its content; there are not so many
//! small ones. Of each large one the first 16 KiB are used. A flashing tool erases the sectors that it writes, and the program
//! ends before the store's upper part, which the linker checks.
//!
//! An erasure stalls the processor, which runs from the same flash: for 2 s at most. So it is refused unless the drive is off and the
//! brake closed, and the watchdog is given a longer period for that time.

use core::sync::atomic::{AtomicBool, Ordering, compiler_fence};

use embassy_stm32::pac::FLASH;
use embassy_stm32::pac::flash::vals::Psize;
use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

use crate::{lines, watchdog};

/// Bytes of a piece.
const PIECE: usize = 16 * 1024;

/// A sector of which the store has the first [`PIECE`].
struct Sector {
    number: u8,
    address: usize,
}

const fn sector(number: u8, address: usize) -> Sector {
    Sector { number, address }
}

const SECTORS: [Sector; 6] = [
    sector(1, 0x0800_4000),
    sector(2, 0x0800_8000),
    sector(3, 0x0800_c000),
    sector(9, 0x080a_0000),
    sector(10, 0x080c_0000),
    sector(11, 0x080e_0000),
];

/// Bytes of the store.
pub const CAPACITY: usize = SECTORS.len() * PIECE;

/// Why the flash was not read, written or erased.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum FlashError {
    /// Not within the store, or not of whole words or sectors.
    Range,
    /// The drive is enabled or the brake released.
    Enabled,
    /// The watchdog did not take the period that outlasts an erasure.
    Watchdog,
    /// The flash says that it failed: its error flags.
    Failed(u32),
}

impl NorFlashError for FlashError {
    fn kind(&self) -> NorFlashErrorKind {
        match self {
            Self::Range => NorFlashErrorKind::OutOfBounds,
            Self::Enabled | Self::Watchdog | Self::Failed(_) => NorFlashErrorKind::Other,
        }
    }
}

/// The flash of the store; there is one.
pub struct Flash(());

static IS_TAKEN: AtomicBool = AtomicBool::new(false);
/// Sectors are being erased.
static IS_BUSY: AtomicBool = AtomicBool::new(false);
/// They were: ticks were missed, and an axis that is off does not mind.
static STALLED: AtomicBool = AtomicBool::new(false);

/// Whether the processor may have stood still for the flash since this was asked last.
pub fn take_stall() -> bool {
    // In this order: it is set before the other one is cleared.
    let is_busy = IS_BUSY.load(Ordering::SeqCst);
    let has_stalled = STALLED.load(Ordering::SeqCst);
    if has_stalled {
        STALLED.store(false, Ordering::SeqCst);
    }
    is_busy || has_stalled
}

impl Flash {
    /// The flash, once.
    pub fn take() -> Option<Self> {
        (!IS_TAKEN.swap(true, Ordering::Relaxed)).then_some(Self(()))
    }
}

/// Address in memory of `len` bytes at `offset` of the store, which are all in one piece.
fn address(offset: usize, len: usize) -> Result<usize, FlashError> {
    let sector = SECTORS.get(offset / PIECE).ok_or(FlashError::Range)?;
    if offset % PIECE + len > PIECE {
        return Err(FlashError::Range);
    }
    Ok(sector.address + offset % PIECE)
}

/// Runs of `range` that lie in one piece each: offset and length.
fn runs(offset: usize, len: usize) -> impl Iterator<Item = (usize, usize)> {
    let end = offset.saturating_add(len);
    let mut at = offset;
    core::iter::from_fn(move || {
        let len = (PIECE - at % PIECE).min(end - at);
        let run = (at, len);
        at += len;
        (len > 0).then_some(run)
    })
}

impl ErrorType for Flash {
    type Error = FlashError;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        let mut rest = bytes;
        for (at, len) in runs(offset as usize, rest.len()) {
            let from = address(at, len)? as *const u8;
            let (now, later) = core::mem::take(&mut rest).split_at_mut(len);
            for (index, byte) in now.iter_mut().enumerate() {
                // SAFETY: within a piece of the store by `address`: flash that can always be read and that no variable of
                // the program lies in (the linker checks). Volatile, as it changes otherwise than by writes.
                *byte = unsafe { from.add(index).read_volatile() };
            }
            rest = later;
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        CAPACITY
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = PIECE;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        let (from, to) = (from as usize, to as usize);
        let is_whole = from.is_multiple_of(PIECE) && to.is_multiple_of(PIECE);
        let sectors = SECTORS.get(from / PIECE..to / PIECE);
        let sectors = sectors.filter(|_| is_whole).ok_or(FlashError::Range)?;
        if !lines::are_released() {
            return Err(FlashError::Enabled);
        }
        watchdog::lengthen().map_err(|_| FlashError::Watchdog)?;
        IS_BUSY.store(true, Ordering::SeqCst);
        let erased = sectors.iter().try_for_each(|sector| {
            watchdog::feed();
            unlocked(|| erase_sector(sector.number))
        });
        STALLED.store(true, Ordering::SeqCst);
        IS_BUSY.store(false, Ordering::SeqCst);
        // Otherwise no axis is enabled any more, which tells.
        watchdog::shorten().map_err(|_| FlashError::Watchdog)?;
        erased
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        let is_whole = offset.is_multiple_of(4) && bytes.len().is_multiple_of(4);
        if !is_whole {
            return Err(FlashError::Range);
        }
        if !lines::are_released() {
            return Err(FlashError::Enabled);
        }
        STALLED.store(true, Ordering::Relaxed);
        let mut rest = bytes;
        for (at, len) in runs(offset as usize, rest.len()) {
            let to = address(at, len)?;
            let (now, later) = rest.split_at(len);
            unlocked(|| write_words(to as *mut u32, now))?;
            rest = later;
        }
        Ok(())
    }
}

/// Works with the flash's control register unlocked, and leaves its caches without what is outdated.
fn unlocked(work: impl FnOnce() -> Result<(), FlashError>) -> Result<(), FlashError> {
    if FLASH.cr().read().lock() {
        FLASH.keyr().write_value(0x4567_0123);
        FLASH.keyr().write_value(0xcdef_89ab);
    }
    // Errors of before: a one clears.
    FLASH.sr().write(|w| w.0 = ERRORS);
    let done = work();
    FLASH.cr().write(|w| w.set_lock(true));
    FLASH.acr().modify(|w| w.set_dcen(false));
    FLASH.acr().modify(|w| w.set_dcrst(true));
    FLASH.acr().modify(|w| {
        w.set_dcrst(false);
        w.set_dcen(true);
    });
    done
}

/// Flags of `FLASH_SR`: operation, write protection, alignment, parallelism, sequence.
const ERRORS: u32 = 0b1111_0010;

fn wait() -> Result<(), FlashError> {
    // The flash ends whatever it does; if it did not, the watchdog would.
    while FLASH.sr().read().bsy() {}
    match FLASH.sr().read().0 & ERRORS {
        0 => Ok(()),
        flags => Err(FlashError::Failed(flags)),
    }
}

fn erase_sector(number: u8) -> Result<(), FlashError> {
    wait()?;
    FLASH.cr().write(|w| {
        w.set_psize(Psize::PSIZE32);
        w.set_ser(true);
        w.set_snb(number);
    });
    FLASH.cr().modify(|w| w.set_strt(true));
    wait()
}

fn write_words(mut to: *mut u32, bytes: &[u8]) -> Result<(), FlashError> {
    wait()?;
    FLASH.cr().write(|w| {
        w.set_psize(Psize::PSIZE32);
        w.set_pg(true);
    });
    let words = bytes.chunks_exact(4).map(|word| {
        let bytes = word.first_chunk().copied().unwrap_or_default();
        u32::from_le_bytes(bytes)
    });
    for word in words {
        compiler_fence(Ordering::SeqCst);
        // SAFETY: a word within a piece of the store (`address`), aligned (offset and length are multiples of four): with PG
        // set a write programs it. No variable of the program lies there.
        unsafe { to.write_volatile(word) };
        to = to.wrapping_add(1);
        wait()?;
    }
    Ok(())
}
