//! Whether a map belongs to the encoder that turns.
//!
//! Three edges of one phase a line apart, passed at a nearly constant speed: what the middle one lies off the mean
//! of the others shows in their times, and the map says what it should be. Eccentricity, phase, hysteresis and the
//! motion drop out; what stays is the pattern of the lines, which no two discs share. With o seen and m mapped,
//! the mean squares of o and of o − m are what edges are off without the map and with it.
//!
//! A few thousand edges suffice. Floating point of 32 bits, a division an edge: for thread mode, or for a
//! board that spares the time, not for the tick.

use super::tie::{MapState, MapTie};
use super::{Direction, ERROR_FRAC, EncoderMap, Form};
use crate::capture::{EdgeTimes, Observation};

/// Edges from one of a triple to the next.
const LINE: usize = 4;
/// Edges kept: two lines back.
const KEPT: usize = 2 * LINE;
/// Largest second difference that counts, Q.16 d: beyond it the speed was not constant.
const LARGEST: i64 = 8 << ERROR_FRAC;
/// Variance of a second difference over that of one edge.
const SECOND_DIFFERENCE_GAIN: f64 = 6.0;

/// Fewest triples for a verdict.
pub const MIN_TRIPLES: u32 = 1000;
/// Below this the lines are too regular to be told apart, d.
const FEATURELESS_D: f64 = 0.01;
/// A map that takes less than half of the error off is not this encoder's as it is now.
const LEAST_GAIN: f64 = 2.0;

/// Compares the edges of an encoder with a map. Begins anew where the motion breaks off.
#[derive(Clone, Debug)]
pub struct MapCheck<'m> {
    tie: MapTie<'m>,
    /// Times and mapped errors (Q.16 d) of the last edges, a ring.
    edges: [(u32, i32); KEPT],
    next: usize,
    /// Edges in a row, one way.
    in_row: usize,
    direction: Direction,
    count: i64,
    triples: u32,
    /// Sums of squares, Q.32 d²: of what was seen, of what the map says, of their difference.
    squares: [i64; 3],
}

/// What [`MapCheck`] found so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapFit {
    /// Triples of edges compared.
    pub triples: u32,
    /// Error of an edge against its neighbours without the map, d rms.
    pub without_d: f64,
    /// The same with the map.
    pub with_d: f64,
    /// The same as the map says it is.
    pub map_d: f64,
}

/// What that means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The map is this encoder's.
    Fits,
    /// It is not, or the lines lie elsewhere: learn it anew.
    Useless,
    /// Too few edges, no index yet, too slow, or lines too regular to be told apart.
    Unknown,
}

impl<'m> MapCheck<'m> {
    /// A check that waits for the index.
    #[must_use]
    pub const fn new(map: EncoderMap<'m>) -> Self {
        Self {
            tie: MapTie::new(map),
            edges: [(0, 0); KEPT],
            next: 0,
            in_row: 0,
            direction: Direction::Forward,
            count: 0,
            triples: 0,
            squares: [0; 3],
        }
    }

    /// Takes what a tick saw. Counts where the shaft passes a line within half a tick or faster.
    pub fn feed(&mut self, seen: &Observation<'_>) {
        let was_tied = self.tie.state() == MapState::Tied;
        self.tie.note(seen);
        let moved = seen.count.wrapping_sub(self.count);
        self.count = seen.count;
        let EdgeTimes::All([older, newer]) = seen.edge_times() else {
            if seen.delta != 0 {
                self.in_row = 0;
            }
            return;
        };
        let direction = Direction::of(seen.delta);
        let goes_on = was_tied && direction == self.direction && moved == i64::from(seen.delta);
        if !goes_on {
            self.in_row = 0;
            self.direction = direction;
        }
        if self.tie.state() != MapState::Tied {
            return;
        }
        // Count k is reached forward over boundary k, left backward over it.
        let (mut ahead, step) = match direction {
            Direction::Forward => (1_i32.wrapping_sub(seen.delta), 1),
            Direction::Backward => (seen.delta.wrapping_neg(), -1),
        };
        for &time in older.iter().chain(newer) {
            let error = self.tie.error(ahead, direction);
            self.pass((time, error), seen.elapsed);
            ahead = ahead.wrapping_add(step);
        }
    }

    /// Takes an edge; `elapsed` clocks of a tick are the longest that a triple may take.
    fn pass(&mut self, edge: (u32, i32), elapsed: u32) {
        let at = |back: usize| {
            let slot = self.next.wrapping_sub(back) % KEPT;
            self.edges.get(slot).copied().unwrap_or_default()
        };
        let (middle, first) = (at(LINE), at(KEPT));
        if self.in_row >= KEPT {
            let span = edge.0.wrapping_sub(first.0);
            if span != 0 && span <= elapsed {
                self.compare([first, middle, edge], span);
            }
        }
        if let Some(slot) = self.edges.get_mut(self.next % KEPT) {
            *slot = edge;
        }
        self.next = self.next.wrapping_add(1);
        self.in_row = self.in_row.saturating_add(1);
    }

    /// Second differences of a triple that took `span` clocks: of its times at the mean speed, and of the map.
    fn compare(&mut self, [first, middle, last]: [(u32, i32); 3], span: u32) {
        let before = middle.0.wrapping_sub(first.0);
        let after = last.0.wrapping_sub(middle.0);
        let clocks = after.wrapping_sub(before).cast_signed();
        let per_clock = (KEPT << ERROR_FRAC) as f32 / span as f32;
        // Backward the shaft comes late where an edge lies low.
        let seen = match self.direction {
            Direction::Forward => clocks as f32 * per_clock,
            Direction::Backward => -(clocks as f32) * per_clock,
        } as i64;
        let mapped = i64::from(first.1)
            .wrapping_sub(i64::from(middle.1).wrapping_mul(2))
            .wrapping_add(i64::from(last.1));
        if seen.abs() > LARGEST {
            self.in_row = 0;
            return;
        }
        let values = [seen, mapped, seen.wrapping_sub(mapped)];
        for (sum, value) in self.squares.iter_mut().zip(values) {
            *sum = sum.saturating_add(value.wrapping_mul(value));
        }
        self.triples = self.triples.saturating_add(1);
    }

    /// What was found so far.
    #[must_use]
    pub fn fit(&self) -> MapFit {
        let scale = SECOND_DIFFERENCE_GAIN * f64::from(self.triples.max(1));
        let [without_d, map_d, with_d] = self.squares.map(|sum| {
            libm::ldexp(
                libm::sqrt(sum as f64 / scale),
                (ERROR_FRAC as i32).wrapping_neg(),
            )
        });
        MapFit {
            triples: self.triples,
            without_d,
            with_d,
            map_d,
        }
    }

    /// The verdict so far.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        self.fit().verdict(self.tie.map().form())
    }
}

impl MapFit {
    /// The verdict on a map of this form; one without a byte an edge knows no lines.
    #[must_use]
    pub fn verdict(&self, form: Form) -> Verdict {
        let regular = self.without_d.max(self.map_d) < FEATURELESS_D;
        if form != Form::Full || self.triples < MIN_TRIPLES || regular {
            Verdict::Unknown
        } else if self.gain() < LEAST_GAIN {
            Verdict::Useless
        } else {
            Verdict::Fits
        }
    }

    /// By what factor the map makes errors of edges against their neighbours smaller.
    #[must_use]
    pub fn gain(&self) -> f64 {
        self.without_d / self.with_d.max(f64::MIN_POSITIVE)
    }
}
