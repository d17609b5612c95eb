//! Encoder maps as files: the image that the target keeps, byte for byte.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use leadscrew::encoder_map::EncoderMap;
use leadscrew::encoder_map::error::MapError;
use thiserror::Error;

/// Most bytes that are read: no map is as long, and a wrong file may be of any length.
const MOST_BYTES: u64 = 1 << 20;

/// Why a map file cannot be used.
#[derive(Debug, Error)]
pub enum MapFileError {
    /// It cannot be read.
    #[error("{}: cannot be read ({reason}): check the path and its permissions", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// Why.
        reason: std::io::Error,
    },
    /// It holds no map that can be used.
    #[error("{}: {reason}", file.display())]
    Content {
        /// The file.
        file: PathBuf,
        /// What is wrong and what to do.
        reason: MapError,
    },
}

/// A map file that was read and checked.
#[derive(Clone, Debug)]
pub struct MapFile {
    path: PathBuf,
    image: Vec<u8>,
}

impl MapFile {
    /// Reads and checks the map of a file.
    ///
    /// # Errors
    /// [`MapFileError`] with the file, what is wrong and what to do.
    pub fn read(path: &Path) -> Result<Self, MapFileError> {
        let mut image = Vec::new();
        File::open(path)
            .and_then(|file| file.take(MOST_BYTES).read_to_end(&mut image))
            .map_err(|reason| MapFileError::Read {
                file: path.to_owned(),
                reason,
            })?;
        let file = Self {
            path: path.to_owned(),
            image,
        };
        file.map()?;
        Ok(file)
    }

    /// The map.
    ///
    /// # Errors
    /// None after [`Self::read`], which has checked it.
    pub fn map(&self) -> Result<EncoderMap<'_>, MapFileError> {
        EncoderMap::from_bytes(&self.image).map_err(|reason| MapFileError::Content {
            file: self.path.clone(),
            reason,
        })
    }

    /// Where it was read from.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }
}
