//! When the shaft passes a place: the motion of a tick in integers, and its inversion.
//!
//! x(s) = s·(v + s·(a/2 + s·j/6)) with s in Q.30 ticks. Positions within the tick are 32-bit numbers in
//! a unit, a power of two, that makes the fastest the tick can go just below 2³⁰ of them: 2⁻²² d at 150
//! d/tick, finer below. Along a tick in which the shaft keeps going, time is found from a first guess
//! by the mean velocity and the curvature, then by corrections with the mean velocity's reciprocal.

use crate::arc::Arc;

/// The end of a tick, Q.30.
pub const TICK: i32 = 1 << 30;
/// Fractional bits of positions, d.
pub const POSITION_FRAC: u32 = 32;

const TIME_FRAC: u32 = 30;
/// Bits of the largest position within a tick.
const UNIT_BITS: i32 = 30;
/// 2⁻²⁶ of a tick: 0.001 of a timer clock at 84 MHz and 1 kHz.
const TIME_TOLERANCE: i32 = 1 << 4;
const MAX_CORRECTIONS: u32 = 16;

/// A value in d as Q.32, rounded towards zero.
pub fn to_q32(value: f64) -> i64 {
    (value * 4_294_967_296.0) as i64
}

/// The motion of a tick.
pub struct Track {
    /// Position at the start of the tick, Q.32 d.
    start: i64,
    /// A unit is 2^(`unit` − 32) d.
    unit: i32,
    velocity: i32,
    half_acceleration: i32,
    sixth_jerk: i32,
}

impl Track {
    /// The track of an arc whose velocity stays below 2²⁰ d/tick.
    pub fn new(arc: &Arc) -> Self {
        let terms = [
            arc.start.velocity,
            0.5 * arc.start.acceleration,
            arc.jerk * (1.0 / 6.0),
        ]
        .map(to_q32);
        let reach: u64 = terms.iter().map(|term| term.unsigned_abs()).sum();
        let unit = 64 - reach.leading_zeros().cast_signed() - UNIT_BITS;
        let [velocity, half_acceleration, sixth_jerk] = terms.map(|term| scaled(term, unit));
        Self {
            start: to_q32(arc.start.position),
            unit,
            velocity,
            half_acceleration,
            sixth_jerk,
        }
    }

    /// Position at `time`, Q.32 d.
    pub fn position(&self, time: i32) -> i64 {
        let travelled = i64::from(self.travelled(time));
        self.start
            + if self.unit >= 0 {
                travelled << self.unit
            } else {
                travelled >> -self.unit
            }
    }

    /// Units travelled since the start of the tick.
    fn travelled(&self, time: i32) -> i32 {
        let bend = self.half_acceleration + share(self.sixth_jerk, time);
        share(self.velocity + share(bend, time), time)
    }

    /// A place as units from the start of the tick; far ones saturate, which keeps them far.
    fn local(&self, place: i64) -> i32 {
        scaled(place - self.start, self.unit)
    }

    /// True if the velocity stays away from zero within the tick.
    pub fn never_turns(&self) -> bool {
        let change =
            2 * i64::from(self.half_acceleration).abs() + 3 * i64::from(self.sixth_jerk).abs();
        self.velocity != 0 && i64::from(self.velocity).abs() > 4 * change
    }

    /// When the shaft reaches `place` between two times of a tick in which it may stand or turn, by
    /// bisection; `forward` tells from which side it comes.
    pub fn time_of_slowly(&self, place: i64, forward: bool, from: i32, to: i32) -> i32 {
        let place = self.local(place);
        let (mut low, mut high) = (from, to);
        while high - low > 1 {
            let middle = low.midpoint(high);
            let travelled = self.travelled(middle);
            if if forward {
                travelled < place
            } else {
                travelled > place
            } {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }
}

/// The inversion of a track along which the shaft keeps going.
pub struct Inverse {
    /// 2⁵⁹ over the way of the tick, in units.
    reciprocal: i64,
    /// Curvature of time over place, Q.30: half the relative change of velocity.
    curvature: i32,
    /// A correction below this leaves an error below the tolerance.
    last_correction: i32,
}

impl Inverse {
    /// The inversion of a track that [never turns](Track::never_turns).
    pub fn new(track: &Track) -> Self {
        // The way is at least 2²⁷ units: the velocity outweighs the other terms four times.
        let reciprocal = (1_i64 << 59) / i64::from(track.travelled(TICK));
        let bend = i64::from(track.half_acceleration) + i64::from(track.sixth_jerk);
        let curvature = ((bend * reciprocal) >> (59 - TIME_FRAC)) as i32;
        // A correction leaves as much of itself as the velocity differs from its mean there: at most twice
        // this spread, to first order. The curvature would not do: its two terms may cancel.
        let spread = i64::from(track.half_acceleration).abs() + i64::from(track.sixth_jerk).abs();
        let spread = (spread * reciprocal.abs()) >> (59 - TIME_FRAC);
        let kept = (spread >> 8).max(1) as i32;
        let last_correction = (TIME_TOLERANCE << (TIME_FRAC - 8 - 2)) / kept;
        Self {
            reciprocal,
            curvature,
            last_correction,
        }
    }

    /// When the shaft reaches `place`.
    pub fn time_of(&self, track: &Track, place: i64) -> i32 {
        let place = track.local(place);
        let way = self.time(place);
        let mut time = way + share(share(self.curvature, way), TICK - way);
        for _ in 0..MAX_CORRECTIONS {
            let correction = self.time(place - track.travelled(time));
            time = (time + correction).clamp(0, TICK);
            if correction.abs() <= self.last_correction {
                break;
            }
        }
        time
    }

    /// Time for a way at the mean velocity, Q.30.
    fn time(&self, way: i32) -> i32 {
        ((i64::from(way) * self.reciprocal) >> (59 - TIME_FRAC)) as i32
    }
}

/// `value`·`time`, rounded down.
fn share(value: i32, time: i32) -> i32 {
    ((i64::from(value) * i64::from(time)) >> TIME_FRAC) as i32
}

/// A Q.32 value in units of 2^`unit`, within ±2³¹.
fn scaled(value: i64, unit: i32) -> i32 {
    let scaled = if unit >= 0 {
        value >> unit
    } else {
        let bound = i64::MAX >> (1 - unit).min(63);
        value.clamp(-bound, bound) << (-unit).min(62)
    };
    scaled.clamp(i64::from(-i32::MAX), i64::from(i32::MAX)) as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arc::State;

    fn track(velocity: f64, acceleration: f64, jerk: f64) -> (Arc, Track) {
        let arc = Arc {
            start: State {
                position: -7.25,
                velocity,
                acceleration,
            },
            jerk,
        };
        let track = Track::new(&arc);
        (arc, track)
    }

    #[test]
    fn positions_are_those_of_the_arc() {
        for (velocity, acceleration, jerk) in
            [(150.0, 0.9, -0.01), (-2000.0, 2.1, 0.1), (0.001, 1e-5, 0.0)]
        {
            let (arc, track) = track(velocity, acceleration, jerk);
            for part in 0..=10 {
                let time = TICK / 10 * part;
                let exact = arc.at(f64::from(time) / f64::from(TICK)).position;
                let found = track.position(time) as f64 / 4_294_967_296.0;
                let tolerance = 1e-8 * velocity.abs() + 1e-9;
                assert!(
                    (found - exact).abs() < tolerance,
                    "{velocity} at {part}/10: {found} for {exact}"
                );
            }
        }
    }

    #[test]
    fn inversion_finds_the_time_of_a_place() {
        for (velocity, acceleration, jerk) in [
            (150.0, 0.9, -0.01),
            (-150.0, 2.1, 0.01),
            (9.0, 1.0, 0.05),
            (0.02, 0.001, 0.0),
            (-0.0007, 0.0, 0.0),
        ] {
            let (arc, track) = track(velocity, acceleration, jerk);
            assert!(track.never_turns());
            let inverse = Inverse::new(&track);
            for part in 0..=20 {
                let share = f64::from(part) / 20.0;
                let place = to_q32(arc.at(share).position);
                let fast = f64::from(inverse.time_of(&track, place)) / f64::from(TICK);
                let slow = f64::from(track.time_of_slowly(place, velocity > 0.0, 0, TICK))
                    / f64::from(TICK);
                // The place itself is only known to 2⁻³² d.
                let tolerance = 3e-8 + 1e-9 / velocity.abs();
                assert!(
                    (fast - share).abs() < tolerance,
                    "{velocity}: {fast} for {share}"
                );
                assert!(
                    (slow - share).abs() < tolerance,
                    "{velocity}: {slow} for {share}, slowly"
                );
            }
        }
    }

    #[test]
    fn a_shaft_at_rest_has_a_track() {
        let (_, track) = track(0.0, 0.0, 0.0);
        assert!(!track.never_turns());
        assert_eq!(track.position(TICK), to_q32(-7.25));
    }
}
