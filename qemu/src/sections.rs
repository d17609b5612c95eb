//! How much of a board's memory an image takes.

use std::path::Path;

use object::{Object, ObjectSection, SectionFlags, SectionKind};

use crate::Error;

/// Bytes of an image by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sections {
    /// Code and constants.
    pub text: u64,
    /// Statics with a value: in flash and in RAM.
    pub data: u64,
    /// Statics that start at zero: in RAM alone.
    pub bss: u64,
}

impl Sections {
    /// Adds up the sections of an ELF image that are loaded.
    ///
    /// # Errors
    /// The file cannot be read or is no object file.
    pub fn of(image: &Path) -> Result<Self, Error> {
        let path = || image.to_owned();
        let bytes = std::fs::read(image).map_err(|source| Error::File {
            path: path(),
            source,
        })?;
        let file = object::File::parse(&*bytes).map_err(|error| Error::Sections {
            path: path(),
            reason: error.to_string(),
        })?;
        let mut sizes = Self::default();
        for section in file.sections().filter(is_loaded) {
            match section.kind() {
                SectionKind::UninitializedData => sizes.bss += section.size(),
                SectionKind::Data => sizes.data += section.size(),
                _ => sizes.text += section.size(),
            }
        }
        Ok(sizes)
    }
}

fn is_loaded<'data>(section: &impl ObjectSection<'data>) -> bool {
    const ALLOCATED: u64 = 2;
    matches!(section.flags(), SectionFlags::Elf { sh_flags } if sh_flags & ALLOCATED != 0)
}
