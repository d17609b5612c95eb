//! When the shaft passes a place: the motion of a tick in integers, and its inversion.
//!
//! x(s) = start + s·(v + s·(a/2 + s·j/6)), s in Q.30 ticks. Places are Q.32 d modulo 2³² d: they wrap as
//! counts do, and only differences are compared.
//!
//! Where the shaft keeps going the motion is inverted ([`Inverse`]); where it is slow or may turn round,
//! time is found by bisection ([`Turning`]).

mod inverse;
mod turning;

use core::ops::Range;

use crate::arc::Arc;

pub use self::inverse::Inverse;
pub use self::turning::Turning;

/// The end of a tick, Q.30.
pub const TICK: i32 = 1 << 30;
/// Fractional bits of positions, d.
pub const POSITION_FRAC: u32 = 32;

const TIME_FRAC: u32 = 30;

/// A value in d as Q.32, rounded towards zero, modulo 2³².
///
/// By bits: the conversion and the product by a power of two are dear where there is no f64 in hardware.
pub fn to_q32(value: f64) -> i64 {
    let bits = value.to_bits();
    let exponent = (bits >> 52) as u32 & 0x7ff;
    let mantissa = bits & ((1 << 52) - 1) | 1 << 52;
    // The value is mantissa·2^(exponent − 1075).
    let magnitude = if exponent < UNSHIFTED {
        mantissa.checked_shr(UNSHIFTED - exponent)
    } else {
        mantissa.checked_shl(exponent - UNSHIFTED)
    };
    let magnitude = magnitude.unwrap_or(0).cast_signed();
    if bits.cast_signed() < 0 {
        magnitude.wrapping_neg()
    } else {
        magnitude
    }
}

/// Exponent of the f64 whose mantissa is its Q.32 value.
const UNSHIFTED: u32 = 1075 - POSITION_FRAC;

/// Speeds of a track that keeps going, Q.32 d/tick: the units of [`Inverse`] fit them.
const SPEEDS: Range<u64> = 1 << 31..1 << 52;

/// The motion of a tick, Q.32.
pub struct Track {
    start: i64,
    velocity: i64,
    half_acceleration: i64,
    sixth_jerk: i64,
}

impl Track {
    /// The track of an arc whose velocity stays below 2²⁰ d/tick.
    pub fn new(arc: &Arc) -> Self {
        Self {
            start: to_q32(arc.start.position),
            velocity: to_q32(arc.start.velocity),
            half_acceleration: to_q32(arc.start.acceleration) >> 1,
            sixth_jerk: if arc.jerk == 0.0 {
                0
            } else {
                to_q32(arc.jerk * (1.0 / 6.0))
            },
        }
    }

    /// Position at the start of the tick.
    pub const fn start(&self) -> i64 {
        self.start
    }

    /// No position of the tick is farther from its start.
    pub fn reach(&self) -> u64 {
        [self.half_acceleration, self.sixth_jerk]
            .into_iter()
            .fold(self.velocity.unsigned_abs(), |reach, term| {
                reach.saturating_add(term.unsigned_abs())
            })
    }

    /// True if the velocity stays away from zero within the tick, and is not slow either.
    pub fn keeps_going(&self) -> bool {
        let (half_acceleration, sixth_jerk) = (
            self.half_acceleration.unsigned_abs(),
            self.sixth_jerk.unsigned_abs(),
        );
        let change = half_acceleration
            .saturating_add(sixth_jerk)
            .saturating_mul(2)
            .saturating_add(sixth_jerk);
        let speed = self.velocity.unsigned_abs();
        SPEEDS.contains(&speed) && speed >> 2 > change
    }

    /// The way of the tick.
    const fn way(&self) -> i64 {
        self.velocity
            .wrapping_add(self.half_acceleration)
            .wrapping_add(self.sixth_jerk)
    }
}

/// `value`·`time`, rounded down.
fn share(value: i32, time: i32) -> i32 {
    ((i64::from(value) * i64::from(time)) >> TIME_FRAC) as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arc::State;

    pub fn track(velocity: f64, acceleration: f64, jerk: f64) -> (Arc, Track) {
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
    fn inversion_finds_the_time_of_a_place() {
        for (velocity, acceleration, jerk) in [
            (150.0, 0.9, -0.01),
            (-150.0, 2.1, 0.01),
            (9.0, 1.0, 0.05),
            (-0.6, 0.03, 0.01),
            (0.02, 0.001, 0.0),
            (-0.0007, 0.0, 0.0),
        ] {
            let (arc, track) = track(velocity, acceleration, jerk);
            assert_eq!(track.keeps_going(), velocity.abs() > 0.5);
            let inverse = track.keeps_going().then(|| Inverse::new(&track));
            let turning = Turning::new(&track);
            for part in 0..=20 {
                let share = f64::from(part) / 20.0;
                let place = to_q32(arc.at(share).position);
                // The place itself is only known to 2⁻³² d.
                let tolerance = 3e-8 + 1e-9 / velocity.abs();
                let check = |found: i32, how| {
                    let found = f64::from(found) / f64::from(TICK);
                    assert!(
                        (found - share).abs() < tolerance,
                        "{velocity}: {found} for {share} by {how}"
                    );
                };
                check(turning.time_of(place, velocity > 0.0, 0, TICK), "bisection");
                if let Some(inverse) = &inverse {
                    // The last place may be rounded to just beyond the end.
                    check(inverse.time_of(place).unwrap_or(TICK), "inversion");
                }
            }
        }
    }

    #[test]
    fn q32_is_that_of_the_float_and_wraps() {
        for value in [
            0.0, -0.0, 1.0, -1.0, 0.3, -1234.567, 2e-10, 1e-320, 1e9, -2e9,
        ] {
            assert_eq!(to_q32(value), (value * 4_294_967_296.0) as i64, "{value}");
        }
        let turn = 4_294_967_296.0;
        assert_eq!(to_q32(turn + 0.5), 1 << 31);
        assert_eq!(to_q32(-3.0 * turn - 0.5), -(1 << 31));
        assert_eq!(
            [to_q32(f64::INFINITY), to_q32(f64::NAN), to_q32(1e300)],
            [0; 3]
        );
    }
}
