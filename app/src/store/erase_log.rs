//! Erasures that a power cut does not spoil.
//!
//! A cut in the middle of an erasure leaves a sector of which nothing can be told: neither its content nor its marks of
//! being in use. So what is going to be erased is written down before, and struck off after. Whoever finds an entry
//! that is not struck off erases again: the content was given up already, and nothing new is written before the strike.
//!
//! The log has two sectors, used in turns. An entry has [`ENTRY`] bytes, or a word if that is longer: sequence number,
//! address of the sector ([`STRUCK`]: none), CRC-32C of both, all u32, little endian; the rest is 0xFF. The entry with
//! the highest number counts. A sector of the log is erased as it is taken up, when all its entries are outdated by the
//! last one of the other; thus the log needs no log.

use embedded_storage::nor_flash::NorFlash;

use super::CRC;

/// Sectors of the log.
pub(super) const LOG_SECTORS: u32 = 2;
/// Address of no sector.
const STRUCK: u32 = u32::MAX;
const ENTRY: usize = 16;
/// Longest word of a flash that the storage crate takes.
const LONGEST: usize = 32;

/// Where the log stands.
#[derive(Debug)]
pub(super) struct EraseLog {
    start: u32,
    /// Where the next entry goes; the end of a sector if that is full.
    next: u32,
    sequence: u32,
}

impl EraseLog {
    /// Reads the log that begins at `start`, and does again what was cut.
    pub fn mount<F: NorFlash>(flash: &mut F, start: u32) -> Result<Self, F::Error> {
        let sector = F::ERASE_SIZE as u32;
        let mut newest = None;
        // A flash that is new: the first entry takes the first sector up.
        let mut log = Self {
            start,
            next: start + LOG_SECTORS * sector,
            sequence: 0,
        };
        for half in 0..LOG_SECTORS {
            let mut used = start + half * sector;
            let end = used + sector;
            let mut is_newest_here = false;
            for at in (used..end).step_by(Self::entry::<F>()) {
                let mut bytes = [0; LONGEST];
                let bytes = &mut bytes[..Self::entry::<F>()];
                flash.read(at, bytes)?;
                if bytes.iter().all(|byte| *byte == 0xFF) {
                    continue;
                }
                used = at + Self::entry::<F>() as u32;
                let Some((sequence, erased)) = decoded(bytes) else {
                    continue;
                };
                if newest.is_none() || sequence > log.sequence {
                    log.sequence = sequence;
                    newest = Some(erased);
                    is_newest_here = true;
                }
            }
            if is_newest_here {
                log.next = used;
            }
        }
        if let Some(cut) = newest.filter(|address| *address != STRUCK) {
            log.erase(flash, cut)?;
        }
        Ok(log)
    }

    /// Erases the sector at `address`.
    pub fn erase<F: NorFlash>(&mut self, flash: &mut F, address: u32) -> Result<(), F::Error> {
        self.note(flash, address)?;
        flash.erase(address, address + F::ERASE_SIZE as u32)?;
        self.note(flash, STRUCK)
    }

    fn note<F: NorFlash>(&mut self, flash: &mut F, address: u32) -> Result<(), F::Error> {
        let sector = F::ERASE_SIZE as u32;
        if (self.next - self.start).is_multiple_of(sector) {
            // At the end of one, so at the begin of the other.
            let begin = self.start + (self.next - self.start) % (LOG_SECTORS * sector);
            flash.erase(begin, begin + sector)?;
            self.next = begin;
        }
        let at = self.next;
        // Counted before it is written: what a failed write leaves is not blank.
        self.next += Self::entry::<F>() as u32;
        self.sequence = self.sequence.wrapping_add(1);
        let mut bytes = [0xFF; LONGEST];
        bytes[..4].copy_from_slice(&self.sequence.to_le_bytes());
        bytes[4..8].copy_from_slice(&address.to_le_bytes());
        let crc = CRC.checksum(&bytes[..8]);
        bytes[8..12].copy_from_slice(&crc.to_le_bytes());
        flash.write(at, &bytes[..Self::entry::<F>()])
    }

    const fn entry<F: NorFlash>() -> usize {
        ENTRY.next_multiple_of(F::WRITE_SIZE)
    }
}

fn decoded(bytes: &[u8]) -> Option<(u32, u32)> {
    let word = |at: usize| {
        bytes
            .get(at..)?
            .first_chunk()
            .map(|word| u32::from_le_bytes(*word))
    };
    (CRC.checksum(bytes.get(..8)?) == word(8)?).then_some((word(0)?, word(4)?))
}
