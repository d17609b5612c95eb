//! Why a source was not selected, or a gear not engaged.

use core::fmt;

/// Why another source was not selected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelectError {
    /// The axis moves, or stops.
    Moving,
    /// The gear is engaged.
    Engaged,
}

impl fmt::Display for SelectError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Moving => "the axis moves: select another source when it stands",
            Self::Engaged => "the gear is engaged: disengage it first",
        })
    }
}

impl core::error::Error for SelectError {}

/// Why the gear was not engaged or disengaged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GearError {
    /// The axis is not enabled.
    Disabled,
    /// Gearing is not selected.
    NotSelected,
    /// No signal comes from the master.
    NoSignal,
    /// The gear is so already, or on its way.
    Busy,
}

impl fmt::Display for GearError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Disabled => "the axis is not enabled: enable it first",
            Self::NotSelected => "gearing is not selected: select it first",
            Self::NoSignal => "no signal from the master's encoder: check its cable and supply",
            Self::Busy => "the gear is so already, or on its way: wait for it",
        })
    }
}

impl core::error::Error for GearError {}
