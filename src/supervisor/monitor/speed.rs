//! Overspeed.

use super::super::fault::Fault;
use super::super::record::Trip;

/// Ticks running of a velocity above the limit: one burst of false edges is none.
const TICKS: u32 = 3;

/// The monitor.
#[derive(Clone, Copy, Debug, Default)]
pub struct Overspeed {
    ticks: u32,
}

impl Overspeed {
    /// True while the velocity is above the limit.
    pub const fn is_busy(&self) -> bool {
        self.ticks != 0
    }

    /// Judges an estimated velocity; both Q11.20 d/tick.
    pub fn check(&mut self, limit: i32, velocity: i32) -> Option<Trip> {
        if velocity.saturating_abs() <= limit {
            self.ticks = 0;
            return None;
        }
        self.ticks = self.ticks.saturating_add(1);
        (self.ticks >= TICKS).then(|| Trip::of_bits(Fault::Overspeed, velocity, limit, 20))
    }
}
