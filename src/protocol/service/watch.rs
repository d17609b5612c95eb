//! The watch over the control lease: when its lapse stops the axis, and when the axis itself is what took the time.

use crate::protocol::lease::Lease;

/// Leases for which a tool is waited for after a request that takes long: 10 s.
const PATIENCE: u32 = 100;

/// What is known of the time that passes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watch {
    /// The lease has lapsed, and the axis does not know yet.
    must_disable: bool,
    /// Tick of a request for which the axis itself took its time, while it stood: the lease lasts until the next one comes,
    /// or [`PATIENCE`] leases long.
    busy_since: Option<u32>,
    /// The tick that was looked at last.
    looked_at: Option<u32>,
}

impl Watch {
    /// Looks at the lease; true while the axis is to be disabled.
    pub fn look(&mut self, lease: &mut Lease, tick: u32, may_move: bool) -> bool {
        // What the axis did not look at while it computed is no time in which its tool was silent. In motion it counts.
        let step = self.looked_at.map_or(0, |at| tick.wrapping_sub(at));
        self.looked_at = Some(tick);
        if step > 1 && !may_move {
            lease.prolong(tick);
        }
        let patience = lease.ticks().saturating_mul(PATIENCE);
        let is_excused =
            !may_move && (self.busy_since).is_some_and(|since| tick.wrapping_sub(since) < patience);
        self.must_disable |= !is_excused && lease.has_lapsed(tick);
        self.must_disable
    }

    /// True while the axis does not know yet of a lease that has lapsed.
    pub const fn must_disable(&self) -> bool {
        self.must_disable
    }

    /// The axis was disabled.
    pub const fn note_disabled(&mut self) {
        self.must_disable = false;
    }

    /// The tool is heard of again.
    pub fn note_heard(&mut self, lease: &mut Lease, tick: u32) {
        if self.busy_since.take().is_some() {
            lease.prolong(tick);
        }
    }

    /// A request was carried out; one that takes long on an axis that stands costs its tool no lease: nothing can move
    /// before another one comes.
    pub fn note_worked(&mut self, tick: u32, is_excused: bool) {
        self.busy_since = is_excused.then_some(tick);
    }
}
