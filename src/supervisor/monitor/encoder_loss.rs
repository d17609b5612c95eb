//! Encoder loss: the drive is told to move and the encoder stands.

use super::super::fault::Fault;
use super::super::record::Trip;

/// What is allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Commands up to this may be held by friction, Q.30 of full command.
    pub level: i32,
    /// Ticks.
    pub ticks: u32,
    /// Commanded way: ticks at full command, Q.15.
    pub way: u32,
    /// d at full command in a tick, for the record; Q.16.
    pub full_velocity: u32,
    /// An encoder that moves as much is alive, d.
    pub counts: u32,
}

/// The monitor.
#[derive(Clone, Copy, Debug, Default)]
pub struct EncoderLoss {
    /// Low word of the count from which on it stands.
    anchor: u32,
    ticks: u32,
    /// Commanded since then, Q.15 of full command × ticks.
    way: u32,
}

impl EncoderLoss {
    /// True while it stands under command.
    pub const fn is_busy(&self) -> bool {
        self.ticks != 0
    }

    /// Judges the low word of the count after a tick that moved by `delta` d under `command` (Q.30).
    pub fn check(&mut self, limits: &Limits, command: i32, count: u32, delta: i32) -> Option<Trip> {
        if self.ticks == 0 {
            self.anchor = count.wrapping_add_signed(delta.wrapping_neg());
        }
        let size = command.saturating_abs();
        let moved = count.wrapping_sub(self.anchor).cast_signed();
        if size <= limits.level || moved.unsigned_abs() >= limits.counts {
            self.ticks = 0;
            self.way = 0;
            return None;
        }
        self.ticks = self.ticks.saturating_add(1);
        let share = size.wrapping_shr(15).unsigned_abs();
        self.way = self.way.saturating_add(share);
        (self.ticks > limits.ticks && self.way > limits.way).then(|| Trip {
            fault: Fault::EncoderLoss,
            value: limits.way_d(self.way),
            limit: limits.way_d(limits.way),
        })
    }
}

impl Limits {
    fn way_d(&self, way: u32) -> super::super::record::Figure {
        let bits = u64::from(way)
            .wrapping_mul(u64::from(self.full_velocity))
            .wrapping_shr(15);
        super::super::record::Figure::from_bits(bits.cast_signed())
    }
}
