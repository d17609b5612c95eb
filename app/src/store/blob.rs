//! Contents in chunks: written aside, read back, then switched to by one record.
//!
//! A content has two slots. Its record tells which of them holds it, and its length and checksum; a new content goes
//! to the other slot. So the old one is whole until the record is written, and the new one from then on.

use embassy_futures::block_on;
use embedded_storage::nor_flash::NorFlash;

use super::record::{Entry, MOST_BYTES, MOST_CHUNKS, RECORD, chunk_key, record_key};
use super::{CHUNK, CRC, Error, Kind, Map, Permission, Saved, Store};

/// Writes the bytes of a content from an offset on.
pub(super) type Fill<'f> = dyn FnMut(usize, &mut [u8]) + 'f;

impl<F: NorFlash> Store<F> {
    /// The record of a content, erased ones (of length 0) included.
    pub(super) fn record(&mut self, kind: Kind) -> Result<Option<Entry>, Error<F::Error>> {
        let fetched = block_on(
            self.map
                .fetch_item::<[u8; RECORD]>(&mut self.buffer, &record_key(kind)),
        )?;
        Ok(fetched.map(|record| Entry::of_record(kind, record)))
    }

    /// Saves `len` bytes, unless they are there already.
    pub(super) fn write(
        &mut self,
        kind: Kind,
        len: usize,
        fill: &mut Fill<'_>,
        permission: &Permission<'_>,
    ) -> Result<Saved, Error<F::Error>> {
        if len > MOST_BYTES {
            return Err(Error::TooLarge {
                kind,
                len,
                most: MOST_BYTES,
            });
        }
        let before = self.record(kind)?;
        let is_newer = |entry: &Entry| entry.len > 0 && entry.version > kind.version();
        if let Some(Entry { version, .. }) = before.filter(is_newer) {
            return Err(Error::Newer { kind, version });
        }
        let after = Entry::after(before, kind, len, checksum(len, fill));
        if let Some(before) = before
            && (before.version, before.len, before.crc) == (after.version, after.len, after.crc)
            && self.is_there(&before, fill)?
        {
            return Ok(Saved::Unchanged);
        }
        if !after.fits(before) && !self.has_room(&after)? {
            return Err(Error::Full);
        }
        self.unlocked(permission, |store| {
            if !after.fits(before) {
                store.reserve(before, &after)?;
            }
            store.write_chunks(&after, fill)?;
            store.check(&after)?;
            store.switch(&after)
        })?;
        Ok(Saved::Written)
    }

    /// Tells what is going to take room, lest a cut leaves room taken that nobody knows of.
    fn reserve(&mut self, before: Option<Entry>, after: &Entry) -> Result<(), Error<F::Error>> {
        let none = Entry {
            len: 0,
            generation: 0,
            ..*after
        };
        let chunks = after.chunks;
        self.switch(&before.map_or(none, |before| Entry { chunks, ..before }))
    }

    /// Whether there is room for all contents with `entry` among them. A sector may stay free of less than a chunk, and
    /// one is kept blank.
    fn has_room(&mut self, entry: &Entry) -> Result<bool, Error<F::Error>> {
        let item = Self::item(CHUNK);
        let mut taken = 0;
        for kind in Kind::ALL {
            let other = self.record(kind)?.filter(|other| other.kind != entry.kind);
            let known = if kind == entry.kind {
                Some(*entry)
            } else {
                other
            };
            let chunks = known.map_or([0; 2], |entry| entry.chunks);
            taken += chunks
                .map(|chunks| usize::from(chunks) * item)
                .iter()
                .sum::<usize>();
            taken += Self::item(RECORD);
        }
        let range = self.map.flash_range();
        let sectors = (range.end - range.start) as usize / F::ERASE_SIZE;
        let marks = 2 * F::WRITE_SIZE.max(F::READ_SIZE);
        let room = F::ERASE_SIZE.saturating_sub(marks + item);
        Ok(taken <= (sectors - 1) * room)
    }

    /// Bytes that an item of `len` bytes takes.
    fn item(len: usize) -> usize {
        let word = F::WRITE_SIZE.max(F::READ_SIZE);
        Map::<F>::item_overhead_size() as usize + (size_of::<u16>() + len).next_multiple_of(word)
    }

    fn write_chunks(&mut self, entry: &Entry, fill: &mut Fill<'_>) -> Result<(), Error<F::Error>> {
        let mut chunk = [0; CHUNK];
        for number in 0..entry.used() {
            let at = number * CHUNK;
            let bytes = &mut chunk[..CHUNK.min(entry.len - at)];
            fill(at, bytes);
            self.put(chunk_key(entry.kind, entry.slot, number), bytes)?;
        }
        Ok(())
    }

    fn switch(&mut self, entry: &Entry) -> Result<(), Error<F::Error>> {
        self.put(record_key(entry.kind), &entry.to_record())
    }

    fn put(&mut self, key: u16, bytes: &[u8]) -> Result<(), Error<F::Error>> {
        Ok(block_on(self.map.store_item(
            &mut self.buffer,
            &key,
            &bytes,
        ))?)
    }

    /// Reads every chunk, and hands it to `take` with its offset; at the end the checksum tells.
    fn read_chunks(
        &mut self,
        entry: &Entry,
        mut take: impl FnMut(usize, &[u8]),
    ) -> Result<(), Error<F::Error>> {
        let damaged = Error::Damaged { kind: entry.kind };
        let mut digest = CRC.digest();
        for number in 0..entry.used() {
            let at = number * CHUNK;
            let key = chunk_key(entry.kind, entry.slot, number);
            let fetched = block_on(self.map.fetch_item::<&[u8]>(&mut self.buffer, &key))?;
            let bytes = fetched.unwrap_or_default();
            if bytes.len() != CHUNK.min(entry.len - at) {
                return Err(damaged);
            }
            digest.update(bytes);
            take(at, bytes);
        }
        if digest.finalize() == entry.crc {
            Ok(())
        } else {
            Err(damaged)
        }
    }

    /// Whether the content is that of `fill`, byte for byte; not if it is damaged.
    fn is_there(&mut self, entry: &Entry, fill: &mut Fill<'_>) -> Result<bool, Error<F::Error>> {
        let mut is_same = true;
        let mut chunk = [0; CHUNK];
        let read = self.read_chunks(entry, |at, bytes| {
            let chunk = &mut chunk[..bytes.len()];
            fill(at, chunk);
            is_same &= chunk == bytes;
        });
        match read {
            Err(Error::Damaged { .. }) => Ok(false),
            read => read.map(|()| is_same),
        }
    }

    fn check(&mut self, entry: &Entry) -> Result<(), Error<F::Error>> {
        self.read_chunks(entry, |_, _| {})
    }

    /// The bytes of a content, into `memory`; none if there is no such content.
    ///
    /// # Errors
    /// Damage, a newer format, too little memory, or the flash failed. Then `memory` holds nothing of use.
    pub fn read<'m>(
        &mut self,
        kind: Kind,
        memory: &'m mut [u8],
    ) -> Result<Option<&'m [u8]>, Error<F::Error>> {
        let Some(entry) = self.entry(kind)? else {
            return Ok(None);
        };
        let (version, needed, given) = (entry.version, entry.len, memory.len());
        if version > kind.version() {
            return Err(Error::Newer { kind, version });
        }
        let Some(memory) = memory.get_mut(..needed) else {
            return Err(Error::Memory {
                kind,
                given,
                needed,
            });
        };
        self.read_chunks(&entry, |at, bytes| {
            memory[at..at + bytes.len()].copy_from_slice(bytes);
        })?;
        Ok(Some(memory))
    }

    /// Takes a content out; what is read of it from then on is none.
    ///
    /// # Errors
    /// The flash failed.
    pub fn erase(
        &mut self,
        kind: Kind,
        permission: &Permission<'_>,
    ) -> Result<(), Error<F::Error>> {
        let Some(before) = self.record(kind)? else {
            return Ok(());
        };
        if before.len == 0 && before.chunks == [0; 2] {
            return Ok(());
        }
        let after = Entry {
            generation: before.generation.wrapping_add(1),
            len: 0,
            crc: checksum(0, &mut |_, _| {}),
            ..before
        };
        self.unlocked(permission, |store| {
            store.switch(&after)?;
            // The chunks give their room back.
            store.empty(kind, 0)?;
            store.empty(kind, 1)?;
            store.switch(&Entry {
                chunks: [0; 2],
                ..after
            })
        })
    }

    fn empty(&mut self, kind: Kind, slot: u8) -> Result<(), Error<F::Error>> {
        for chunk in 0..MOST_CHUNKS {
            let key = chunk_key(kind, slot, chunk);
            match block_on(self.map.fetch_item::<&[u8]>(&mut self.buffer, &key))? {
                // They are numbered without gaps.
                None => break,
                Some([]) => {}
                Some(_) => self.put(key, &[])?,
            }
        }
        Ok(())
    }
}

fn checksum(len: usize, fill: &mut Fill<'_>) -> u32 {
    let mut digest = CRC.digest();
    let mut chunk = [0; CHUNK];
    for at in (0..len).step_by(CHUNK) {
        let bytes = &mut chunk[..CHUNK.min(len - at)];
        fill(at, bytes);
        digest.update(bytes);
    }
    digest.finalize()
}
