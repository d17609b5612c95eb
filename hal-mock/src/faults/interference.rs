//! When the pulses of interference come.

use super::fault::Bursts;

/// Bursts under way.
#[derive(Clone, Copy, Debug)]
pub struct Interference {
    bursts: Bursts,
    burst_at: u32,
    /// Pulses that the burst has had.
    pulse: u32,
}

impl Interference {
    /// Bursts from a time on.
    pub const fn new(bursts: Bursts, from: u32) -> Self {
        Self {
            bursts,
            burst_at: from,
            pulse: 0,
        }
    }

    /// Start and end of the next pulse that starts at `until` or before.
    pub const fn next_until(&mut self, until: u32) -> Option<(u32, u32)> {
        if self.pulse == self.bursts.pulses {
            self.pulse = 0;
            self.burst_at = self.burst_at.wrapping_add(self.bursts.period_clocks);
        }
        let width = self.bursts.width_clocks;
        let start = self.burst_at.wrapping_add(2 * width * self.pulse);
        if until.wrapping_sub(start).cast_signed() < 0 || self.bursts.pulses == 0 {
            return None;
        }
        self.pulse += 1;
        Some((start, start.wrapping_add(width)))
    }
}
