//! Why a map was refused, or none was made.

use core::fmt;

use super::ERROR_FRAC;
use super::format::VERSION;

/// Why an image was refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MapError {
    /// The image ends before the map does.
    Cut {
        /// Bytes given.
        given: usize,
        /// Bytes of the map, as far as is known.
        needed: usize,
    },
    /// The image does not begin with the magic.
    NotAMap,
    /// A map of another version.
    Version {
        /// Its version.
        version: u16,
    },
    /// A field out of range.
    Field {
        /// Offset of the field in the image.
        offset: usize,
        /// What the field is.
        name: &'static str,
        /// What it may be.
        allowed: &'static str,
    },
    /// The image was changed since it was made.
    Checksum {
        /// Checksum that it carries.
        stated: u32,
        /// Checksum of its bytes.
        computed: u32,
    },
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cut { given, needed } => write!(
                f,
                "the encoder map is cut off: {given} bytes of at least {needed}; write it anew"
            ),
            Self::NotAMap => {
                f.write_str("this is no encoder map: it must begin with the four letters LSEM")
            }
            Self::Version { version } => write!(
                f,
                "the encoder map is of version {version}, expected {VERSION}: learn it anew"
            ),
            Self::Field {
                offset,
                name,
                allowed,
            } => write!(
                f,
                "{name} at byte {offset} of the encoder map is out of range: allowed {allowed}; learn it anew"
            ),
            Self::Checksum { stated, computed } => write!(
                f,
                "the encoder map is damaged: its checksum is {stated:#010x}, that of its bytes {computed:#010x}; \
                 write it anew"
            ),
        }
    }
}

impl core::error::Error for MapError {}

/// Why no map was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EncodeError {
    /// A number of edges that no map has.
    Edges {
        /// The number.
        edges: u32,
    },
    /// The memory for the image is too small.
    Memory {
        /// Bytes given.
        given: usize,
        /// Bytes needed.
        needed: usize,
    },
    /// A phase beyond the ±2 d that a map can hold.
    Phase {
        /// The error of the phase, Q.16 d.
        error: i32,
    },
    /// The slow part of the error leaves the ±8 d about edge 0 that a map can hold.
    Base {
        /// The edge.
        edge: u32,
        /// The slow part of its error, Q.16 d.
        error: i32,
    },
    /// An edge lies so far off its neighbours that the largest byte does not tell it: ±1 d.
    Misfit {
        /// The edge.
        edge: u32,
        /// What is left of its error beside base and phase, Q.16 d.
        misfit: i32,
    },
    /// A figure of the residual that is no number, or negative, or a front a revolution away.
    Figure,
}

/// Q.16 d as a number of d.
fn in_d(error: i32) -> f64 {
    f64::from(error) / f64::from(1_u32.wrapping_shl(ERROR_FRAC))
}

impl fmt::Display for EncodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Edges { edges } => write!(
                f,
                "{edges} edges a revolution: allowed multiples of 4 from 16 to 65536"
            ),
            Self::Memory { given, needed } => {
                write!(f, "the map needs {needed} bytes, there are {given}")
            }
            Self::Phase { error } => write!(
                f,
                "the edges of one phase lie {:.3} d off: a map holds up to 2 d; check the encoder's \
                 supply and lines",
                in_d(error)
            ),
            Self::Base { edge, error } => write!(
                f,
                "the encoder's error changes by {:.3} d from edge 0 to edge {edge}: a map holds up to 8 d; \
                 check how the disc is centred and the coupling",
                in_d(error)
            ),
            Self::Misfit { edge, misfit } => write!(
                f,
                "edge {edge} lies {:.3} d off its neighbours: a map holds up to 0.99 d; check that no edge was \
                 missed while learning",
                in_d(misfit)
            ),
            Self::Figure => f.write_str(
                "the residual of a map must be figures that are not negative, its index fronts less than a \
                 revolution away",
            ),
        }
    }
}

impl core::error::Error for EncodeError {}
