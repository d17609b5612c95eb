//! The motion of a tick in which the shaft is slow or turns round.

use super::{TICK, Track, share};

/// Bits of the largest position within a tick.
const UNIT_BITS: i32 = 30;

/// The track of a tick in which the shaft may stand or turn.
pub struct Turning<'a> {
    track: &'a Track,
    /// A unit is 2^`unit` of Q.32; the fastest that the tick can go is just below 2³⁰ of them.
    unit: i32,
    velocity: i32,
    half_acceleration: i32,
    sixth_jerk: i32,
}

impl<'a> Turning<'a> {
    /// Any track.
    pub fn new(track: &'a Track) -> Self {
        let unit = 64 - track.reach().leading_zeros().cast_signed() - UNIT_BITS;
        Self {
            track,
            unit,
            velocity: scaled(track.velocity, unit),
            half_acceleration: scaled(track.half_acceleration, unit),
            sixth_jerk: scaled(track.sixth_jerk, unit),
        }
    }

    /// Position at `time`, Q.32 d.
    pub fn position(&self, time: i32) -> i64 {
        let travelled = if time == TICK {
            self.track.way()
        } else {
            let travelled = i64::from(self.travelled(time));
            if self.unit >= 0 {
                travelled << self.unit
            } else {
                travelled >> -self.unit
            }
        };
        self.track.start.wrapping_add(travelled)
    }

    /// When the shaft reaches `place` between two times, by bisection; `forward` tells from which side it
    /// comes.
    pub fn time_of(&self, place: i64, forward: bool, from: i32, to: i32) -> i32 {
        // Far ones saturate, which keeps them far.
        let place = scaled(place.wrapping_sub(self.track.start), self.unit);
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

    /// Units travelled since the start of the tick.
    fn travelled(&self, time: i32) -> i32 {
        let bend = self.half_acceleration + share(self.sixth_jerk, time);
        share(self.velocity + share(bend, time), time)
    }
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
    use super::super::tests::track;
    use super::*;
    use crate::track::to_q32;

    #[test]
    fn positions_are_those_of_the_arc() {
        for (velocity, acceleration, jerk) in
            [(150.0, 0.9, -0.01), (-2000.0, 2.1, 0.1), (0.001, 1e-5, 0.0)]
        {
            let (arc, track) = track(velocity, acceleration, jerk);
            for part in 0..=10 {
                let time = TICK / 10 * part;
                let exact = arc.at(f64::from(time) / f64::from(TICK)).position;
                let found = Turning::new(&track).position(time) as f64 / 4_294_967_296.0;
                let tolerance = 1e-8 * velocity.abs() + 1e-9;
                assert!(
                    (found - exact).abs() < tolerance,
                    "{velocity} at {part}/10: {found} for {exact}"
                );
            }
        }
    }

    #[test]
    fn a_shaft_at_rest_has_a_track() {
        let (_, track) = track(0.0, 0.0, 0.0);
        assert!(!track.keeps_going());
        assert_eq!(Turning::new(&track).position(TICK), to_q32(-7.25));
        assert_eq!(Turning::new(&track).position(TICK / 2), to_q32(-7.25));
    }
}
