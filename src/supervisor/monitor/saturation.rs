//! An output at its limit for too long.

use super::super::fault::Fault;
use super::super::record::Trip;
use crate::output::ActiveLimits;

/// The monitor.
#[derive(Clone, Copy, Debug, Default)]
pub struct Saturation {
    ticks: u32,
}

impl Saturation {
    /// True while the output is at its limit.
    pub const fn is_busy(&self) -> bool {
        self.ticks != 0
    }

    /// Judges the limits that held the last output back; `limit` in ticks.
    pub fn check(&mut self, limit: u32, active: ActiveLimits) -> Option<Trip> {
        if !(active.high | active.low) || active.slew {
            self.ticks = 0;
            return None;
        }
        self.ticks = self.ticks.saturating_add(1);
        (self.ticks > limit)
            .then(|| Trip::counted(Fault::OutputSaturated, self.ticks.into(), limit.into()))
    }
}
