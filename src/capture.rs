//! From the wrapping words of the hardware to counts and times without wrap.
//!
//! The counter and the timer of a board wrap at 32 bits; this is the one place where they are
//! unwrapped to 64. Lost edges, overruns and illegal transitions are counted here, never dropped.

use crate::hal::{Capture, Latch};
use crate::units::Position;

/// Largest motion in one tick that the velocity format carries, counts. A larger one is clamped to
/// this in [`Observation::delta`] and counted in [`CaptureHealth::overspeed_ticks`].
pub const MAX_DELTA: i32 = 2047;

/// A latch with count and time unwrapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnwrappedLatch {
    /// Count at the event since start-up.
    pub count: i64,
    /// Timer clocks at the event since the timer's zero before the first capture.
    pub time: i64,
}

/// Times of the edges of a tick, as far as they tell something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeTimes<'a> {
    /// No edge whose place is known: none at all, a reversal within the tick, or a count that is in doubt.
    None,
    /// The last edge alone.
    Last {
        /// Timer clocks before the sample.
        age: u32,
    },
    /// All edges, as many as the count moved, oldest first in two parts.
    All([&'a [u32]; 2]),
}

/// One capture, unwrapped: what an estimator sees of a tick.
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// Count at the sampling instant, without wrap.
    pub count: i64,
    /// Counts since the previous sample, within ±[`MAX_DELTA`]; 0 in the first tick.
    pub delta: i32,
    /// Timer clocks at the sampling instant, without wrap.
    pub sampled_at: i64,
    /// Timer clocks since the previous sample; 0 in the first tick.
    pub elapsed: u32,
    /// True where each edge's position can be inferred: as many edge times as the count moved, none lost.
    pub edges_complete: bool,
    /// The count is in doubt, or more edges came than it moved.
    is_doubtful: bool,
    capture: &'a Capture<'a>,
}

impl<'a> Observation<'a> {
    /// Position that the count alone gives: the middle of the discrete, count + ½.
    #[must_use]
    pub fn position(&self) -> Position {
        Position::from_bits(
            self.count.wrapping_shl(Position::FRAC_NBITS) | (1 << (Position::FRAC_NBITS - 1)),
        )
    }

    /// Timer clocks from the newest edge to the sample, if an edge came in this tick.
    #[must_use]
    pub fn since_last_edge(&self) -> Option<u32> {
        let sampled_at = self.capture.sampled_at;
        self.capture
            .last_edge_at
            .map(|at| sampled_at.wrapping_sub(at))
    }

    /// What the edge times of this tick are good for.
    ///
    /// More times than counts are a reversal, whose edges cannot be told apart; fewer are edges whose time
    /// was lost, and the last one stands at the new count all the same. After an illegal transition the
    /// count itself is in doubt.
    #[must_use]
    #[inline]
    pub fn edge_times(&self) -> EdgeTimes<'a> {
        if self.edges_complete && self.delta != 0 {
            return EdgeTimes::All(self.capture.edges);
        }
        if self.delta == 0 || self.is_doubtful {
            return EdgeTimes::None;
        }
        self.since_last_edge()
            .map_or(EdgeTimes::None, |age| EdgeTimes::Last { age })
    }

    /// Times of all edges of this tick as the hardware gave them, oldest first, in two parts.
    #[must_use]
    pub const fn edges(&self) -> [&'a [u32]; 2] {
        self.capture.edges
    }

    /// True if the index pulse came in this tick.
    #[inline]
    #[must_use]
    pub const fn has_index(&self) -> bool {
        self.capture.index.is_some()
    }

    /// The index pulse, if it came in this tick.
    #[must_use]
    pub fn index(&self) -> Option<UnwrappedLatch> {
        self.capture.index.map(|latch| self.unwrap_latch(latch))
    }

    /// True if the probe triggered in this tick.
    #[inline]
    #[must_use]
    pub const fn has_probe(&self) -> bool {
        self.capture.probe.is_some()
    }

    /// True if the probe is deflected at the sampling instant.
    #[inline]
    #[must_use]
    pub const fn is_touching(&self) -> bool {
        self.capture.touching
    }

    /// The probe, if it triggered in this tick.
    #[must_use]
    pub fn probe(&self) -> Option<UnwrappedLatch> {
        self.capture.probe.map(|latch| self.unwrap_latch(latch))
    }

    /// The home switch, if it was actuated in this tick.
    #[must_use]
    pub fn home(&self) -> Option<UnwrappedLatch> {
        self.capture.home.map(|latch| self.unwrap_latch(latch))
    }

    /// A latch lies before the sample just taken, by less than half the range of either counter.
    fn unwrap_latch(&self, latch: Latch) -> UnwrappedLatch {
        let back = self.capture.count.wrapping_sub(latch.count).cast_signed();
        let age = self.capture.sampled_at.wrapping_sub(latch.time);
        UnwrappedLatch {
            count: self.count.wrapping_sub(i64::from(back)),
            time: self.sampled_at.wrapping_sub(i64::from(age)),
        }
    }
}

/// Totals of what went wrong at the encoder since start-up; they stop at their maximum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CaptureHealth {
    /// Illegal transitions.
    pub illegal: u32,
    /// Ticks in which edge times were lost.
    pub overrun_ticks: u32,
    /// Ticks in which the edge times do not explain the count (a reversal, or edges lost).
    pub ambiguous_ticks: u32,
    /// Ticks in which the count moved by more than [`MAX_DELTA`].
    pub overspeed_ticks: u32,
}

/// Unwraps captures; the first one sets the origin and counts as standing still.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unwrapper {
    count: i64,
    time: i64,
    primed: bool,
    health: CaptureHealth,
}

impl Unwrapper {
    /// An unwrapper that takes its origin from the first capture: the count as a signed number, the
    /// time as it is.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// What went wrong so far.
    #[must_use]
    pub const fn health(&self) -> CaptureHealth {
        self.health
    }

    /// Unwraps one capture. Two captures may lie at most 2³¹ − 1 counts and 2³² − 1 timer clocks apart.
    #[inline]
    pub fn unwrap<'a>(&mut self, capture: &'a Capture<'a>) -> Observation<'a> {
        if !self.primed {
            self.prime(capture);
        }
        // The low words of the 64-bit totals are the previous readings themselves.
        let moved = capture.count.wrapping_sub(self.count as u32).cast_signed();
        let elapsed = capture.sampled_at.wrapping_sub(self.time as u32);
        self.count = self.count.wrapping_add(i64::from(moved));
        self.time = self.time.wrapping_add(i64::from(elapsed));

        let [older, newer] = capture.edges;
        let edge_times = older.len().wrapping_add(newer.len());
        let observation = Observation {
            count: self.count,
            delta: moved,
            sampled_at: self.time,
            elapsed,
            edges_complete: edge_times == moved.unsigned_abs() as usize,
            is_doubtful: false,
            capture,
        };
        // One branch for all that should not be.
        let trouble = u32::from(capture.illegal) | u32::from(capture.overrun);
        let ambiguous = edge_times != 0 && !observation.edges_complete;
        if trouble != 0 || ambiguous || moved.unsigned_abs() > MAX_DELTA.unsigned_abs() {
            // A copy, so that the other one is made where it goes.
            let mut troubled = observation;
            self.note_trouble(&mut troubled, ambiguous);
            return troubled;
        }
        observation
    }

    #[cold]
    #[inline(never)]
    fn prime(&mut self, capture: &Capture<'_>) {
        self.primed = true;
        self.count = i64::from(capture.count.cast_signed());
        self.time = i64::from(capture.sampled_at);
    }

    #[cold]
    #[inline(never)]
    fn note_trouble(&mut self, observation: &mut Observation<'_>, ambiguous: bool) {
        let Capture {
            illegal, overrun, ..
        } = *observation.capture;
        let moved = observation.delta;
        observation.delta = moved.clamp(-MAX_DELTA, MAX_DELTA);
        let overspeed = observation.delta != moved;
        observation.edges_complete &= !overrun && illegal == 0 && !overspeed;
        let [older, newer] = observation.edges();
        let edge_times = older.len().wrapping_add(newer.len());
        let is_reversed = edge_times > observation.delta.unsigned_abs() as usize;
        observation.is_doubtful = illegal != 0 || is_reversed;

        let health = &mut self.health;
        health.illegal = health.illegal.saturating_add(u32::from(illegal));
        health.overrun_ticks = health.overrun_ticks.saturating_add(u32::from(overrun));
        health.ambiguous_ticks = health.ambiguous_ticks.saturating_add(u32::from(ambiguous));
        health.overspeed_ticks = health.overspeed_ticks.saturating_add(u32::from(overspeed));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(count: u32, sampled_at: u32) -> Capture<'static> {
        Capture {
            count,
            sampled_at,
            ..Capture::default()
        }
    }

    #[test]
    fn the_first_capture_is_the_origin() {
        let capture = at(u32::MAX, 77);
        let first = Unwrapper::new().unwrap(&capture);
        assert_eq!(
            (first.count, first.delta, first.sampled_at, first.elapsed),
            (-1, 0, 77, 0)
        );
        assert_eq!(first.position(), Position::from_num(-0.5));
    }

    #[test]
    fn both_counters_wrap_both_ways() {
        let mut unwrapper = Unwrapper::new();
        unwrapper.unwrap(&at(0x7fff_fffe, 0xffff_ff00));
        let capture = at(0x8000_0002, 0x100);
        let over = unwrapper.unwrap(&capture);
        assert_eq!((over.delta, over.count), (4, 0x8000_0002));
        assert_eq!((over.elapsed, over.sampled_at), (0x200, 0x1_0000_0100));
        let capture = at(0x7fff_ffff, 0x200);
        let back = unwrapper.unwrap(&capture);
        assert_eq!((back.delta, back.count), (-3, 0x7fff_ffff));
    }

    #[test]
    fn many_turns_of_the_counter_keep_the_exact_total() {
        let mut unwrapper = Unwrapper::new();
        unwrapper.unwrap(&at(0, 0));
        let stride = 0x4000_0001_u32;
        for turn in 1..=1000_u32 {
            let capture = at(stride.wrapping_mul(turn), stride.wrapping_mul(turn));
            let seen = unwrapper.unwrap(&capture);
            assert_eq!(seen.count, i64::from(stride) * i64::from(turn));
            assert_eq!(seen.sampled_at, i64::from(stride) * i64::from(turn));
            assert_eq!(seen.delta, MAX_DELTA);
        }
        assert_eq!(unwrapper.health().overspeed_ticks, 1000);
    }

    #[test]
    fn edge_times_explain_the_count_or_are_ambiguous() {
        let mut unwrapper = Unwrapper::new();
        unwrapper.unwrap(&at(10, 0));
        let times = [5, 6, 7];
        let edges = [&times[..2], &times[2..]];
        let forward = Capture {
            edges,
            last_edge_at: Some(7),
            ..at(13, 10)
        };
        let seen = unwrapper.unwrap(&forward);
        assert!(seen.edges_complete);
        assert_eq!(seen.since_last_edge(), Some(3));
        let reversal = Capture {
            edges,
            ..at(14, 20)
        };
        assert!(!unwrapper.unwrap(&reversal).edges_complete);
        assert_eq!(unwrapper.health().ambiguous_ticks, 1);
        let lost = Capture {
            edges,
            overrun: true,
            illegal: 2,
            ..at(17, 30)
        };
        assert!(!unwrapper.unwrap(&lost).edges_complete);
        let health = unwrapper.health();
        assert_eq!(
            (health.illegal, health.overrun_ticks, health.ambiguous_ticks),
            (2, 1, 1)
        );
    }

    #[test]
    fn latches_are_unwrapped_relative_to_the_sample() {
        let mut unwrapper = Unwrapper::new();
        unwrapper.unwrap(&at(0xffff_fff0, 0xffff_fff0));
        let index = Some(Latch {
            count: 0xffff_fffe,
            time: 0xffff_fffd,
        });
        let probe = Some(Latch { count: 3, time: 2 });
        let capture = Capture {
            index,
            probe,
            ..at(4, 4)
        };
        let seen = unwrapper.unwrap(&capture);
        assert_eq!(seen.count, 4);
        assert_eq!(
            seen.index(),
            Some(UnwrappedLatch {
                count: -2,
                time: 0xffff_fffd
            })
        );
        assert_eq!(
            seen.probe(),
            Some(UnwrappedLatch {
                count: 3,
                time: 0x1_0000_0002
            })
        );
    }
}
