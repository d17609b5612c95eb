//! The bytes of a map: layout, checks.
//!
//! All numbers are little endian. N is the number of edges of a revolution, B = ⌈N/64⌉ + 1.
//!
//! | offset | bytes | content |
//! | --- | --- | --- |
//! | 0 | 4 | magic `LSEM` |
//! | 4 | 2 | version, 1 |
//! | 6 | 1 | form: 0 full, 1 coarse, 2 phases |
//! | 7 | 1 | s: a byte counts steps of 2⁻ˢ d, 7 to 10 |
//! | 8 | 4 | N, a multiple of 4, 16 to 65 536 |
//! | 12 | 2 | edges from one entry of the base to the next, 64 |
//! | 14 | 2 | fronts known: bit 0 forward, bit 1 backward; other bits 0 |
//! | 16 | 2 × 2 | index front forward, backward: latched count less that of the zero boundary, i16 within ±N |
//! | 20 | 2 × 4 × 2 | phases forward, backward: i16, 2⁻¹⁴ d |
//! | 36 | 6 × 4 | residual, f32 ≥ 0: short waves (d), slope (d/d), curvature (1/d), noise of place (d), noise of time (s); hysteresis (d, of either sign) |
//! | 60 | 4 | length of the image with its checksum |
//! | 64 | 2 B | base: i16, 1/4096 d, at edges 0, 64, 128, …; the last lies at or beyond N (not for phases) |
//! | 64 + 2 B | N | a byte an edge: error in steps + 128 (full only) |
//! | end − 4 | 4 | CRC-32 (ISO-HDLC, as of zip) of all before it |

use core::num::NonZeroU32;

use crc::{CRC_32_ISO_HDLC, Crc, NoTable};

use super::error::MapError;
use super::{BASE_SPACING, EDGES, EXACT_FRAC, EncoderMap, Form, Residual};

pub(super) const MAGIC: [u8; 4] = *b"LSEM";
pub(super) const VERSION: u16 = 1;
pub(super) const HEADER: usize = 64;
const CHECKSUM: usize = 4;
/// Finest and coarsest step of a byte: 2^-s d.
pub(super) const STEP_BITS: (u8, u8) = (7, 10);

/// Runs at start-up over some kilobytes: a table would cost more flash than it is worth.
pub(super) const CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

impl Form {
    pub(super) const fn code(self) -> u8 {
        match self {
            Self::Full => 0,
            Self::Coarse => 1,
            Self::Phases => 2,
        }
    }

    const fn of_code(code: u8) -> Option<Self> {
        match code {
            0 => Some(Self::Full),
            1 => Some(Self::Coarse),
            2 => Some(Self::Phases),
            _ => None,
        }
    }

    /// Entries of the base.
    pub(super) const fn base_entries(self, edges: u32) -> usize {
        match self {
            Self::Phases => 0,
            Self::Full | Self::Coarse => edges.div_ceil(BASE_SPACING).wrapping_add(1) as usize,
        }
    }

    const fn byte_count(self, edges: u32) -> usize {
        match self {
            Self::Full => edges as usize,
            Self::Coarse | Self::Phases => 0,
        }
    }
}

/// Bytes of the image of a map of `edges` edges a revolution.
#[must_use]
pub const fn image_len(edges: u32, form: Form) -> usize {
    HEADER
        .wrapping_add(form.base_entries(edges).wrapping_mul(2))
        .wrapping_add(form.byte_count(edges))
        .wrapping_add(CHECKSUM)
}

/// Reads an image from front to back.
struct Reader<'m> {
    rest: &'m [u8],
    offset: usize,
}

impl<'m> Reader<'m> {
    fn take<const LEN: usize>(&mut self) -> Result<[u8; LEN], MapError> {
        let (head, rest) = self.rest.split_first_chunk().ok_or_else(|| self.cut(LEN))?;
        self.advance(LEN, rest);
        Ok(*head)
    }

    fn slice(&mut self, len: usize) -> Result<&'m [u8], MapError> {
        let (head, rest) = self
            .rest
            .split_at_checked(len)
            .ok_or_else(|| self.cut(len))?;
        self.advance(len, rest);
        Ok(head)
    }

    const fn advance(&mut self, len: usize, rest: &'m [u8]) {
        self.rest = rest;
        self.offset = self.offset.wrapping_add(len);
    }

    const fn cut(&self, len: usize) -> MapError {
        MapError::Cut {
            given: self.offset.wrapping_add(self.rest.len()),
            needed: self.offset.wrapping_add(len),
        }
    }

    fn u8(&mut self) -> Result<u8, MapError> {
        self.take().map(|[byte]: [u8; 1]| byte)
    }

    fn u16(&mut self) -> Result<u16, MapError> {
        self.take().map(u16::from_le_bytes)
    }

    fn i16(&mut self) -> Result<i16, MapError> {
        self.take().map(i16::from_le_bytes)
    }

    fn u32(&mut self) -> Result<u32, MapError> {
        self.take().map(u32::from_le_bytes)
    }

    /// The next field as `read` gives it, where `accept` makes something of it.
    fn field<T, U>(
        &mut self,
        name: &'static str,
        allowed: &'static str,
        read: fn(&mut Self) -> Result<T, MapError>,
        accept: impl FnOnce(T) -> Option<U>,
    ) -> Result<U, MapError> {
        let offset = self.offset;
        accept(read(self)?).ok_or(MapError::Field {
            offset,
            name,
            allowed,
        })
    }

    fn figure(&mut self, name: &'static str, lowest: f32) -> Result<f32, MapError> {
        let accept = |bits| Some(f32::from_bits(bits)).filter(|&v| v >= lowest && v < f32::MAX);
        self.field(name, "a figure, not negative", Self::u32, accept)
    }
}

/// The map of an image.
pub(super) fn parse(image: &[u8]) -> Result<EncoderMap<'_>, MapError> {
    let mut reader = Reader {
        rest: image,
        offset: 0,
    };
    if reader.take()? != MAGIC {
        return Err(MapError::NotAMap);
    }
    let version = reader.u16()?;
    if version != VERSION {
        return Err(MapError::Version { version });
    }
    let form = reader.field("form", "0 to 2", Reader::u8, Form::of_code)?;
    let step_bits = reader.field("step of the bytes", "7 to 10", Reader::u8, |bits| {
        (STEP_BITS.0..=STEP_BITS.1).contains(&bits).then_some(bits)
    })?;
    let edges = reader.field(
        "edges a revolution",
        "a multiple of 4, 16 to 65536",
        Reader::u32,
        checked_edges,
    )?;
    reader.field("spacing of the base", "64", Reader::u16, |spacing| {
        (u32::from(spacing) == BASE_SPACING).then_some(())
    })?;
    let fronts = fronts(&mut reader, edges.get())?;
    let mut phases = [[0; 4]; 2];
    for phase in phases.iter_mut().flatten() {
        *phase = reader.i16()?;
    }
    let residual = Residual {
        short_wave_d: reader.figure("residual of short waves", 0.0)?,
        slope: reader.figure("residual slope", 0.0)?,
        curvature_per_d: reader.figure("residual curvature", 0.0)?,
        noise_d: reader.figure("noise of place", 0.0)?,
        noise_s: reader.figure("noise of time", 0.0)?,
        hysteresis_d: reader.figure("hysteresis", f32::MIN)?,
    };
    let len = image_len(edges.get(), form);
    reader.field(
        "length",
        "what form and edges come to",
        Reader::u32,
        |stated| (stated as usize == len).then_some(()),
    )?;
    let (base, _) = reader
        .slice(form.base_entries(edges.get()).wrapping_mul(2))?
        .as_chunks();
    let bytes = reader.slice(form.byte_count(edges.get()))?;
    let content = image.get(..reader.offset).unwrap_or(image);
    let (stated, computed) = (reader.u32()?, CRC.checksum(content));
    if stated != computed {
        return Err(MapError::Checksum { stated, computed });
    }
    Ok(EncoderMap {
        form,
        edges,
        byte_shift: EXACT_FRAC.wrapping_sub(u32::from(step_bits)),
        phases,
        fronts,
        residual,
        base,
        bytes,
    })
}

/// A number of edges that a revolution may have.
pub(super) fn checked_edges(edges: u32) -> Option<NonZeroU32> {
    let good = (EDGES.0..=EDGES.1).contains(&edges) && edges.is_multiple_of(4);
    NonZeroU32::new(edges).filter(|_| good)
}

fn fronts(reader: &mut Reader<'_>, edges: u32) -> Result<[Option<i16>; 2], MapError> {
    let known = reader.field("fronts known", "bits 0 and 1", Reader::u16, |bits| {
        (bits < 4).then_some(bits)
    })?;
    let mut fronts = [None; 2];
    for (front, bit) in fronts.iter_mut().zip([1, 2]) {
        *front = reader.field("index front", "less than a revolution", Reader::i16, |at| {
            (u32::from(at.unsigned_abs()) < edges).then_some((known & bit != 0).then_some(at))
        })?;
    }
    Ok(fronts)
}
