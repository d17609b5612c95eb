//! What a sample's place is made of.
//!
//! A tick's sample says the mean place of its edges for their mean time. Edge k, stamped at t, is said to be at k + map(k);
//! the shaft was at x(t), which the simulator tells, and the edge really lies at k + e(k). So a sample's place is
//!
//! ```text
//! x(t)                     motion
//! + map(k) − e(k)          map: long waves (orders 1 to 150 of a revolution) and short ones
//! + k + e(k) − x(t)        timer: what rounding the stamp to a clock makes of a noiseless edge; white: the rest
//! ```
//!
//! each averaged over the edges.

use leadscrew::capture::{EdgeTimes, Observation};
use leadscrew_hal_mock::arc::State;

use super::residue::Residue;
use crate::truth::TruthTrack;

/// Parts of a sample.
pub const PARTS: usize = 5;
pub const MOTION: usize = 0;
pub const WHITE: usize = 1;
pub const SHORT: usize = 2;
pub const LONG: usize = 3;
pub const TIMER: usize = 4;

/// A sample with the parts of its place.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Time, ticks from the start.
    pub time: f64,
    /// Edges that it is the mean of.
    pub edges: usize,
    /// d.
    pub parts: [f64; PARTS],
}

/// Samples of a run with their parts.
#[derive(Debug)]
pub struct Anatomy<'r> {
    residue: &'r Residue,
    clocks_per_tick: f64,
}

impl<'r> Anatomy<'r> {
    /// Of an encoder with `residue`.
    pub const fn new(residue: &'r Residue, clocks_per_tick: f64) -> Self {
        Self {
            residue,
            clocks_per_tick,
        }
    }

    /// The sample of a tick.
    pub fn sample(
        &self,
        tick: usize,
        seen: &Observation<'_>,
        track: &TruthTrack,
    ) -> Option<Sample> {
        let backward = seen.delta < 0;
        let step = if backward { -1 } else { 1 };
        let last = seen.count + i64::from(backward);
        let mut sum = Sample {
            time: 0.0,
            edges: 0,
            parts: [0.0; PARTS],
        };
        let mut add = |boundary: i64, age: u32| {
            let edge = self.edge(tick, boundary, age, backward, track)?;
            sum.edges += 1;
            sum.time += edge.time;
            for (sum, part) in sum.parts.iter_mut().zip(edge.parts) {
                *sum += part;
            }
            Some(())
        };
        match seen.edge_times() {
            EdgeTimes::None => return None,
            EdgeTimes::Last { age } => add(last, age)?,
            EdgeTimes::All([older, newer]) => {
                let first = last - step * (i64::from(seen.delta.abs()) - 1);
                for (time, ahead) in older.iter().chain(newer).zip(0_i64..) {
                    let age = (seen.sampled_at as u32).wrapping_sub(*time);
                    add(first + step * ahead, age)?;
                }
            }
        }
        let count = sum.edges as f64;
        sum.time /= count;
        sum.parts = sum.parts.map(|part| part / count);
        Some(sum)
    }

    fn edge(
        &self,
        tick: usize,
        boundary: i64,
        age: u32,
        backward: bool,
        track: &TruthTrack,
    ) -> Option<Sample> {
        let way = usize::from(backward);
        let truth = &self.residue.truth[way];
        let at = boundary.rem_euclid(truth.len() as i64) as usize;
        let left = self.residue.map[way][at] - truth[at];
        let long = self.residue.long[way][at];
        let lag = f64::from(age) / self.clocks_per_tick;
        let shaft = track.before(tick, lag)?;
        let place = boundary as f64 + truth[at];
        let timer = self.rounding(tick, lag, place, &shaft, track);
        Some(Sample {
            time: tick as f64 - lag,
            edges: 1,
            parts: [
                shaft.position,
                place - shaft.position - timer,
                left - long,
                long,
                timer,
            ],
        })
    }

    /// What rounding the stamp to a clock makes of the edge at `place`, had it no noise.
    fn rounding(
        &self,
        tick: usize,
        lag: f64,
        place: f64,
        shaft: &State,
        track: &TruthTrack,
    ) -> f64 {
        // Near a standstill the noise moves an edge far in time, and a clock is nothing.
        if shaft.velocity.abs() < 0.1 {
            return 0.0;
        }
        let mut exact = lag - (place - shaft.position) / shaft.velocity;
        if let Some(near) = track.before(tick, exact.max(0.0)) {
            let off = place - near.position - near.velocity * (exact.max(0.0) - exact);
            exact -= off / near.velocity;
        }
        // The stamp is the last whole clock; half a clock of it is the same for all.
        let clocks = exact * self.clocks_per_tick;
        shaft.velocity * (clocks.ceil() - clocks - 0.5) / self.clocks_per_tick
    }
}
