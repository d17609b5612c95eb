//! What a touch was measured to be.

use super::ProbeEnd;
use crate::units::{Position, Variance, Velocity};

/// A touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Touch {
    /// Where the encoder's shaft was at the contact, raw d.
    pub raw: Position,
    /// The same for users: from the origin, compensation taken out, d.
    pub position: Position,
    /// Variance of it by edges, map and trigger jitter, d²; what the probe itself scatters comes on top.
    pub variance: Variance,
    /// Velocity at the contact, d/tick.
    pub velocity: Velocity,
    /// The latch by the timer, unwrapped; the contact was the trigger delay before.
    pub time: i64,
    /// Tick that took the latch in, as in [`Outputs::tick`](crate::axis::Outputs::tick).
    pub tick: u32,
    /// How far beyond the contact the axis went, d.
    pub overtravel: Position,
    /// Edges that the place was found from; 0: by the count alone.
    pub edges: u32,
}

/// What probing came to since the axis was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Rises with each touch, sought or not; wraps.
    pub touches: u16,
    /// Rises with each end of probing, and each touch that nobody sought; wraps.
    pub ends: u16,
    /// How the last one ended.
    pub end: Option<ProbeEnd>,
    /// The touch of it; none where it ended without.
    pub touch: Option<Touch>,
    /// Edges of the probe that were none of a touch; wraps.
    pub glitches: u16,
}

impl Report {
    /// The last touch that was sought was found, and nothing was wrong.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.end.is_some_and(ProbeEnd::is_good)
    }
}
