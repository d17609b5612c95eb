//! The image in an ELF file: what is programmed, and where its symbols are. 32 bits, little endian.

use std::collections::BTreeMap;
use std::fmt;

/// Where the flash begins.
const FLASH: u32 = 0x0800_0000;
/// A segment that is loaded.
const LOAD: u32 = 1;
/// The section of symbols.
const SYMBOLS: u32 = 2;

/// An ELF file.
#[derive(Clone, Debug)]
pub struct Elf {
    segments: Vec<(u32, Vec<u8>)>,
    symbols: BTreeMap<String, (u32, u32)>,
}

/// The file is no ELF of the part.
#[derive(Debug)]
pub struct ElfError(&'static str);

impl fmt::Display for ElfError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no ELF file of the board: {}", self.0)
    }
}

impl std::error::Error for ElfError {}

/// The bytes of a file, bounds checked.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn slice(&self, at: u32, length: u32) -> Result<&'a [u8], ElfError> {
        let (at, length) = (at as usize, length as usize);
        self.0
            .get(at..at.saturating_add(length))
            .ok_or(ElfError("it is cut off"))
    }

    fn word(&self, at: u32) -> Result<u32, ElfError> {
        let bytes = self.slice(at, 4)?;
        Ok(bytes
            .iter()
            .rev()
            .fold(0, |word, &byte| word << 8 | u32::from(byte)))
    }

    fn half(&self, at: u32) -> Result<u32, ElfError> {
        let bytes = self.slice(at, 2)?;
        Ok(u32::from(bytes[0]) | u32::from(bytes[1]) << 8)
    }

    fn name(&self, at: u32) -> Result<String, ElfError> {
        let rest = self
            .0
            .get(at as usize..)
            .ok_or(ElfError("a name is cut off"))?;
        let end = rest
            .iter()
            .position(|&byte| byte == 0)
            .unwrap_or(rest.len());
        Ok(String::from_utf8_lossy(&rest[..end]).into_owned())
    }
}

impl Elf {
    /// Reads a file's content.
    ///
    /// # Errors
    /// It is none.
    pub fn parse(content: &[u8]) -> Result<Self, ElfError> {
        let bytes = Bytes(content);
        if bytes.slice(0, 7)? != b"\x7fELF\x01\x01\x01" {
            return Err(ElfError(
                "it does not begin as a little-endian one of 32 bits",
            ));
        }
        Ok(Self {
            segments: segments(&bytes)?,
            symbols: symbols(&bytes)?,
        })
    }

    /// Programs it into a flash, which is at zero, too, after a reset.
    ///
    /// # Errors
    /// It does not fit.
    pub fn program(&self, flash: &mut [u8]) -> Result<(), ElfError> {
        for (address, content) in &self.segments {
            let from = address.checked_sub(FLASH).unwrap_or(*address) as usize;
            flash
                .get_mut(from..from.saturating_add(content.len()))
                .ok_or(ElfError("a segment is not in flash"))?
                .copy_from_slice(content);
        }
        Ok(())
    }

    /// Address and size of the symbol of that name, or of the only one whose name has it as a part.
    #[must_use]
    pub fn symbol(&self, name: &str) -> Option<(u32, u32)> {
        if let Some(&found) = self.symbols.get(name) {
            return Some(found);
        }
        let mut found = self
            .symbols
            .iter()
            .filter(|(known, _)| known.contains(name));
        let first = found.next();
        first
            .filter(|_| found.next().is_none())
            .map(|(_, &place)| place)
    }
}

/// What is loaded, at the addresses where it is stored.
fn segments(bytes: &Bytes<'_>) -> Result<Vec<(u32, Vec<u8>)>, ElfError> {
    let (table, size, count) = (bytes.word(28)?, bytes.half(42)?, bytes.half(44)?);
    let mut segments = Vec::new();
    for index in 0..count {
        let header = table + index * size;
        let (kind, offset) = (bytes.word(header)?, bytes.word(header + 4)?);
        let (stored_at, length) = (bytes.word(header + 12)?, bytes.word(header + 16)?);
        if kind == LOAD && length > 0 {
            segments.push((stored_at, bytes.slice(offset, length)?.to_vec()));
        }
    }
    Ok(segments)
}

fn symbols(bytes: &Bytes<'_>) -> Result<BTreeMap<String, (u32, u32)>, ElfError> {
    let (table, size, count) = (bytes.word(32)?, bytes.half(46)?, bytes.half(48)?);
    let mut symbols = BTreeMap::new();
    for index in 0..count {
        let section = table + index * size;
        if bytes.word(section + 4)? != SYMBOLS {
            continue;
        }
        let (offset, length) = (bytes.word(section + 16)?, bytes.word(section + 20)?);
        let names = table + bytes.word(section + 24)? * size;
        let names = bytes.word(names + 16)?;
        for entry in (offset..offset + length).step_by(16) {
            let name = bytes.name(names + bytes.word(entry)?)?;
            symbols.insert(name, (bytes.word(entry + 4)?, bytes.word(entry + 8)?));
        }
    }
    Ok(symbols)
}
