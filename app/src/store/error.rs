//! What may go wrong with the store.

use core::fmt;

use leadscrew::compensation::table::POINTS;
use leadscrew::encoder_map::error::MapError;
use sequential_storage::Error as StorageError;

use super::Kind;
use super::guard::GuardError;

/// Why the store did not do as asked; `E` is the flash driver's error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Error<E> {
    /// The flash failed.
    Flash(E),
    /// The range cannot be a store's.
    Range,
    /// The store is to be repaired, which takes a permission to write.
    NeedsRepair,
    /// What is in the range is no store, and cannot be made one without loss.
    Corrupted,
    /// There is no room; what was there is still there.
    Full,
    /// The content's checksum is wrong, or a part is missing.
    Damaged {
        /// What is damaged.
        kind: Kind,
    },
    /// A newer firmware wrote it.
    Newer {
        /// What it wrote.
        kind: Kind,
        /// Version of its format.
        version: u16,
    },
    /// More than a content may hold.
    TooLarge {
        /// Of what.
        kind: Kind,
        /// Bytes given.
        len: usize,
        /// Bytes that may be.
        most: usize,
    },
    /// The memory lent is too small.
    Memory {
        /// For what.
        kind: Kind,
        /// Places given: bytes, or points of the screw table.
        given: usize,
        /// Places needed.
        needed: usize,
    },
    /// This is no encoder map.
    Map(MapError),
    /// A screw table with that many points.
    Points {
        /// How many.
        count: usize,
    },
    /// The estimator's parameters are others than its name and the settings tell.
    Estimator {
        /// The estimator.
        name: &'static str,
    },
}

impl<E> From<StorageError<GuardError<E>>> for Error<E> {
    fn from(error: StorageError<GuardError<E>>) -> Self {
        match error {
            StorageError::Storage {
                value: GuardError::Flash(error),
                ..
            } => Self::Flash(error),
            StorageError::Storage {
                value: GuardError::Locked,
                ..
            } => Self::NeedsRepair,
            StorageError::FullStorage => Self::Full,
            // The others are mistakes about sizes, which are constants here, or items that are no items.
            _ => Self::Corrupted,
        }
    }
}

impl<E: fmt::Debug> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flash(error) => write!(f, "the flash failed: {error:?}"),
            Self::Range => f.write_str(
                "the range of the store does not fit the flash: it must begin and end at a sector and hold five \
                 sectors or more",
            ),
            Self::NeedsRepair => {
                f.write_str("the store needs repair: disable the axis and mount the store anew")
            }
            Self::Corrupted => {
                f.write_str("the store cannot be read: erase it and restore a backup")
            }
            Self::Full => {
                f.write_str("the store is full, nothing was changed: give it more sectors")
            }
            Self::Damaged { kind } => write!(
                f,
                "the stored {kind} is damaged and was not taken: save it anew or restore a backup"
            ),
            Self::Newer { kind, version } => write!(
                f,
                "the stored {kind} has format {version}, this firmware knows up to {}: update the firmware, or erase \
                 the {kind}",
                kind.version()
            ),
            Self::TooLarge { kind, len, most } => {
                write!(f, "the {kind} has {len} bytes: allowed up to {most}")
            }
            Self::Memory {
                kind,
                given,
                needed,
            } => write!(
                f,
                "the {kind} needs room for {needed}, there is room for {given}"
            ),
            Self::Map(error) => error.fmt(f),
            Self::Points { count } => write!(
                f,
                "the screw table has {count} points: allowed {} to {}",
                POINTS.0, POINTS.1
            ),
            Self::Estimator { name } => write!(
                f,
                "the parameters of the estimator {name} are not those that the store knows it by: choose it by name, \
                 the observer by its parameters"
            ),
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Error<E> {}
