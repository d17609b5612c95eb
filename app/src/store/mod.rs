//! What an axis keeps without power: its parameters, its encoder map, its screw table. `docs/store.md` has the layout.
//!
//! ```text
//! Settings ─► set: named values ─┐
//! EncoderMap image ──────────────┼─► blob: chunks in two slots, one record that switches
//! ScrewPoints ─► screw ──────────┘      │
//!                                       ▼
//!                         sequential-storage: items over sectors, wear spread
//!                                       ▼
//!                   guard: locked while the axis is enabled ─► erase_log ─► NorFlash
//! ```
//!
//! A save is whole or has not happened, wherever the power is cut. Nothing here belongs into the tick: calls block
//! until the flash is done, and are refused while the axis is enabled ([`Interlock`]).

mod blob;
mod erase_log;
mod error;
mod guard;
mod interlock;
mod record;
mod report;
pub mod screw;
mod set;
mod settings;

use core::fmt;
use core::ops::Range;

use crc::{CRC_32_ISCSI, Crc, NoTable};
use embassy_futures::block_on;
use embedded_storage::nor_flash::NorFlash;
use leadscrew::encoder_map::EncoderMap;
use sequential_storage::cache::{Cache, Uncached};
use sequential_storage::map::{MapConfig, MapStorage};

pub use error::Error;
pub use guard::GuardError;
pub use interlock::{Interlock, NotPermitted, Permission};
pub use record::Entry;
pub use report::{Finding, Report, Source};
pub use set::{SetEntry, Value};
pub use settings::SET_BYTES;

use guard::Guard;

/// Runs outside the tick over some kilobytes: a table would cost more flash than it is worth. Not the polynomial that
/// encoder maps end with: with that one all of them would have the same checksum.
const CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISCSI);
/// Bytes of a chunk of a content.
const CHUNK: usize = 512;
/// A chunk, its key, and up to the longest word.
const BUFFER: usize = CHUNK + 32;

/// What is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The settings.
    Parameters,
    /// The encoder map.
    EncoderMap,
    /// The screw table.
    ScrewTable,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Parameters, Self::EncoderMap, Self::ScrewTable];

    /// Version of its format that is written, and the newest that is read.
    #[must_use]
    pub const fn version(self) -> u16 {
        1
    }

    /// It was measured on this very machine: a backup leaves it apart unless asked, lest it come to another machine.
    #[must_use]
    pub const fn is_calibration(self) -> bool {
        matches!(self, Self::EncoderMap | Self::ScrewTable)
    }

    /// In keys, 1 to 15; never used anew.
    const fn number(self) -> u16 {
        match self {
            Self::Parameters => 1,
            Self::EncoderMap => 2,
            Self::ScrewTable => 3,
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Parameters => "set of parameters",
            Self::EncoderMap => "encoder map",
            Self::ScrewTable => "screw table",
        })
    }
}

/// What came of a save.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Saved {
    /// It was written and read back.
    Written,
    /// The same was there already: the flash was spared.
    Unchanged,
}

type Map<F> = MapStorage<u16, Guard<F>, Cache<Uncached, Uncached, Uncached, u16>>;

/// The store in a range of a flash.
pub struct Store<F: NorFlash> {
    map: Map<F>,
    buffer: [u8; BUFFER],
}

impl<F: NorFlash> Store<F> {
    /// The store in `range` of `flash`: two sectors for the log of erasures, three or more for content. A blank range
    /// is an empty store. What a power cut left behind is put in order.
    ///
    /// # Errors
    /// The range does not fit, its content is beyond repair, or the flash failed.
    pub fn mount(
        flash: F,
        range: Range<u32>,
        permission: &Permission<'_>,
    ) -> Result<Self, Error<F::Error>> {
        let least = 5 * F::ERASE_SIZE as u64;
        let is_within = u64::from(range.end) <= flash.capacity() as u64;
        let len = u64::from(range.end.saturating_sub(range.start));
        if !is_within || len < least {
            return Err(Error::Range);
        }
        let config = MapConfig::try_new(Guard::<F>::content(&range)).map_err(|_| Error::Range)?;
        let guard = Guard::mount(flash, &range).map_err(Error::Flash)?;
        let mut store = Self {
            map: MapStorage::new(guard, config, Cache::new_uncached()),
            buffer: [0; BUFFER],
        };
        // Looks through all sectors, and repairs.
        store.unlocked(permission, |store| {
            Kind::ALL
                .iter()
                .try_for_each(|kind| store.record(*kind).map(|_| ()))
        })?;
        Ok(store)
    }

    /// What is there of `kind`, unread; none if it was never saved, or erased.
    ///
    /// # Errors
    /// The flash failed.
    pub fn entry(&mut self, kind: Kind) -> Result<Option<Entry>, Error<F::Error>> {
        Ok(self.record(kind)?.filter(|entry| entry.len > 0))
    }

    /// What a backup holds: the calibration only where asked for.
    ///
    /// # Errors
    /// The flash failed.
    pub fn entries(
        &mut self,
        with_calibration: bool,
    ) -> impl Iterator<Item = Result<Entry, Error<F::Error>>> {
        Kind::ALL
            .into_iter()
            .filter(move |kind| with_calibration || !kind.is_calibration())
            .filter_map(|kind| self.entry(kind).transpose())
    }

    /// Saves an encoder map.
    ///
    /// # Errors
    /// `image` is no map, no room, or the flash failed; the map saved before is still there.
    pub fn save_map(
        &mut self,
        image: &[u8],
        permission: &Permission<'_>,
    ) -> Result<Saved, Error<F::Error>> {
        EncoderMap::from_bytes(image).map_err(Error::Map)?;
        self.write_bytes(Kind::EncoderMap, image, permission)
    }

    /// The encoder map, in `memory`; none if none was saved.
    ///
    /// # Errors
    /// As of [`Self::read`], or what was read is no map.
    pub fn load_map<'m>(
        &mut self,
        memory: &'m mut [u8],
    ) -> Result<Option<EncoderMap<'m>>, Error<F::Error>> {
        let image = self.read(Kind::EncoderMap, memory)?;
        image
            .map(EncoderMap::from_bytes)
            .transpose()
            .map_err(Error::Map)
    }

    /// Saves the bytes of a backup, as [`Self::read`] gave them; what they say is checked where it is loaded, the
    /// encoder map here.
    ///
    /// # Errors
    /// They are too many, or no map, no room, or the flash failed; what was saved before is still there.
    pub fn restore(
        &mut self,
        kind: Kind,
        bytes: &[u8],
        permission: &Permission<'_>,
    ) -> Result<Saved, Error<F::Error>> {
        match kind {
            Kind::EncoderMap => self.save_map(bytes, permission),
            Kind::Parameters | Kind::ScrewTable => self.write_bytes(kind, bytes, permission),
        }
    }

    fn write_bytes(
        &mut self,
        kind: Kind,
        image: &[u8],
        permission: &Permission<'_>,
    ) -> Result<Saved, Error<F::Error>> {
        let mut fill =
            |at: usize, bytes: &mut [u8]| bytes.copy_from_slice(&image[at..at + bytes.len()]);
        self.write(kind, image.len(), &mut fill, permission)
    }

    /// Erases everything, also what is beyond repair.
    ///
    /// # Errors
    /// The flash failed.
    pub fn erase_all(&mut self, permission: &Permission<'_>) -> Result<(), Error<F::Error>> {
        self.unlocked(permission, |store| Ok(block_on(store.map.erase_all())?))
    }

    /// Makes a blank store of a range that cannot be mounted.
    ///
    /// # Errors
    /// The range does not fit, or the flash failed.
    pub fn format(
        mut flash: F,
        range: Range<u32>,
        permission: &Permission<'_>,
    ) -> Result<Self, Error<F::Error>> {
        flash.erase(range.start, range.end).map_err(Error::Flash)?;
        Self::mount(flash, range, permission)
    }

    /// The flash, as it is now.
    pub fn flash(&mut self) -> &mut F {
        self.map.flash().flash()
    }

    /// Gives the flash back.
    pub fn into_flash(self) -> F {
        self.map.destroy().0.into_flash()
    }

    fn unlocked<T>(
        &mut self,
        _: &Permission<'_>,
        work: impl FnOnce(&mut Self) -> Result<T, Error<F::Error>>,
    ) -> Result<T, Error<F::Error>> {
        self.map.flash().open(true);
        let done = work(self);
        self.map.flash().open(false);
        done
    }
}
