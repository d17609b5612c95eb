//! Which edge of the map an edge of the shaft is: the tie to the index.
//!
//! The zero boundary of a map is the edge of B at which the levels A B go from 01 to 00 when the shaft turns
//! forward (count ≡ 0 modulo 4, as [`crate::hal::Capture`] wants it), the first such at or after the front of the
//! index pulse forward. The index only says which of the lines it is: the zero boundary is the multiple of 4
//! nearest to the latched count less the front that the map gives for the direction, so that a front which
//! comes a count early or late does not matter.
//!
//! ```text
//!           an index                  an index disagrees: slip
//! Unfound ───────────► Tied ─────────────────────────────────► Rejected
//!                       │ ◄───────────────────────────────────    ▲ │
//!                       │            it agrees with the last      │ │
//!                       │                                         │ │
//!                       └─────────────► OffPhase ◄────────────────│─┘
//!                   half a line off: slip   └─────────────────────┘
//!                                             on the lines again
//! ```
//!
//! In [`MapState::Unfound`] and [`MapState::Rejected`] the phases of the map still hold, since the count tells
//! them; in [`MapState::OffPhase`], half a line off, nothing does.

use crate::capture::{EdgeTimes, Observation, UnwrappedLatch};

use super::{Direction, EncoderMap};

/// How far a map can be used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MapState {
    /// No index was seen yet: phases alone.
    #[default]
    Unfound,
    /// The index was found: all of the map.
    Tied,
    /// An index came elsewhere than a whole number of revolutions from the last: counts were lost. Phases alone,
    /// until two in a row agree.
    Rejected,
    /// An index came half a line beside its place: the low bits of the count do not tell the levels any more, as
    /// after an illegal transition. Nothing of the map is used.
    OffPhase,
}

/// Totals of the tie to the index since the map was set; they stop at their maximum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MapHealth {
    /// Times that the map was tied to an index.
    pub ties: u32,
    /// Count slips that an index showed.
    pub slips: u32,
}

/// A map, and where it is tied to the count.
#[derive(Clone, Copy, Debug)]
pub struct MapTie<'m> {
    map: EncoderMap<'m>,
    state: MapState,
    health: MapHealth,
    /// The count last noted.
    count: i64,
    /// Edge number of the boundary `count`, counted from the zero boundary that the last index gave; it goes with
    /// the count, so that a tick needs no 64-bit division.
    edge: u32,
}

impl<'m> MapTie<'m> {
    /// A map that waits for its index.
    #[must_use]
    pub const fn new(map: EncoderMap<'m>) -> Self {
        Self {
            map,
            state: MapState::Unfound,
            health: MapHealth { ties: 0, slips: 0 },
            count: 0,
            edge: 0,
        }
    }

    /// The map.
    #[must_use]
    pub const fn map(&self) -> &EncoderMap<'m> {
        &self.map
    }

    /// How far the map can be used now.
    #[must_use]
    pub const fn state(&self) -> MapState {
        self.state
    }

    /// What the indexes showed so far.
    #[must_use]
    pub const fn health(&self) -> MapHealth {
        self.health
    }

    /// Takes notice of a tick: of its count and of its index. Once a tick, before its edges are read.
    #[inline]
    pub fn note(&mut self, observation: &Observation<'_>) {
        let moved = observation.count.wrapping_sub(self.count);
        self.count = observation.count;
        // Captures lie within 32 bits of each other; only before the first one may the way be longer, and then
        // there is nothing to be kept.
        self.edge = self.edge_ahead(moved as i32);
        if let Some(latch) = observation.index() {
            self.at_index(observation, latch);
        }
    }

    /// Error of the boundary `ahead` counts above the one at the noted count, Q.16 d.
    #[must_use]
    pub fn error(&self, ahead: i32, direction: Direction) -> i32 {
        match self.state {
            MapState::Tied => self.map.error(self.edge_ahead(ahead), direction),
            MapState::Unfound | MapState::Rejected => {
                self.map.phase_error(self.phase_ahead(ahead), direction)
            }
            MapState::OffPhase => 0,
        }
    }

    /// Errors of `count` boundaries added up, from the one `ahead` counts above the noted count on upwards, Q.16 d;
    /// `count` is at most [`super::MAX_SUM`].
    #[must_use]
    #[inline]
    pub fn sum(&self, ahead: i32, count: u32, direction: Direction) -> i32 {
        match self.state {
            MapState::Tied => self.map.sum(self.edge_ahead(ahead), count, direction),
            MapState::Unfound | MapState::Rejected => {
                let first = self.phase_ahead(ahead);
                self.map.phase_sum(first, count, direction)
            }
            MapState::OffPhase => 0,
        }
    }

    const fn phase_ahead(&self, ahead: i32) -> u32 {
        (self.count as u32).wrapping_add(ahead.cast_unsigned())
    }

    fn edge_ahead(&self, ahead: i32) -> u32 {
        let edges = self.map.edges;
        let way = ahead.unsigned_abs() % edges;
        let on = if ahead < 0 {
            edges.get().wrapping_sub(way)
        } else {
            way
        };
        let sum = self.edge.wrapping_add(on);
        if sum < edges.get() {
            sum
        } else {
            sum.wrapping_sub(edges.get())
        }
    }

    #[cold]
    #[inline(never)]
    fn at_index(&mut self, observation: &Observation<'_>, latch: UnwrappedLatch) {
        let Some(direction) = direction_at(observation, latch) else {
            return;
        };
        let Some(front) = self.map.front(direction) else {
            return;
        };
        let wanted = latch.count.wrapping_sub(i64::from(front));
        let zero = match wanted & 3 {
            0 => wanted,
            1 => wanted.wrapping_sub(1),
            3 => wanted.wrapping_add(1),
            _ => return self.note_half_a_line(),
        };
        let Ok(ahead) = i32::try_from(zero.wrapping_sub(self.count)) else {
            return;
        };
        let agrees = self.edge_ahead(ahead) == 0;
        self.edge = 0;
        self.edge = self.edge_ahead(ahead.wrapping_neg());
        self.judge(agrees);
    }

    /// What an index that agrees with the last one, or does not, makes of the tie.
    const fn judge(&mut self, agrees: bool) {
        self.state = match (self.state, agrees) {
            (MapState::Unfound, _) | (MapState::Rejected, true) => {
                self.health.ties = self.health.ties.saturating_add(1);
                MapState::Tied
            }
            (MapState::Tied, true) => MapState::Tied,
            (MapState::Tied, false) => {
                self.health.slips = self.health.slips.saturating_add(1);
                MapState::Rejected
            }
            (MapState::Rejected, false) | (MapState::OffPhase, _) => MapState::Rejected,
        }
    }

    /// Before the first tie it may have been any pulse.
    const fn note_half_a_line(&mut self) {
        match self.state {
            MapState::Unfound => return,
            MapState::Tied => self.health.slips = self.health.slips.saturating_add(1),
            MapState::Rejected | MapState::OffPhase => {}
        }
        self.state = MapState::OffPhase;
    }
}

/// Which way the shaft passed the index, where the tick tells: it went one way, and the latch lies on it.
fn direction_at(observation: &Observation<'_>, latch: UnwrappedLatch) -> Option<Direction> {
    if observation.edge_times() == EdgeTimes::None {
        return None;
    }
    let back = observation.count.wrapping_sub(latch.count);
    let delta = i64::from(observation.delta);
    let on_the_way = if delta < 0 {
        delta <= back && back <= 0
    } else {
        0 <= back && back <= delta
    };
    on_the_way.then(|| Direction::of(observation.delta))
}
