//! The encoder map: where each edge of a revolution really lies.
//!
//! An encoder's edges lie beside their places by a tenth of a discrete and more, the same way in every
//! revolution. An [`EncoderMap`] is a view of a byte image (flash or file) that says by how much, for each
//! edge and for either direction; [`tie`] finds by the index pulse which edge is which; [`format`] is the
//! image itself, [`encode`] makes it from measured errors, [`error`] says what kept it from that; [`check`] tells
//! whether a map belongs to the encoder that turns.
//!
//! Boundary k of the count, passed in direction D, lies at k + e d with e the sum of
//!
//! - the base: what changes slowly round the revolution (eccentricity), linear between entries every
//!   [`BASE_SPACING`] edges; it is 0 at edge 0, so that a position does not jump by the eccentricity when the
//!   index is found;
//! - a byte for the edge itself;
//! - the phase: one of four values that repeat with the lines, for either direction (duty, hysteresis).
//!
//! A map without index has phases alone, one for small memories phases and base. Before the index is
//! found the phases of any map hold all the same, since the two low bits of the count tell the phase.

pub mod check;
pub mod encode;
pub mod error;
pub mod format;
pub mod tie;

use core::num::NonZeroU32;

use self::error::MapError;

/// Edges from one entry of the base to the next.
pub const BASE_SPACING: u32 = 64;
/// Edges of a revolution (x4) that a map may have; a multiple of four.
pub const EDGES: (u32, u32) = (16, 65_536);
/// Most edges of one [`EncoderMap::sum`].
pub const MAX_SUM: u32 = crate::capture::MAX_DELTA.unsigned_abs();

/// Which way an edge is passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Towards larger counts.
    Forward,
    /// Towards smaller counts.
    Backward,
}

impl Direction {
    /// Of a motion by `delta` counts, which is not 0.
    #[must_use]
    pub const fn of(delta: i32) -> Self {
        if delta < 0 {
            Self::Backward
        } else {
            Self::Forward
        }
    }

    /// The one of a pair forward, backward.
    pub(crate) const fn of_pair<T>(self, pair: &[T; 2]) -> &T {
        let [forward, backward] = pair;
        match self {
            Self::Forward => forward,
            Self::Backward => backward,
        }
    }
}

/// How much a map knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Phases, base and a byte an edge.
    Full,
    /// Phases and base: the long waves of a revolution, for small memories.
    Coarse,
    /// Phases alone: no index needed.
    Phases,
}

/// What a map leaves, as its learning found it; for the uncertainty of estimates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// Short waves, standard deviation at an edge, d.
    pub short_wave_d: f32,
    /// Long waves: rms slope of what they leave, d a d.
    pub slope: f32,
    /// Long waves: rms curvature of what they leave, 1/d.
    pub curvature_per_d: f32,
    /// Noise of an edge's place, d.
    pub noise_d: f32,
    /// Noise of an edge's time, s.
    pub noise_s: f32,
    /// How much lower a backward edge lies, mean of the four phases, d.
    pub hysteresis_d: f32,
}

/// A map: a view of a checked image. An edge number counts the boundaries from the zero boundary on, from 0 to
/// below [`EncoderMap::edges`].
#[derive(Clone, Copy, Debug)]
pub struct EncoderMap<'m> {
    form: Form,
    edges: NonZeroU32,
    /// From a byte to [`EXACT_FRAC`].
    byte_shift: u32,
    /// Units of 2⁻¹⁴ d; forward, backward.
    phases: [[i16; 4]; 2],
    fronts: [Option<i16>; 2],
    residual: Residual,
    /// Units of 1/4096 d, little endian.
    base: &'m [[u8; 2]],
    /// Offset by [`BYTE_ZERO`].
    bytes: &'m [u8],
}

/// Fractional bits in which all parts of an error are exact: an entry of the base in 1/4096 d over 64 edges.
const EXACT_FRAC: u32 = 18;
const BASE_FRAC: u32 = 12;
const PHASE_FRAC: u32 = 14;
const ERROR_FRAC: u32 = 16;
/// The byte that stands for 0: sums of unsigned bytes take half the instructions.
const BYTE_ZERO: u8 = 128;

impl<'m> EncoderMap<'m> {
    /// The map of an image; what lies behind its end is not looked at.
    ///
    /// # Errors
    /// [`MapError`] for an image that is no map, of another version, cut off, damaged or out of range.
    pub fn from_bytes(image: &'m [u8]) -> Result<Self, MapError> {
        format::parse(image)
    }

    /// How much it knows.
    #[must_use]
    pub const fn form(&self) -> Form {
        self.form
    }

    /// Edges of a revolution.
    #[must_use]
    pub const fn edges(&self) -> u32 {
        self.edges.get()
    }

    /// What it leaves.
    #[must_use]
    pub const fn residual(&self) -> &Residual {
        &self.residual
    }

    /// Count that the index latches in this direction, less that of the zero boundary, if it was learned; a map
    /// of phases alone has none.
    #[must_use]
    pub const fn front(&self, direction: Direction) -> Option<i16> {
        match self.form {
            Form::Phases => None,
            Form::Full | Form::Coarse => *direction.of_pair(&self.fronts),
        }
    }

    /// Error of an edge, Q.16 d, to nearest.
    #[must_use]
    pub fn error(&self, edge: u32, direction: Direction) -> i32 {
        let byte = self.bytes.get(edge as usize);
        let byte = byte.map_or(0, |byte| self.bytes_exact(u32::from(*byte), 1));
        let phase = self.phase_exact(edge, direction);
        to_error(i64::from(
            self.base_exact(edge).wrapping_add(byte).wrapping_add(phase),
        ))
    }

    /// Errors of `count` edges from `first` on upwards, through the end of the revolution, added up, Q.16 d, to
    /// nearest. Up to [`MAX_SUM`] edges the sum fits.
    #[must_use]
    #[inline]
    pub fn sum(&self, first: u32, count: u32, direction: Direction) -> i32 {
        let mut total = i64::from(self.phase_sum_exact(first, count, direction));
        let mut first = first % self.edges;
        let mut left = count;
        while left != 0 {
            let run = left.min(self.edges().wrapping_sub(first));
            total = total
                .wrapping_add(self.base_sum_exact(first, run))
                .wrapping_add(i64::from(self.byte_sum_exact(first, run)));
            left = left.wrapping_sub(run);
            first = 0;
        }
        to_error(total)
    }

    /// Error of a boundary whose phase alone is known, Q.16 d; `phase` counts modulo 4.
    #[must_use]
    pub fn phase_error(&self, phase: u32, direction: Direction) -> i32 {
        to_error(i64::from(self.phase_exact(phase, direction)))
    }

    /// Errors of `count` boundaries from one of phase `first` on upwards, added up, Q.16 d. Up to [`MAX_SUM`]
    /// boundaries the sum fits.
    #[must_use]
    pub fn phase_sum(&self, first: u32, count: u32, direction: Direction) -> i32 {
        to_error(i64::from(self.phase_sum_exact(first, count, direction)))
    }

    fn phase_exact(&self, phase: u32, direction: Direction) -> i32 {
        let phases = direction.of_pair(&self.phases);
        let value = phases.get((phase & 3) as usize).copied();
        i32::from(value.unwrap_or(0)).wrapping_shl(EXACT_FRAC.wrapping_sub(PHASE_FRAC))
    }

    /// Whole lines at once, then the edges left over.
    fn phase_sum_exact(&self, first: u32, count: u32, direction: Direction) -> i32 {
        let phases = direction.of_pair(&self.phases);
        let line = phases
            .iter()
            .fold(0_i32, |sum, value| sum.wrapping_add(i32::from(*value)));
        let lines = line
            .wrapping_mul(count.wrapping_shr(2).cast_signed())
            .wrapping_shl(EXACT_FRAC.wrapping_sub(PHASE_FRAC));
        (0..count & 3).fold(lines, |sum, edge| {
            sum.wrapping_add(self.phase_exact(first.wrapping_add(edge), direction))
        })
    }

    fn base_exact(&self, edge: u32) -> i32 {
        self.base_sum_exact(edge, 1) as i32
    }

    /// Base of edges of one revolution, segment by segment: with b the entry before and Δ the step to the next,
    /// n edges come to n·b + Δ/64 times the sum of their offsets.
    #[inline]
    fn base_sum_exact(&self, first: u32, count: u32) -> i64 {
        let entries = self.base.get((first / BASE_SPACING) as usize..);
        let mut offset = first % BASE_SPACING;
        let mut left = count;
        let mut total = 0_i64;
        for pair in entries.unwrap_or(&[]).array_windows() {
            let [before, after] = pair.map(|entry| i32::from(i16::from_le_bytes(entry)));
            let edges = left.min(BASE_SPACING.wrapping_sub(offset));
            let offsets = edges
                .wrapping_mul(offset)
                .wrapping_add(edges.wrapping_mul(edges.wrapping_sub(1)) / 2);
            let level = before.wrapping_mul(edges.wrapping_mul(BASE_SPACING).cast_signed());
            let rise = after
                .wrapping_sub(before)
                .wrapping_mul(offsets.cast_signed());
            total = total.wrapping_add(i64::from(level.wrapping_add(rise)));
            left = left.wrapping_sub(edges);
            if left == 0 {
                break;
            }
            offset = 0;
        }
        total
    }

    #[inline]
    fn byte_sum_exact(&self, first: u32, count: u32) -> i32 {
        let (from, to) = (first as usize, first.wrapping_add(count) as usize);
        let bytes = self.bytes.get(from..to).unwrap_or(&[]);
        self.bytes_exact(sum_of_bytes(bytes), bytes.len() as u32)
    }

    /// `count` bytes that add up to `sum`.
    const fn bytes_exact(&self, sum: u32, count: u32) -> i32 {
        sum.wrapping_sub(count.wrapping_mul(BYTE_ZERO as u32))
            .wrapping_shl(self.byte_shift)
            .cast_signed()
    }
}

/// Exact to Q.16, to nearest.
const fn to_error(exact: i64) -> i32 {
    const BITS: u32 = EXACT_FRAC - ERROR_FRAC;
    exact.wrapping_add(1 << (BITS - 1)).wrapping_shr(BITS) as i32
}

/// Words of four bytes whose bytes add up in 16 bits each.
const LANE_WORDS: usize = 256;
const LANES: u32 = 0x00ff_00ff;

/// Four bytes at a time in two pairs of 16-bit lanes: a load and two additions a word on a Cortex-M4.
#[inline]
fn sum_of_bytes(bytes: &[u8]) -> u32 {
    let (words, rest) = bytes.as_chunks();
    let rest = rest
        .iter()
        .fold(0_u32, |sum, byte| sum.wrapping_add(u32::from(*byte)));
    words.chunks(LANE_WORDS).fold(rest, |total, words| {
        let (mut even, mut odd) = (0_u32, 0_u32);
        for word in words {
            let word = u32::from_le_bytes(*word);
            even = even.wrapping_add(word & LANES);
            odd = odd.wrapping_add(word.wrapping_shr(8) & LANES);
        }
        total
            .wrapping_add(even & 0xffff)
            .wrapping_add(even.wrapping_shr(16))
            .wrapping_add(odd & 0xffff)
            .wrapping_add(odd.wrapping_shr(16))
    })
}
