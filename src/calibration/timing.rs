//! The first revolutions of a run: how fast it is.

use super::plan::{MEASURING_REVOLUTIONS, RunMotion};
use super::reference::Reference;

/// Revolutions timed from boundary 0 to boundary 0.
#[derive(Clone, Debug)]
pub struct Timing {
    edges: u32,
    /// Number of the next edge in the direction of motion.
    next: u32,
    /// Boundaries 0 passed.
    crossings: u32,
    crossed_at: u32,
    durations: [u32; MEASURING_REVOLUTIONS as usize],
}

impl Timing {
    /// Nothing timed yet; the next edge of a revolution of `edges` is number `next` in the direction of motion.
    pub const fn new(edges: u32, next: u32) -> Self {
        Self {
            edges,
            next,
            crossings: 0,
            crossed_at: 0,
            durations: [0; MEASURING_REVOLUTIONS as usize],
        }
    }

    /// Number of the revolution, from 0 at the index on.
    pub const fn revolution(&self) -> u32 {
        self.crossings
    }

    /// Takes the time of the next edge and gives its number.
    pub fn pass(&mut self, time: u32) -> u32 {
        let number = self.next;
        self.next = number.wrapping_add(1);
        if self.next == self.edges {
            self.next = 0;
        }
        if number == 0 {
            let revolution = self.crossings.wrapping_sub(1) as usize;
            if let Some(duration) = self.durations.get_mut(revolution) {
                *duration = time.wrapping_sub(self.crossed_at);
            }
            self.crossings = self.crossings.saturating_add(1);
            self.crossed_at = time;
        }
        number
    }

    /// True when all revolutions are timed: the edge passed last begins the average.
    pub const fn is_done(&self) -> bool {
        self.crossings > MEASURING_REVOLUTIONS
    }

    /// The motion from the edge passed last on, if a reference can follow it.
    pub fn reference(&self, motion: RunMotion) -> Option<Reference> {
        let edges = f64::from(self.edges);
        let [first, second] = self.durations.map(f64::from);
        let (velocity, acceleration) = match motion {
            RunMotion::Steady => (2.0 * edges / (first + second), 0.0),
            RunMotion::Coast => {
                let acceleration = (edges / second - edges / first) * 2.0 / (first + second);
                (edges / second + acceleration * second / 2.0, acceleration)
            }
        };
        Reference::new(self.edges, self.crossed_at, velocity, acceleration)
    }
}
