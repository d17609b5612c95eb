//! Why a reset came.

use core::fmt;

/// Bytes of a file's name that are kept, its last ones.
pub const FILE_BYTES: usize = 24;

/// Where in the source a panic was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// FNV-1a of the file's whole path, to tell files apart whose ends are alike.
    pub hash: u32,
    /// Line.
    pub line: u32,
    /// The end of the path, filled up with zeros before it.
    pub file: [u8; FILE_BYTES],
}

impl Place {
    /// Of a path and line, as a panic's location gives them.
    #[must_use]
    pub fn new(path: &str, line: u32) -> Self {
        let bytes = path.as_bytes();
        let mut file = [0; FILE_BYTES];
        file.iter_mut()
            .rev()
            .zip(bytes.iter().rev())
            .for_each(|(kept, byte)| *kept = *byte);
        Self {
            hash: bytes.iter().fold(0x811c_9dc5, |hash, byte| {
                (hash ^ u32::from(*byte)).wrapping_mul(0x0100_0193)
            }),
            line,
            file,
        }
    }

    /// The end of the path as text, as far as it is any.
    #[must_use]
    pub fn file(&self) -> &str {
        let start = self.file.iter().position(u8::is_ascii_graphic);
        let text = start.and_then(|start| self.file.get(start..));
        text.and_then(|text| core::str::from_utf8(text).ok())
            .unwrap_or("?")
    }
}

/// What the processor says of a hard fault.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HardFault {
    /// Address of the instruction.
    pub pc: u32,
    /// Where it would have returned to.
    pub lr: u32,
    /// Configurable fault status (CFSR).
    pub cfsr: u32,
    /// Hard fault status (HFSR).
    pub hfsr: u32,
    /// Address of the access, if CFSR says that it is valid (BFAR).
    pub address: u32,
}

/// Why a reset came that nobody asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The firmware panicked.
    Panic(Place),
    /// The processor stopped at an instruction.
    HardFault(HardFault),
    /// The watchdog was not fed: a tick hung, or none came.
    Watchdog,
    /// The watchdog was not fed, since ticks ended too late one after another.
    LateTicks {
        /// The tick from which on they did, counted from start-up.
        tick: u32,
    },
    /// The stack reached its end.
    StackOverflow,
}

impl Reason {
    /// Its number on the link, from 1; numbers are only ever appended.
    #[must_use]
    pub const fn number(&self) -> u8 {
        match self {
            Self::Panic(_) => 1,
            Self::HardFault(_) => 2,
            Self::Watchdog => 3,
            Self::LateTicks { .. } => 4,
            Self::StackOverflow => 5,
        }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Panic(place) => {
                let Place { hash, line, .. } = place;
                write!(
                    f,
                    "panic in {} line {line} (path hash {hash:08x})",
                    place.file()
                )
            }
            Self::HardFault(fault) => {
                let HardFault {
                    pc,
                    lr,
                    cfsr,
                    hfsr,
                    address,
                } = fault;
                write!(
                    f,
                    "hard fault at {pc:#010x}, called from {lr:#010x} (CFSR {cfsr:#010x}, HFSR {hfsr:#010x}, address \
                     {address:#010x})"
                )
            }
            Self::Watchdog => f.write_str("watchdog: a tick hung, or none came"),
            Self::LateTicks { tick } => {
                write!(f, "watchdog: ticks ended too late from tick {tick} on")
            }
            Self::StackOverflow => f.write_str("the stack reached its end"),
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::string::ToString;

    use super::*;

    #[test]
    fn a_place_keeps_the_end_of_its_path() {
        let long = Place::new("some/where/deep/leadscrew/src/controller/mod.rs", 7);
        assert_eq!(
            long.file(),
            "screw/src/controller/mod.rs".get(3..).unwrap_or("")
        );
        assert_eq!(long.file().len(), FILE_BYTES);
        let other = Place::new("some/other/leadscrew/src/controller/mod.rs", 7);
        assert_eq!(long.file, other.file);
        assert_ne!(long.hash, other.hash);
        assert_eq!(Place::new("a.rs", 1).file(), "a.rs");
        assert_eq!(Place::new("", 1).file(), "?");
        // A character cut in two by the tail is no text.
        assert_eq!(
            Place::new("ä23456789012345678901234.rs", 1).file().len(),
            FILE_BYTES
        );
    }

    #[test]
    fn a_reason_is_told_in_a_line() {
        let place = Place::new("app/src/tick.rs", 12);
        let told = Reason::Panic(place).to_string();
        assert_eq!(
            told,
            std::format!(
                "panic in app/src/tick.rs line 12 (path hash {:08x})",
                place.hash
            )
        );
        assert!(
            Reason::HardFault(HardFault {
                pc: 0x0801_0002,
                ..HardFault::default()
            })
            .to_string()
            .contains("at 0x08010002")
        );
    }
}
