//! What the converter says it puts out, against what it was told.

use super::super::fault::Fault;
use super::super::io::Loopback;
use super::super::record::Trip;
use crate::units::Command;

/// Ticks running of a mismatch: a converter may be read while it settles.
const TICKS: u32 = 2;

/// The monitor.
#[derive(Clone, Copy, Debug, Default)]
pub struct Readback {
    ticks: u32,
}

impl Readback {
    /// True if `readback` is what was told, to `tolerance` (Q.30), and was before.
    #[inline]
    pub fn is_good(&self, tolerance: i32, Loopback { readback, told }: Loopback) -> bool {
        self.ticks == 0 && readback.is_none_or(|seen| off(seen, told).saturating_abs() <= tolerance)
    }

    /// Judges it.
    #[cold]
    pub fn check(&mut self, tolerance: i32, Loopback { readback, told }: Loopback) -> Option<Trip> {
        let off = readback.map_or(0, |seen| off(seen, told));
        if off.saturating_abs() <= tolerance {
            self.ticks = 0;
            return None;
        }
        self.ticks = self.ticks.saturating_add(1);
        (self.ticks >= TICKS).then(|| Trip::of_bits(Fault::OutputMismatch, off, tolerance, 30))
    }
}

#[inline]
fn off(seen: Command, told: Command) -> i32 {
    seen.saturating_sub(told).to_bits()
}
