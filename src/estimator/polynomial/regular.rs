//! The fit of a regular window, a full one of samples one a tick: sums that slide, exact in integers.
//!
//! The sums are those with the orthogonal polynomials of the time from the middle: with k the age of a sample in ticks,
//! newest first, and z = (W − 1)/2 − k, they are X = Σx, L = Σ2z·x and B = Σ12(z² − Σz²/W)·x, and the norms of z and of
//! z² − Σz²/W are `line` = W(W² − 1)/12 and `bend` = line·(W² − 4)/15. A tick makes every z one smaller; with the sample n
//! that comes and o that goes
//!
//! ```text
//! X' = X + n − o
//! L' = L − 2X + (W − 1)·n + (W + 1)·o
//! B' = B − 12(L − X) + 2(W − 1)(W − 2)·n − 2(W + 1)(W + 2)·o
//! ```
//!
//! Where the places count from is in X alone: the others are orthogonal to a constant.

use super::config::MIN_SAMPLES;
use super::fit::wide;
use super::geometry::{GAIN_FRAC, Gains};
use super::window::{CAPACITY, PLACE_FRAC};
use crate::narrowing::Narrowing;

/// What a window's length fixes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Regular {
    window: i32,
    /// What a sample that comes adds to L and B.
    line_of_new: i32,
    bend_of_new: i32,
    /// What one that goes adds to L, and takes from B.
    line_of_old: i32,
    bend_of_old: i32,
    /// L with [`LINE_BITS`] to Q.20 d/tick.
    of_velocity: Factor,
    /// B with [`BEND_BITS`] to Q.24 d/tick².
    of_acceleration: Factor,
    /// 1/W, Q.32.
    per_sample: i32,
    /// Half the mean square of z, ticks² in Q.16: what an acceleration lifts the mean place by.
    lift: i32,
    /// Variances per d² of a sample.
    pub gains: Gains,
}

/// Fractional bits of the sums with polynomials: factors are below ½ by them, and the sums stay below 2⁶¹.
const LINE_BITS: u32 = 8;
const BEND_BITS: u32 = 10;

/// X, L and B of places with [`PLACE_FRAC`] fractional bits from a base.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sums {
    pub x: i64,
    pub line: i64,
    pub bend: i64,
}

impl Sums {
    pub const NONE: Self = Self {
        x: 0,
        line: 0,
        bend: 0,
    };
}

impl Regular {
    /// For a window of `window` samples.
    pub fn new(window: u32) -> Self {
        let window = window.clamp(MIN_SAMPLES as u32, CAPACITY as u32);
        let count = f64::from(window);
        let line = count * (count * count - 1.0) / 12.0;
        let bend = line * (count * count - 4.0) / 15.0;
        let to_place = |frac: u32| libm::ldexp(1.0, frac.wrapping_sub(PLACE_FRAC).cast_signed());
        let gain = |value: f64| libm::round(libm::ldexp(value, GAIN_FRAC.cast_signed())) as u32;
        let window = window.cast_signed();
        // 2(W − 1)(W − 2), and with the signs of W turned.
        let of_bend = |window: i32| {
            let (one, other) = (window.wrapping_sub(1), window.wrapping_sub(2));
            one.wrapping_mul(other).wrapping_mul(2)
        };
        Self {
            window,
            line_of_new: window.wrapping_sub(1),
            bend_of_new: of_bend(window),
            line_of_old: window.wrapping_add(1),
            bend_of_old: of_bend(window.wrapping_neg()),
            of_velocity: Factor::new(to_place(20 - LINE_BITS) / (2.0 * line)),
            of_acceleration: Factor::new(to_place(24 - BEND_BITS) / (6.0 * bend)),
            per_sample: libm::round(libm::ldexp(1.0 / count, 32)) as i32,
            lift: libm::round(libm::ldexp(line / count, 15)) as i32,
            gains: Gains {
                velocity: gain(1.0 / line),
                acceleration: gain(4.0 / bend),
            },
        }
    }

    /// Sums over a window of `places`, newest first.
    pub fn sums(&self, places: impl Iterator<Item = i32>) -> Sums {
        let mut sums = Sums::NONE;
        let newest = self.window.wrapping_sub(1);
        for (place, age) in places.zip(0_i32..) {
            let doubled = newest.wrapping_sub(age.wrapping_mul(2));
            let bend = doubled
                .wrapping_mul(doubled)
                .wrapping_mul(3)
                .wrapping_sub(self.window.wrapping_mul(self.window))
                .wrapping_add(1);
            sums.x = sums.x.wrapping_add(i64::from(place));
            sums.line = sums.line.wrapping_add(wide(place, doubled));
            sums.bend = sums.bend.wrapping_add(wide(place, bend));
        }
        sums
    }

    /// A tick: the base of the places moves up by `way`, all samples get older, one comes, the oldest goes.
    #[inline]
    pub fn tick(&self, sums: &mut Sums, way: i32, newest: i32, oldest: i32) {
        // A product added is one instruction.
        let gone = oldest.wrapping_neg();
        let x = sums.x.wrapping_add(wide(way.wrapping_neg(), self.window));
        let apart = sums.line.wrapping_sub(x);
        sums.bend = sums
            .bend
            .wrapping_sub(apart.wrapping_mul(12))
            .wrapping_add(wide(newest, self.bend_of_new))
            .wrapping_add(wide(gone, self.bend_of_old));
        sums.line = apart
            .wrapping_sub(x)
            .wrapping_add(wide(newest, self.line_of_new))
            .wrapping_add(wide(oldest, self.line_of_old));
        sums.x = x.wrapping_add(i64::from(newest.wrapping_sub(oldest)));
    }

    /// Velocity at the middle, Q12.20 d/tick, and acceleration, Q8.24 d/tick²; they saturate.
    #[inline]
    pub const fn motion(&self, sums: &Sums) -> (i32, i32) {
        (
            self.of_velocity.apply(sums.line.wrapping_shl(LINE_BITS)),
            self.of_acceleration
                .apply(sums.bend.wrapping_shl(BEND_BITS)),
        )
    }

    /// Place at the middle, Q.16 d from the base.
    #[inline]
    pub fn place(&self, sums: &Sums, acceleration: i32) -> i64 {
        // 64 bits by 32, of which the last 32 are a fraction, and three of those are wanted.
        const WANTED_BITS: u32 = 16 - PLACE_FRAC;
        let high = wide(sums.x.wrapping_shr(32) as i32, self.per_sample);
        let low = u64::from(sums.x as u32).wrapping_mul(u64::from(self.per_sample.cast_unsigned()));
        let low = low.wrapping_shr(32 - WANTED_BITS).cast_signed();
        let mean = high.wrapping_shl(WANTED_BITS).wrapping_add(low);
        mean.wrapping_sub(wide(acceleration, self.lift).wrapping_shr(24))
    }
}

/// A factor of 32 bits and a power of two: right to 2⁻³².
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Factor {
    mantissa: u32,
    narrowing: Narrowing,
}

impl Factor {
    /// Of a factor from 2⁻³⁰ to ½: for windows of 4 to 64 samples they are from 2⁻²⁵ to 2⁻³.
    fn new(factor: f64) -> Self {
        let (_, exponent) = libm::frexp(factor);
        let bits = 32_i32.wrapping_sub(exponent);
        Self {
            mantissa: libm::round(libm::ldexp(factor, bits)) as u32,
            narrowing: Narrowing::by(bits.cast_unsigned().wrapping_sub(32)),
        }
    }

    /// The product to nearest, saturating.
    #[inline]
    const fn apply(self, value: i64) -> i32 {
        let mantissa = self.mantissa as u64;
        let high = value.wrapping_shr(32).wrapping_mul(mantissa.cast_signed());
        let low = (value as u32 as u64).wrapping_mul(mantissa);
        let low = low
            .wrapping_shr(32)
            .wrapping_add(self.narrowing.half().cast_unsigned() as u64);
        self.narrowing.apply(high.wrapping_add(low.cast_signed()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A parabola, so many ticks from the window's middle, with [`PLACE_FRAC`] bits.
    fn parabola(from_middle: f64) -> i32 {
        let exact = -17.0 + 75.0 * from_middle + 0.15 * from_middle * from_middle;
        libm::round(exact * 8192.0) as i32
    }

    #[test]
    fn a_parabola_is_found_again() {
        for window in 4..=64 {
            let regular = Regular::new(window);
            let middle = (f64::from(window) - 1.0) / 2.0;
            let sums = regular.sums((0..window).map(|age| parabola(middle - f64::from(age))));
            let (velocity, acceleration) = regular.motion(&sums);
            let place = regular.place(&sums, acceleration);
            // A place is off by 2⁻¹⁴ d.
            let errors = [
                place as f64 / 65_536.0 + 17.0,
                f64::from(velocity) / f64::from(1 << 20) - 75.0,
                f64::from(acceleration) / f64::from(1 << 24) - 0.3,
            ];
            for error in errors {
                assert!(error.abs() < 1.3e-4, "{window}: {errors:?}");
            }
        }
    }

    #[test]
    fn sums_that_slide_are_those_of_the_window() {
        for window in [4_usize, 15, 64] {
            let regular = Regular::new(window as u32);
            let place = |tick: usize| (tick * tick * 977 % 1_000_003) as i32;
            let of = |newest: usize, base: i32| {
                regular.sums((0..window).map(|age| place(newest - age) - base))
            };
            let mut sums = of(100, 0);
            let mut before = 0;
            for tick in 101..400 {
                let base = tick as i32 * 5;
                let (newest, oldest) = (place(tick) - base, place(tick - window) - base);
                regular.tick(&mut sums, base - before, newest, oldest);
                assert_eq!(sums, of(tick, base), "{window} at {tick}");
                before = base;
            }
        }
    }
}
