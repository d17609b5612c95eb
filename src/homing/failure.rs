//! Why homing failed, and why it did not begin.

use core::fmt;

use crate::supervisor::Fault;

/// Why homing failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HomingFailure {
    /// The whole way was searched, or both limit switches reached.
    SwitchNotFound,
    /// The switch does not release on the way back.
    SwitchStuck,
    /// No index within 1.1 revolutions after the switch.
    IndexNotFound,
    /// The index lies too near to the switch.
    IndexTooNear {
        /// From the switch to the index, d.
        distance: i32,
        /// A revolution, d.
        revolution: i32,
    },
    /// It took too long.
    TimeOut,
}

impl HomingFailure {
    /// The fault that it is to the supervisor.
    #[must_use]
    pub const fn fault(self) -> Fault {
        match self {
            Self::IndexNotFound => Fault::IndexNotFound,
            _ => Fault::HomingFailed,
        }
    }
}

impl fmt::Display for HomingFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::SwitchNotFound => f.write_str(
                "the home switch was not found: check its wire, search_direction and max_search_mm",
            ),
            Self::SwitchStuck => f.write_str(
                "the home switch did not release: check the switch, its wire and its polarity",
            ),
            Self::IndexNotFound => f.write_str(
                "no index came within 1.1 revolutions after the home switch: check the encoder's index line and \
                 counts_per_revolution",
            ),
            Self::IndexTooNear {
                distance,
                revolution,
            } => write!(
                f,
                "the index comes {distance} d after the home switch, allowed are 10 to 90 % of a revolution of \
                 {revolution} d: turn the encoder's coupling by half a revolution, or move the switch by that way"
            ),
            Self::TimeOut => f.write_str(
                "homing took longer than max_time_s: raise it or the feeds, and check that the axis moves",
            ),
        }
    }
}

impl core::error::Error for HomingFailure {}

/// Why homing did not begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HomeRefused {
    /// The axis is not under control, or in motion.
    NotReady,
    /// The encoder has no index.
    NoIndex,
}

impl fmt::Display for HomeRefused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotReady => {
                "the axis is not ready: enable it, clear faults and let it come to rest, then home it"
            }
            Self::NoIndex => {
                "there is no index to home to: set counts_per_revolution to the counts from index to index"
            }
        })
    }
}

impl core::error::Error for HomeRefused {}
