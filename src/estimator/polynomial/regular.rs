//! The fit of a regular window, a full one of samples one a tick: sums that slide, exact in integers.
//!
//! With k the age of a sample in ticks, newest first, a tick makes every age one larger: Σ(k + 1)²x = Σk²x + 2Σkx + Σx,
//! and so on. From the sums follow those with the orthogonal polynomials of the time from the middle,
//! z = (W − 1)/2 − k and z² − Σz²/W, whose norms are `line` = W(W² − 1)/12 and `bend` = line·(W² − 4)/15.

use super::config::MIN_SAMPLES;
use super::fit::{times, wide};
use super::geometry::GAIN_FRAC;
use super::window::{CAPACITY, PLACE_FRAC};

/// What a window's length fixes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Regular {
    window: i32,
    /// Σk and Σk² over the window.
    ages: i32,
    square_ages: i32,
    /// W².
    square: i32,
    /// Of Σx in Σ2z·x; of Σk·x it is −2, both with [`LINE_BITS`].
    line_of_x: u32,
    /// Of Σx and −Σk·x in Σ12(z² − Σz²/W)·x; of Σk²·x it is 12, all with [`BEND_BITS`].
    bend_of_x: u32,
    bend_of_kx: u32,
    /// Σ2z·x with [`LINE_BITS`] to Q.20 d/tick.
    of_velocity: Factor,
    /// Σ12(z² − Σz²/W)·x with [`BEND_BITS`] to Q.24 d/tick².
    of_acceleration: Factor,
    /// 1/W, Q.32.
    per_sample: i32,
    /// Half the mean square of z, ticks² in Q.16: what an acceleration lifts the mean place by.
    lift: i32,
    /// Variance of the velocity at the middle per d² of a sample, [`GAIN_FRAC`].
    pub velocity_gain: u32,
    /// Variance of the acceleration per d² of a sample, [`GAIN_FRAC`].
    pub acceleration_gain: u32,
}

/// Fractional bits of the sums with polynomials: factors are below ½ by them, and the sums stay below 2⁶¹.
const LINE_BITS: u32 = 8;
const BEND_BITS: u32 = 10;

/// Σx, Σk·x and Σk²·x of places with [`PLACE_FRAC`] fractional bits from a base.
#[derive(Clone, Copy, Debug, Default)]
pub struct AgeSums {
    pub x: i64,
    pub kx: i64,
    pub k2x: i64,
}

impl AgeSums {
    pub const NONE: Self = Self {
        x: 0,
        kx: 0,
        k2x: 0,
    };

    /// Of places newest first.
    pub fn of(places: impl Iterator<Item = i32>) -> Self {
        let mut sums = Self::NONE;
        for (place, age) in places.zip(0_i32..) {
            sums.x = sums.x.wrapping_add(i64::from(place));
            sums.kx = sums.kx.wrapping_add(wide(place, age));
            sums.k2x = sums.k2x.wrapping_add(wide(place, age.wrapping_mul(age)));
        }
        sums
    }
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
        let span = window.wrapping_sub(1);
        let constant = span.wrapping_mul(window.wrapping_sub(2)).wrapping_mul(2);
        let window = window.cast_signed();
        let ages = window.wrapping_mul(window.wrapping_sub(1)).wrapping_shr(1);
        Self {
            window,
            ages,
            square_ages: (libm::round(line + f64::from(ages) * (count - 1.0) / 2.0)) as i32,
            square: window.wrapping_mul(window),
            line_of_x: span.wrapping_shl(LINE_BITS),
            bend_of_x: constant.wrapping_shl(BEND_BITS),
            bend_of_kx: span.wrapping_mul(12).wrapping_shl(BEND_BITS),
            of_velocity: Factor::new(to_place(20 - LINE_BITS) / (2.0 * line)),
            of_acceleration: Factor::new(to_place(24 - BEND_BITS) / (6.0 * bend)),
            per_sample: libm::round(libm::ldexp(1.0 / count, 32)) as i32,
            lift: libm::round(libm::ldexp(line / count, 15)) as i32,
            velocity_gain: gain(1.0 / line),
            acceleration_gain: gain(4.0 / bend),
        }
    }

    /// Moves the base of the places up by `way`.
    #[inline]
    pub fn move_base(&self, sums: &mut AgeSums, way: i32) {
        // A product added is one instruction.
        let back = way.wrapping_neg();
        sums.x = sums.x.wrapping_add(wide(back, self.window));
        sums.kx = sums.kx.wrapping_add(wide(back, self.ages));
        sums.k2x = sums.k2x.wrapping_add(wide(back, self.square_ages));
    }

    /// A tick: all samples get older, one comes, the oldest goes.
    #[inline]
    pub fn exchange(&self, sums: &mut AgeSums, newest: i32, oldest: i32) {
        let AgeSums { x, kx, k2x } = *sums;
        let gone = oldest.wrapping_neg();
        let older = kx.wrapping_add(x);
        sums.k2x = k2x
            .wrapping_add(kx)
            .wrapping_add(older)
            .wrapping_add(wide(gone, self.square));
        sums.kx = older.wrapping_add(wide(gone, self.window));
        sums.x = x.wrapping_add(i64::from(newest.wrapping_sub(oldest)));
    }

    /// Velocity at the middle, Q12.20 d/tick, and acceleration, Q8.24 d/tick²; they saturate.
    #[inline]
    pub fn motion(&self, sums: &AgeSums) -> (i32, i32) {
        let AgeSums { x, kx, k2x } = *sums;
        // 2z and 12(z² − Σz²/W) by powers of k.
        let line = multiple(x, self.line_of_x).wrapping_sub(kx.wrapping_shl(LINE_BITS + 1));
        let bend = multiple(x, self.bend_of_x)
            .wrapping_sub(multiple(kx, self.bend_of_kx))
            .wrapping_add(multiple(k2x, 12 << BEND_BITS));
        (
            self.of_velocity.apply(line),
            self.of_acceleration.apply(bend),
        )
    }

    /// Place at the middle, Q.16 d from the base.
    #[inline]
    pub fn place(&self, sums: &AgeSums, acceleration: i32) -> i64 {
        // 64 bits by 32, of which the last 32 are a fraction, and three of those are wanted.
        const WANTED_BITS: u32 = 16 - PLACE_FRAC;
        let high = times(sums.x.wrapping_shr(32), self.per_sample);
        let low = u64::from(sums.x as u32).wrapping_mul(u64::from(self.per_sample.cast_unsigned()));
        let low = low.wrapping_shr(32 - WANTED_BITS).cast_signed();
        let mean = high.wrapping_shl(WANTED_BITS).wrapping_add(low);
        mean.wrapping_sub(wide(acceleration, self.lift).wrapping_shr(24))
    }
}

/// `value`·`factor` where it fits; cheaper than with a signed factor.
#[inline]
const fn multiple(value: i64, factor: u32) -> i64 {
    value.wrapping_mul(factor as i64)
}

/// A factor of 32 bits and a power of two: right to 2⁻³².
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Factor {
    mantissa: u32,
    /// Right shift of the product's words but the last, 1 to 31.
    shift: u32,
}

impl Factor {
    /// Of a factor from 2⁻³⁰ to ½: for windows of 4 to 64 samples they are from 2⁻²⁵ to 2⁻³.
    fn new(factor: f64) -> Self {
        let (_, exponent) = libm::frexp(factor);
        let bits = 32_i32.wrapping_sub(exponent);
        Self {
            mantissa: libm::round(libm::ldexp(factor, bits)) as u32,
            shift: bits.cast_unsigned().wrapping_sub(32).clamp(1, 31),
        }
    }

    /// The product to nearest, saturating.
    #[inline]
    fn apply(self, value: i64) -> i32 {
        let mantissa = u64::from(self.mantissa);
        let high = value.wrapping_shr(32).wrapping_mul(mantissa.cast_signed());
        let low = u64::from(value as u32).wrapping_mul(mantissa);
        let half = 1_u32.wrapping_shl(self.shift.wrapping_sub(1));
        let low = low.wrapping_shr(32).wrapping_add(u64::from(half));
        narrow(high.wrapping_add(low.cast_signed()), self.shift)
    }
}

/// `sum`/2^`shift`, rounded down, saturating; `shift` is 1 to 31.
#[inline]
fn narrow(sum: i64, shift: u32) -> i32 {
    let most = 1_i32.wrapping_shl(shift.wrapping_sub(1));
    let high = sum.wrapping_shr(32) as i32;
    if high >= most {
        i32::MAX
    } else if high < most.wrapping_neg() {
        i32::MIN
    } else {
        let low = (sum as u32).wrapping_shr(shift);
        high.wrapping_shl(32_u32.wrapping_sub(shift)) | low.cast_signed()
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
            let sums = AgeSums::of((0..window).map(|age| parabola(middle - f64::from(age))));
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
                AgeSums::of((0..window).map(|age| place(newest - age) - base))
            };
            let mut sums = of(100, 0);
            for tick in 101..400 {
                let base = tick as i32 * 5;
                regular.move_base(&mut sums, 5 + if tick == 101 { 500 } else { 0 });
                regular.exchange(&mut sums, place(tick) - base, place(tick - window) - base);
                let exact = of(tick, base);
                assert_eq!(
                    (sums.x, sums.kx, sums.k2x),
                    (exact.x, exact.kx, exact.k2x),
                    "{window} at {tick}"
                );
            }
        }
    }

    #[test]
    fn what_does_not_fit_saturates() {
        assert_eq!(narrow(i64::MAX, 25), i32::MAX);
        assert_eq!(narrow(i64::MIN, 25), i32::MIN);
        assert_eq!(narrow((1 << 56) - 1, 25), i32::MAX);
        assert_eq!(narrow(1 << 56, 25), i32::MAX);
        assert_eq!(narrow(-(1 << 56), 25), i32::MIN);
        assert_eq!(narrow(-1, 31), -1);
        assert_eq!(narrow(3 << 30, 31), 1);
    }
}
