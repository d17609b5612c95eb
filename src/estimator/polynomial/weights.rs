//! The fit of a regular window, one sample a tick, as weighted sums.

use super::config::MIN_SAMPLES;
use super::fit::wide;
use super::geometry::GAIN_FRAC;
use super::window::{CAPACITY, PLACE_FRAC};

/// Weights of a sample: for the velocity at the newest one, and for the acceleration.
pub type Tap = [i32; 2];

/// Weights of a full window, newest sample first, for places with [`PLACE_FRAC`] fractional bits.
///
/// Each kind has its own power of two, as large as the sum of its magnitudes allows: then no sum of products with
/// 32-bit places overflows. A weight is off by at most half an LSB, 2⁻³¹ of that sum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Weights {
    pub taps: [Tap; CAPACITY],
    /// Half of what is shifted out of the sums.
    pub halves: [u32; 2],
    /// Right shifts of the sums to Q.20 d/tick and Q.24 d/tick², 1 to 31.
    pub shifts: [u32; 2],
    /// 1/W, Q.32.
    pub per_sample: u32,
    /// Half of (m² + Σz²/W), ticks² with 16 fractional bits: what is between the mean place and the newest one.
    pub mean_square: i32,
    /// Variance of the velocity per d² of a sample, at the newest sample and as its first and second power of the ticks
    /// since then; [`GAIN_FRAC`].
    pub velocity_gains: [i32; 3],
    /// Variance of the acceleration per d² of a sample, [`GAIN_FRAC`].
    pub acceleration_gain: u32,
}

/// Fractional bits of the answers.
const ANSWER_FRAC: [u32; 2] = [20, 24];

impl Weights {
    /// The least-squares quadratic over `window` samples, from the orthogonal polynomials 1, z and z² − Σz²/W of the time z
    /// from the middle; the newest sample is m = (W − 1)/2 from there.
    pub fn new(window: usize) -> Self {
        let window = window.clamp(MIN_SAMPLES, CAPACITY);
        let count = window as f64;
        let middle = (count - 1.0) / 2.0;
        let line = count * (count * count - 1.0) / 12.0;
        let mean_square = line / count;
        let bend = line * (count * count - 4.0) / 15.0;
        let mut exact = [[0.0; 2]; CAPACITY];
        for (age, tap) in exact.iter_mut().enumerate().take(window) {
            let z = middle - age as f64;
            let curvature = (z * z - mean_square) / bend;
            *tap = [z / line + 2.0 * middle * curvature, 2.0 * curvature];
        }
        let mut weights = Self {
            taps: [[0; 2]; CAPACITY],
            halves: [0; 2],
            shifts: [0; 2],
            per_sample: libm::round(libm::ldexp(1.0 / count, 32)) as u32,
            mean_square: libm::round(libm::ldexp(middle * middle + mean_square, 15)) as i32,
            // Of z/line + 2·(middle + τ)·curvature, whose two parts are orthogonal.
            velocity_gains: [
                gain(1.0 / line + 4.0 * middle * middle / bend),
                gain(8.0 * middle / bend),
                gain(4.0 / bend),
            ],
            acceleration_gain: gain(4.0 / bend).unsigned_abs(),
        };
        for (kind, frac) in ANSWER_FRAC.into_iter().enumerate() {
            weights.quantise(&exact, kind, frac);
        }
        weights
    }

    fn quantise(&mut self, exact: &[[f64; 2]; CAPACITY], kind: usize, frac: u32) {
        let of = |tap: &[f64; 2]| tap.get(kind).copied().unwrap_or(0.0);
        let total: f64 = exact.iter().map(|tap| libm::fabs(of(tap))).sum();
        let (_, exponent) = libm::frexp(total);
        let shift = 31_i32
            .wrapping_sub(exponent)
            .wrapping_add(PLACE_FRAC.cast_signed())
            .wrapping_sub(frac.cast_signed())
            .min(31);
        let bits = shift
            .wrapping_add(frac.cast_signed())
            .wrapping_sub(PLACE_FRAC.cast_signed());
        for (tap, exact) in self.taps.iter_mut().zip(exact) {
            if let Some(weight) = tap.get_mut(kind) {
                *weight = libm::round(libm::ldexp(of(exact), bits)) as i32;
            }
        }
        let shift = shift.cast_unsigned();
        if let (Some(slot), Some(half)) = (self.shifts.get_mut(kind), self.halves.get_mut(kind)) {
            *slot = shift;
            *half = 1_u32.wrapping_shl(shift.wrapping_sub(1));
        }
    }

    /// Sums of `places`, newest first: velocity at the newest, Q12.20 d/tick, and acceleration, Q8.24 d/tick²; they saturate.
    #[inline]
    pub fn weigh(&self, places: impl Iterator<Item = i32>, count: usize) -> [i32; 2] {
        let [of_velocity, of_acceleration] = self.halves;
        let (mut velocity, mut acceleration) = (i64::from(of_velocity), i64::from(of_acceleration));
        let taps = self.taps.get(..count).unwrap_or(&[]);
        for (place, [first, second]) in places.zip(taps) {
            velocity = velocity.wrapping_add(wide(*first, place));
            acceleration = acceleration.wrapping_add(wide(*second, place));
        }
        let [first, second] = self.shifts;
        [narrow(velocity, first), narrow(acceleration, second)]
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

fn gain(value: f64) -> i32 {
    libm::round(libm::ldexp(value, GAIN_FRAC.cast_signed())).min(f64::from(i32::MAX)) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_reproduce_a_parabola() {
        for window in MIN_SAMPLES..=CAPACITY {
            let weights = Weights::new(window);
            let (place, velocity, acceleration) = (-17.0, 75.0, 0.3);
            let places = (0..window).map(|age| {
                let ago = age as f64;
                let exact = place - velocity * ago + 0.5 * acceleration * ago * ago;
                (exact * 16384.0).round() as i32
            });
            let [found_velocity, found_acceleration] = weights.weigh(places, window);
            // A place is off by 2⁻¹⁵ d, a weight by 2⁻³¹ of their sum.
            let errors = [
                (f64::from(found_velocity) / f64::from(1 << 20) - velocity).abs(),
                (f64::from(found_acceleration) / f64::from(1 << 24) - acceleration).abs(),
            ];
            assert!(errors[0] < 6e-5 && errors[1] < 6e-5, "{window}: {errors:?}");
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
