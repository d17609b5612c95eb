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
    /// Judges the limits that held the last output back; `limit` in ticks.
    #[inline]
    pub fn check(&mut self, limit: u32, active: ActiveLimits) -> Option<Trip> {
        if !(active.high | active.low) || active.slew {
            self.ticks = 0;
            return None;
        }
        self.hold(limit)
    }

    #[cold]
    #[inline(never)]
    fn hold(&mut self, limit: u32) -> Option<Trip> {
        self.ticks = self.ticks.saturating_add(1);
        (self.ticks > limit)
            .then(|| Trip::counted(Fault::OutputSaturated, self.ticks.into(), limit.into()))
    }
}
