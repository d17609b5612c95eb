//! The inversion of the motion of a tick.
//!
//! With u the share of the way, u = s − F(s) where F(s) = s·(1 − s)·(b + c·(1 + s)), b and c being a/2
//! and j/6 over the way. Since F is small, s ≈ u + F(u)·(1 + F′(u)), and steps of Newton's method make
//! it as exact as needed.

use super::{TICK, TIME_FRAC, Track, share};

/// The inversion of a track along which the shaft keeps going.
pub struct Inverse {
    start: i64,
    /// All ones if the shaft goes backward.
    mirror: i64,
    /// The farthest place that is reached, as a way from the start.
    last: i64,
    /// A unit is 2^`unit` of Q.32, less than 1 d; the way has 31 bits of them.
    unit: u32,
    /// 2⁶² over the way in units.
    reciprocal: u32,
    /// b + c and c of the module's description, Q.30.
    bend: i32,
    twist: i32,
    effort: Effort,
}

impl Inverse {
    /// The inversion of a track that [keeps going](Track::keeps_going).
    pub fn new(track: &Track) -> Self {
        let way = track.way();
        // The velocity outweighs the other terms four times: they are below a sixth of the way, and the
        // way has 31 bits at least.
        let unit = 33 - way.unsigned_abs().leading_zeros();
        let reciprocal = reciprocal(in_units(way.unsigned_abs(), unit));
        let relative = |term: i64| {
            let size = in_units(term.unsigned_abs(), unit);
            let share = high_product(size, reciprocal).cast_signed();
            if (term < 0) == (way < 0) {
                share
            } else {
                -share
            }
        };
        let (curvature, twist) = (
            relative(track.half_acceleration),
            relative(track.sixth_jerk),
        );
        Self {
            start: track.start,
            mirror: way >> 63,
            // A place is passed forward when it is reached, backward when it is left behind.
            last: if way < 0 { -way - 1 } else { way },
            unit,
            reciprocal,
            bend: curvature + twist,
            twist,
            effort: Effort::new(curvature.unsigned_abs() + 2 * twist.unsigned_abs()),
        }
    }

    /// True if the shaft goes backward.
    pub const fn is_backward(&self) -> bool {
        self.mirror < 0
    }

    /// When the shaft reaches `place`; `None` if it does not in this tick. A place behind it is reached
    /// at once.
    pub fn time_of(&self, place: i64) -> Option<i32> {
        let ahead = (place.wrapping_sub(self.start) ^ self.mirror).wrapping_sub(self.mirror);
        if ahead.cast_unsigned() > self.last.cast_unsigned() {
            return (ahead < 0).then_some(0);
        }
        let share = in_units(ahead.cast_unsigned(), self.unit);
        Some(self.time(high_product(share, self.reciprocal).cast_signed()))
    }

    /// s for u, both Q.30.
    fn time(&self, way: i32) -> i32 {
        let delay = self.delay(way);
        match self.effort {
            Effort::None => (way + delay).max(0),
            Effort::Newton(corrections) => self.exactly(way, delay, corrections).max(0),
        }
    }

    #[inline(never)]
    fn exactly(&self, way: i32, delay: i32, corrections: u32) -> i32 {
        let twisted = share(self.twist, way);
        let slope = share(self.bend + twisted, TICK - way - way) + share(twisted, TICK - way);
        let mut time = way + delay + share(delay, slope);
        for _ in 0..corrections {
            let miss = way + self.delay(time) - time;
            time += miss + share(miss, slope);
        }
        time
    }

    /// F(s), Q.30.
    fn delay(&self, time: i32) -> i32 {
        share(
            share(time, TICK - time),
            self.bend + share(self.twist, time),
        )
    }
}

/// What makes a time exact: to 2⁻²⁸ of a tick, 0.0003 of a timer clock at 84 MHz and 1 kHz.
enum Effort {
    /// s = u + F(u).
    None,
    /// s = u + F(u)·(1 + F′(u)), and so many steps of Newton's method.
    Newton(u32),
}

impl Effort {
    /// For a spread (Q.30) of the velocity within the tick. The first guess is right to a quarter of its
    /// square, the second one to a tenth of its third power, and each step gains two more.
    fn new(spread: u32) -> Self {
        match spread.leading_zeros() - (32 - TIME_FRAC) {
            14.. => Self::None,
            9..14 => Self::Newton(0),
            6..9 => Self::Newton(1),
            4..6 => Self::Newton(2),
            3 => Self::Newton(3),
            _ => Self::Newton(6),
        }
    }
}

/// 2⁶²/`divisor` for a divisor from 2³⁰ to 2³¹, right to 2⁻³⁰ of it.
fn reciprocal(divisor: u32) -> u32 {
    let guess = (4_611_686_018_427_387_904.0 / divisor as f32) as u32;
    let product = u64::from(guess) * u64::from(divisor);
    let miss = ((1 << 62) - product.cast_signed()) >> TIME_FRAC;
    let correction = (miss * i64::from(guess)) >> (62 - TIME_FRAC);
    guess.saturating_add_signed(correction as i32)
}

/// The high word of a product.
fn high_product(value: u32, other: u32) -> u32 {
    ((u64::from(value) * u64::from(other)) >> 32) as u32
}

/// A Q.32 size in units of 2^`unit`, less than 2³² of them; `unit` is below 32.
fn in_units(size: u64, unit: u32) -> u32 {
    // A shift of 64 bits by any number is twice as dear.
    let (high, low) = ((size >> 32) as u32, size as u32);
    low >> unit | high << 1 << (31 - unit)
}

#[cfg(test)]
mod tests {
    use super::super::tests::track;
    use super::*;
    use crate::track::to_q32;

    #[test]
    fn inversion_is_exact_for_all_motions_that_keep_going() {
        const PLACES: i32 = 40;
        let mut worst = 0.0_f64;
        for twelfth in 0..12 {
            for bend in -100..=100 {
                // From all acceleration to all jerk, up to the limit of what never turns.
                let (acceleration, jerk) = (
                    f64::from(bend * (12 - twelfth)) / 1200.0,
                    f64::from(bend * twelfth) / 1200.0,
                );
                for jerk in [jerk, -jerk] {
                    let velocity = 100.0;
                    let (arc, track) = track(
                        velocity,
                        0.249 * velocity * acceleration,
                        0.49 * velocity * jerk,
                    );
                    assert!(track.keeps_going());
                    let inverse = Inverse::new(&track);
                    for part in 0..PLACES {
                        let share = f64::from(part) / f64::from(PLACES);
                        let place = to_q32(arc.at(share).position);
                        let found = inverse.time_of(place).expect("it is within the tick");
                        let error = f64::from(found) / f64::from(TICK) - share;
                        worst = worst.max(error.abs());
                    }
                }
            }
        }
        // Rounding, and what the last correction leaves.
        assert!(worst < 2.0 / 268_435_456.0, "{worst:e}");
    }

    #[test]
    fn places_beyond_the_end_are_not_reached_and_those_behind_at_once() {
        for velocity in [3.0, -3.0, 2000.0, -0.5] {
            let (arc, track) = track(velocity, 0.0, 0.0);
            let inverse = Inverse::new(&track);
            let at = |time| to_q32(arc.at(time).position);
            assert_eq!(inverse.time_of(at(1.001)), None);
            assert_eq!(inverse.time_of(at(0.0)), Some(0));
            assert_eq!(inverse.time_of(at(-5.0)), Some(0));
        }
    }

    #[test]
    fn a_place_on_the_end_is_reached_forward_and_not_left_backward() {
        let end = |velocity| to_q32(-7.25 + velocity);
        let forward = Inverse::new(&track(2.5, 0.0, 0.0).1);
        assert!(forward.time_of(end(2.5)).is_some());
        let backward = Inverse::new(&track(-2.5, 0.0, 0.0).1);
        assert!(backward.time_of(end(-2.5)).is_none());
        assert!(backward.time_of(end(-2.5) + 1).is_some());
    }

    #[test]
    fn reciprocals_are_right_over_their_range() {
        for step in 0..=4096_u32 {
            let divisor = ((1 << 30) + step * 262_144).min(i32::MAX.cast_unsigned());
            let exact = 4_611_686_018_427_387_904.0 / f64::from(divisor);
            let error = f64::from(reciprocal(divisor)) - exact;
            assert!(error.abs() <= 3.0, "{divisor}: {error}");
        }
    }
}
