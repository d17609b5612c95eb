//! The probe's signal: which edge is a touch.
//!
//! ```text
//!            latch                                    open ──── edge ───► pending ── level stays ──► closed
//!  level ────┘▔▔│▁│▔▔▔▔▔▔▔▔▔▔▔▔▔                       ▲                   │                          │
//!               bounce  debounce │ touch, of the        ├── glitch ◄────────┘ level gone              │
//!                                │ first edge           └── level gone for the debounce ◄─────────────┘
//! ```
//!
//! The hardware latches the first edge; the debounce only decides whether it counts, so it does not delay the latch. An edge
//! whose level is gone for the whole debounce was a glitch: it is counted, and the next edge may be the touch. What does
//! neither stay nor go away is a contact that bounces, and is decided on after [`DECISION`] times the debounce.

use super::config::DECISION;
use crate::capture::{Observation, UnwrappedLatch};

/// The edge of a touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// What the hardware latched; count and time of the sample where only the level was seen.
    pub latch: UnwrappedLatch,
    /// The hardware latched it.
    pub is_latched: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    #[default]
    Open,
    Pending {
        edge: Edge,
        /// Ticks since the edge, ticks that the level has been there without a break, and away.
        age: u32,
        high: u32,
        low: u32,
    },
    Closed {
        low: u32,
    },
}

/// The probe's signal.
#[derive(Clone, Debug, Default)]
pub struct Trigger {
    state: State,
    glitches: u16,
}

impl Trigger {
    /// A signal that is open.
    pub const fn new() -> Self {
        Self {
            state: State::Open,
            glitches: 0,
        }
    }

    /// Edges that were none of a touch; wraps.
    pub const fn glitches(&self) -> u16 {
        self.glitches
    }

    /// True while something may come of an edge before.
    pub const fn is_awake(&self) -> bool {
        !matches!(self.state, State::Open)
    }

    /// True from a touch until the level has gone.
    pub const fn is_closed(&self) -> bool {
        matches!(self.state, State::Closed { .. })
    }

    /// The edge that may become a touch.
    pub const fn pending(&self) -> Option<Edge> {
        match self.state {
            State::Pending { edge, .. } => Some(edge),
            State::Open | State::Closed { .. } => None,
        }
    }

    /// Waits for the level to go, whatever it was at.
    pub const fn close(&mut self) {
        self.state = State::Closed { low: 0 };
    }

    /// Takes a tick; gives the edge of a touch in the tick in which it is certain.
    pub fn step(&mut self, debounce: u32, observation: &Observation<'_>) -> Option<Edge> {
        let level = observation.is_touching();
        match &mut self.state {
            State::Open => {
                let edge = edge_of(observation)?;
                self.state = State::Pending {
                    edge,
                    age: 0,
                    high: u32::from(level),
                    low: u32::from(!level),
                };
            }
            State::Pending { age, high, low, .. } => {
                *age = age.saturating_add(1);
                *high = if level { high.saturating_add(1) } else { 0 };
                *low = if level { 0 } else { low.saturating_add(1) };
            }
            State::Closed { low } => {
                *low = if level { 0 } else { low.saturating_add(1) };
                if *low >= debounce {
                    self.state = State::Open;
                }
                return None;
            }
        }
        self.decide(debounce)
    }

    fn decide(&mut self, debounce: u32) -> Option<Edge> {
        let State::Pending {
            edge,
            age,
            high,
            low,
        } = self.state
        else {
            return None;
        };
        // The tick of the edge saw less than a tick of level.
        if high > debounce || age >= debounce.saturating_mul(DECISION) {
            self.state = State::Closed { low };
            return Some(edge);
        }
        if low > debounce {
            self.state = State::Open;
            self.glitches = self.glitches.wrapping_add(1);
        }
        None
    }
}

/// The edge of a tick; a board that latches none, or a probe that was deflected unseen, still shows its level.
fn edge_of(observation: &Observation<'_>) -> Option<Edge> {
    let latched = observation.probe().map(|latch| Edge {
        latch,
        is_latched: true,
    });
    latched.or_else(|| {
        observation.is_touching().then_some(Edge {
            latch: UnwrappedLatch {
                count: observation.count,
                time: observation.sampled_at,
            },
            is_latched: false,
        })
    })
}
