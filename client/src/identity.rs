//! What an axis is.

use leadscrew::protocol::reply::{CAN_HOME, CAN_RECORD, CAN_SET};

/// What an axis says of itself when a session opens.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Identity {
    /// Version of the protocol that it speaks.
    pub protocol: u16,
    /// Version of the firmware.
    pub firmware: String,
    /// What the firmware was built from.
    pub build: String,
    /// What it runs on.
    pub board: String,
    /// Control rate, ticks a second.
    pub tick_hz: u32,
    /// How long the control lease lasts without being renewed, ticks.
    pub lease_ticks: u32,
    /// What it can do, in bits of [`leadscrew::protocol::reply`].
    pub capabilities: u32,
    /// Room for what is recorded, bytes.
    pub work_memory: u32,
}

impl Identity {
    /// It can be homed.
    #[must_use]
    pub const fn can_home(&self) -> bool {
        self.capabilities & CAN_HOME != 0
    }

    /// Its parameters can be read and set.
    #[must_use]
    pub const fn can_set(&self) -> bool {
        self.capabilities & CAN_SET != 0
    }

    /// Records of its ticks can be subscribed to.
    #[must_use]
    pub const fn can_record(&self) -> bool {
        self.capabilities & CAN_RECORD != 0
    }

    /// So many milliseconds in ticks, rounded up.
    #[must_use]
    pub fn ticks_of_ms(&self, ms: u32) -> u32 {
        let ticks = (u64::from(ms) * u64::from(self.tick_hz)).div_ceil(1000);
        u32::try_from(ticks).unwrap_or(u32::MAX)
    }
}
