//! The store over the link.

use embedded_storage::nor_flash::NorFlash;
use leadscrew::protocol::frame::checksum;
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::Reply;
use leadscrew::settings::Settings;

use super::bench::{Bench, MOST_BYTES};
use super::memory::Lent;
use crate::axis_control::What;
use crate::store::{Error, Interlock, Kind, NotPermitted, Permission, Store};

fn refusal_of<E>(error: &Error<E>) -> Refusal {
    match error {
        Error::Full | Error::TooLarge { .. } => Refusal::StoreFull,
        Error::Map(_) | Error::Points { .. } | Error::Memory { .. } => Refusal::WrongContent,
        Error::Estimator { .. } => Refusal::Inconsistent,
        _ => Refusal::StoreFailed,
    }
}

fn kind_of(number: u8) -> Result<Kind, Refusal> {
    match number {
        1 => Ok(Kind::Parameters),
        2 => Ok(Kind::EncoderMap),
        3 => Ok(Kind::ScrewTable),
        _ => Err(Refusal::UnknownKind),
    }
}

impl<F: NorFlash> Bench<F> {
    /// Works with the store while nobody can enable the axis, in memory that is lent to it.
    fn with_store(
        &mut self,
        work: impl FnOnce(&mut Store<F>, &mut [u8], &Permission<'_>) -> Result<(), Error<F::Error>>,
    ) -> Result<(), Refusal> {
        let interlock: &'static Interlock = self.interlock;
        let permission = interlock.permit(&self.report.record.put_out());
        let permission = permission.map_err(|refused| match refused {
            NotPermitted::Enabled => Refusal::AxisOn,
            NotPermitted::Busy => Refusal::Busy,
        })?;
        let store = self.store.as_mut().ok_or(Refusal::StoreFailed)?;
        let memory = self.lent.bytes().ok_or(Refusal::WorkMemoryLent)?;
        work(store, memory, &permission).map_err(|error| refusal_of(&error))
    }

    pub fn save_parameters(&mut self, settings: &Settings) -> Result<(), Refusal> {
        self.with_store(|store, memory, permission| {
            store.save_params(settings, memory, permission).map(|_| ())
        })?;
        // What is stored is what is in force.
        self.tell(What::StoreCorrupt(false))
    }

    #[inline(never)]
    pub fn save_map(&mut self) -> Result<(), Refusal> {
        let image = self.map.ok_or(Refusal::NotLearning)?;
        self.with_store(|store, _, permission| store.save_map(image, permission).map(|_| ()))
    }

    pub fn stored(&mut self, number: u8) -> Result<Reply<'static>, Refusal> {
        let kind = kind_of(number)?;
        let store = self.store.as_mut().ok_or(Refusal::StoreFailed)?;
        let entry = store.entry(kind).map_err(|error| refusal_of(&error))?;
        Ok(Reply::Stored {
            kind: number,
            version: entry.map_or(0, |entry| entry.version),
            length: entry.map_or(0, |entry| entry.len as u32),
            crc: entry.map_or(0, |entry| entry.crc),
        })
    }

    #[inline(never)]
    pub fn read_stored(
        &mut self,
        kind: u8,
        offset: u32,
        say: &mut dyn FnMut(&Reply<'_>),
    ) -> Result<(), Refusal> {
        let kind = kind_of(kind)?;
        let store = self.store.as_mut().ok_or(Refusal::StoreFailed)?;
        let memory = self.lent.bytes().ok_or(Refusal::WorkMemoryLent)?;
        let read = store
            .read(kind, memory)
            .map_err(|error| refusal_of(&error))?;
        let bytes = read.ok_or(Refusal::NothingStored)?;
        let bytes = bytes.get(offset as usize..).ok_or(Refusal::NothingStored)?;
        let bytes = bytes.get(..MOST_BYTES).unwrap_or(bytes);
        say(&Reply::Bytes { offset, bytes });
        Ok(())
    }

    /// Puts bytes into the work memory, low byte first.
    pub fn write_bytes(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Refusal> {
        let place = self.upload()?;
        let begin = offset as usize;
        let end = begin.checked_add(bytes.len());
        let place = end.and_then(|end| place.get_mut(begin..end));
        place.ok_or(Refusal::WrongContent)?.copy_from_slice(bytes);
        Ok(())
    }

    #[inline(never)]
    pub fn save_bytes(&mut self, kind: u8, length: u32, crc: u32) -> Result<(), Refusal> {
        let kind = kind_of(kind)?;
        if kind == Kind::Parameters {
            // They are set one by one, and validated.
            return Err(Refusal::WrongContent);
        }
        // Out of the way while the store works; nobody else is here meanwhile.
        let work = match core::mem::replace(&mut self.lent, Lent::Nobody) {
            Lent::Free(work) => work,
            other => {
                self.lent = other;
                return Err(Refusal::WorkMemoryLent);
            }
        };
        let all: &[u8] = bytemuck::cast_slice(work.sums);
        let bytes = all.get(..length as usize);
        let bytes = bytes.filter(|bytes| checksum(bytes) == crc);
        let saved = bytes.ok_or(Refusal::WrongChecksum).and_then(|bytes| {
            let interlock: &'static Interlock = self.interlock;
            let permission = interlock
                .permit(&self.report.record.put_out())
                .map_err(|_| Refusal::AxisOn)?;
            let store = self.store.as_mut().ok_or(Refusal::StoreFailed)?;
            let saved = store.restore(kind, bytes, &permission);
            saved.map(|_| ()).map_err(|error| refusal_of(&error))
        });
        self.lent = Lent::Free(work);
        saved
    }

    fn upload(&mut self) -> Result<&mut [u8], Refusal> {
        if self.is_recording {
            return Err(Refusal::WorkMemoryLent);
        }
        if !matches!(self.lent, Lent::Free(_)) {
            let work = self.lent.reclaim().ok_or(Refusal::WorkMemoryLent)?;
            self.lent = Lent::Free(work);
        }
        match &mut self.lent {
            Lent::Free(work) => Ok(bytemuck::cast_slice_mut(work.sums)),
            _ => Err(Refusal::WorkMemoryLent),
        }
    }

    #[inline(never)]
    pub fn erase(&mut self, number: u8) -> Result<(), Refusal> {
        let kind = match number {
            0 => None,
            number => Some(kind_of(number)?),
        };
        self.with_store(|store, _, permission| match kind {
            None => store.erase_all(permission),
            Some(kind) => store.erase(kind, permission),
        })
    }
}
