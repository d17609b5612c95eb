//! The bytes of the screw table: for each point its position, i64 in 2⁻¹⁶ d, and its errors forward and backward, i32 in
//! 2⁻²⁰ d each; little endian.

use embedded_storage::nor_flash::NorFlash;
use leadscrew::compensation::table::{POINTS, ScrewError, ScrewPoint};
use leadscrew::units::Position;

use super::{CHUNK, Error, Kind, Permission, Saved, Store};

/// Bytes of a point.
pub const POINT: usize = 16;
// No point lies across two chunks.
const _: () = assert!(CHUNK.is_multiple_of(POINT));
/// Bytes of the longest table.
const MOST_BYTES: usize = POINTS.1 * POINT;

/// The bytes of a point.
#[must_use]
pub fn to_bytes(point: &ScrewPoint) -> [u8; POINT] {
    let [forward, backward] = point.error.map(|error| error.to_bits().to_le_bytes());
    let mut bytes = [0; POINT];
    bytes[..8].copy_from_slice(&point.position.to_bits().to_le_bytes());
    bytes[8..12].copy_from_slice(&forward);
    bytes[12..].copy_from_slice(&backward);
    bytes
}

/// The point of such bytes.
#[must_use]
pub fn of_bytes(bytes: &[u8; POINT]) -> ScrewPoint {
    let [a, b, c, d, e, f, g, h, forward @ .., _, _, _, _] = *bytes;
    let backward = bytes.last_chunk().copied().unwrap_or_default();
    ScrewPoint {
        position: Position::from_bits(i64::from_le_bytes([a, b, c, d, e, f, g, h])),
        error: [forward, backward].map(|error| ScrewError::from_bits(i32::from_le_bytes(error))),
    }
}

impl<F: NorFlash> Store<F> {
    /// Saves the points of the screw table.
    ///
    /// # Errors
    /// Too few points or too many, no room, or the flash failed; the points saved before are still there.
    pub fn save_screw(
        &mut self,
        points: &[ScrewPoint],
        permission: &Permission<'_>,
    ) -> Result<Saved, Error<F::Error>> {
        let count = points.len();
        if !(POINTS.0..=POINTS.1).contains(&count) {
            return Err(Error::Points { count });
        }
        let mut fill = |at: usize, bytes: &mut [u8]| {
            let (places, _) = bytes.as_chunks_mut();
            for (place, point) in places.iter_mut().zip(&points[at / POINT..]) {
                *place = to_bytes(point);
            }
        };
        self.write(Kind::ScrewTable, count * POINT, &mut fill, permission)
    }

    /// The points of the screw table, into `memory`; [`ScrewTable::build`](leadscrew::compensation::table::ScrewTable)
    /// checks them. None if no table was saved. `work` holds their bytes meanwhile: 16 for each point.
    ///
    /// # Errors
    /// As of [`Self::read`].
    pub fn load_screw<'m>(
        &mut self,
        memory: &'m mut [ScrewPoint],
        work: &mut [u8],
    ) -> Result<Option<&'m [ScrewPoint]>, Error<F::Error>> {
        let kind = Kind::ScrewTable;
        let Some(bytes) = self.read(kind, work)? else {
            return Ok(None);
        };
        let (found, rest) = bytes.as_chunks();
        if !rest.is_empty() || bytes.len() > MOST_BYTES {
            return Err(Error::Damaged { kind });
        }
        let (given, needed) = (memory.len(), found.len());
        let Some(memory) = memory.get_mut(..needed) else {
            return Err(Error::Memory {
                kind,
                given,
                needed,
            });
        };
        for (place, bytes) in memory.iter_mut().zip(found) {
            *place = of_bytes(bytes);
        }
        Ok(Some(memory))
    }
}
