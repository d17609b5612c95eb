//! What the drive tells of itself.

use leadscrew::parameter_table::ParameterTable;
use leadscrew::units::RangeError;

leadscrew::parameter_table! {
    /// When the drive is ready.
    pub struct DriveLineParams {
        /// From enable to ready
        ready_after_s: 0.0, "s", 0.0..=60.0;
    }
}

/// What the drive may tell by itself; set between two ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DriveHealth {
    /// It becomes ready when it is enabled.
    #[default]
    Good,
    /// It is enabled in vain, or ceases to be ready.
    NeverReady,
    /// It reports a fault, and is not ready.
    Faulty,
}

/// The drive's own enabling.
#[derive(Clone, Copy, Debug)]
pub struct DriveLines {
    ready_ticks: u32,
    enabled_ticks: u32,
}

impl DriveLines {
    /// A drive that is off.
    pub fn new(params: &DriveLineParams, tick_hz: f64) -> Result<Self, RangeError> {
        params.check()?;
        Ok(Self {
            ready_ticks: (params.ready_after_s * tick_hz + 0.5) as u32,
            enabled_ticks: 0,
        })
    }

    /// One tick of a drive whose enable is at that level.
    pub fn step(&mut self, enabled: bool) {
        self.enabled_ticks = if enabled {
            self.enabled_ticks.saturating_add(1)
        } else {
            0
        };
    }

    /// True if it follows its command. A drive without a delay is ready before it is enabled: many report
    /// only that they have no fault.
    pub fn is_ready(&self, health: DriveHealth) -> bool {
        health == DriveHealth::Good && self.enabled_ticks >= self.ready_ticks
    }
}
