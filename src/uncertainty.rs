//! How well an edge is known: the noise that estimators state their variances from.
//!
//! ```text
//! per edge, white         σ² = σ_x² + σ_p² + v²·(σ_t² + clock²/12)      d²
//! of the velocity, long   (v·slope)²                                    (d/tick)²
//! of the acceleration     (v²·curvature)²                               (d/tick²)²
//! ```
//!
//! σ_x and σ_t do not repeat; σ_p is what is not known of an edge's place and differs from edge to edge. What
//! is not known of its place and changes slowly along the revolution acts through its derivatives: e(x) moves
//! the velocity by v·e′ and the acceleration by v²·e″, whatever the window. A learned map says what it leaves of both.

use crate::parameter_table;
use crate::parameter_table::ParameterTable;
use crate::units::{RangeError, Variance};

parameter_table! {
    /// Errors of an encoder's edges. The default is an encoder whose map is not known.
    pub struct EdgeErrors {
        /// Noise of an edge's place, which does not repeat
        edge_noise_d: 0.005, "d", 0.0..=0.2;
        /// Noise of an edge's time stamp
        time_noise_s: 2e-8, "s", 0.0..=1e-4;
        /// Standard deviation of an edge's place within a line or so
        placement_d: 0.2, "d", 0.0..=0.25;
        /// Slope of the slow error along the revolution, rms
        slope: 7e-4, "d/d", 0.0..=0.0009;
        /// Curvature of the slow error along the revolution, rms
        curvature_per_d: 5e-7, "1/d", 0.0..=1e-5;
    }
}

/// Variance of a place, d²: Q2.30.
pub const PLACE_FRAC: u32 = 30;
const TIME_FRAC: u32 = 40;
// With these a product's high word is a deviation with half a variance's bits.
const SLOPE_FRAC: u32 = 36;
const CURVATURE_FRAC: u32 = 48;
/// Fractional bits of v² in (d/tick)²: v is at most 2¹¹.
const SQUARE_FRAC: u32 = 8;

/// [`EdgeErrors`] as the tick uses them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeNoise {
    /// σ_x², d².
    unrepeatable: u32,
    /// σ_x² + σ_p², d².
    place: u32,
    /// Variance of a time stamp, ticks².
    time: u32,
    slope: u32,
    curvature: u32,
}

impl EdgeNoise {
    /// Quantises `errors` for a timer of `timer_hz` at a control rate of `tick_hz`; these two have been checked.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(errors: &EdgeErrors, tick_hz: f64, timer_hz: f64) -> Result<Self, RangeError> {
        errors.check()?;
        let stamp_s = errors.time_noise_s;
        let clock_s = 1.0 / timer_hz;
        let time_s2 = stamp_s * stamp_s + clock_s * clock_s / 12.0;
        let noise = Self {
            unrepeatable: scaled(errors.edge_noise_d * errors.edge_noise_d, PLACE_FRAC),
            place: 0,
            time: scaled(time_s2 * tick_hz * tick_hz, TIME_FRAC),
            slope: 0,
            curvature: 0,
        };
        Ok(noise.with_placement(errors.placement_d, errors.slope, errors.curvature_per_d))
    }

    /// The same edges with another knowledge of their places: σ_p in d, slope in d/d, curvature in 1/d, each
    /// cut off at the range that [`EdgeErrors`] gives it.
    #[must_use]
    pub fn with_placement(&self, placement_d: f64, slope: f64, curvature_per_d: f64) -> Self {
        let placement = placement_d.min(0.25);
        Self {
            place: self
                .unrepeatable
                .saturating_add(scaled(placement * placement, PLACE_FRAC)),
            slope: scaled(slope.min(0.0009), SLOPE_FRAC),
            curvature: scaled(curvature_per_d.min(1e-5), CURVATURE_FRAC),
            ..*self
        }
    }

    /// Variance of an edge's place at `velocity` (Q12.20 d/tick), d² with [`PLACE_FRAC`] fractional bits.
    #[inline]
    #[must_use]
    pub const fn of_edge(&self, velocity: i32) -> u32 {
        let timing = (square(velocity) as u64)
            .wrapping_mul(self.time as u64)
            .wrapping_shr(SQUARE_FRAC + TIME_FRAC - PLACE_FRAC);
        let sum = timing.wrapping_add(self.place as u64);
        if sum > u32::MAX as u64 {
            u32::MAX
        } else {
            sum as u32
        }
    }

    /// Variance of a velocity (Q12.20 d/tick) that the slow error brings.
    #[inline]
    #[must_use]
    pub const fn of_velocity(&self, velocity: i32) -> Variance {
        let error = (velocity.unsigned_abs() as u64)
            .wrapping_mul(self.slope as u64)
            .wrapping_shr(20 + SLOPE_FRAC - Variance::FRAC_NBITS / 2);
        Variance::from_bits(error.wrapping_mul(error))
    }

    /// Variance of a place that the slow error brings, 2⁻⁴⁸ d²: what an error of this slope amounts to whose wave
    /// is `reach` d over a radian. The longest wave on a revolution counts for all.
    #[must_use]
    pub const fn of_place(&self, reach: u32) -> u64 {
        let error = (self.slope as u64)
            .wrapping_mul(reach as u64)
            .wrapping_shr(SLOPE_FRAC - 24);
        let error = if error > u32::MAX as u64 {
            u32::MAX as u64
        } else {
            error
        };
        error.wrapping_mul(error)
    }

    /// Variance of an acceleration at `velocity` (Q12.20 d/tick) that the slow error brings.
    #[inline]
    #[must_use]
    pub const fn of_acceleration(&self, velocity: i32) -> Variance {
        let error = (square(velocity) as u64)
            .wrapping_mul(self.curvature as u64)
            .wrapping_shr(SQUARE_FRAC + CURVATURE_FRAC - Variance::FRAC_NBITS / 2);
        Variance::from_bits(error.wrapping_mul(error))
    }
}

/// `value` with `frac` fractional bits; it is not negative and fits.
fn scaled(value: f64, frac: u32) -> u32 {
    libm::round(libm::ldexp(value, frac.cast_signed())) as u32
}

/// v² with [`SQUARE_FRAC`] fractional bits.
const fn square(velocity: i32) -> u32 {
    let size = velocity.unsigned_abs() as u64;
    size.wrapping_mul(size).wrapping_shr(40 - SQUARE_FRAC) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_that_of_the_formulas() {
        let errors = EdgeErrors {
            placement_d: 0.003,
            slope: 6e-6,
            curvature_per_d: 2e-8,
            ..EdgeErrors::default()
        };
        let noise = EdgeNoise::new(&errors, 1000.0, 84e6).unwrap();
        for velocity in [0.05, -5.0, 150.0, -2047.0] {
            let bits = (velocity * 1_048_576.0) as i32;
            let stamp = 2e-5_f64.powi(2) + (1.0 / 84e3_f64).powi(2) / 12.0;
            let edge = 0.005_f64.powi(2) + 0.003_f64.powi(2) + velocity * velocity * stamp;
            let close = |found: f64, expected: f64, lsb: f64| {
                let error = (found - expected).abs();
                assert!(
                    error <= 0.01 * expected + lsb,
                    "{velocity}: {found} {expected}"
                );
            };
            close(
                f64::from(noise.of_edge(bits)) / 2.0_f64.powi(30),
                edge,
                1e-9,
            );
            let of_velocity: f64 = noise.of_velocity(bits).to_num();
            close(of_velocity.sqrt(), velocity.abs() * 6e-6, 6e-8);
            let of_acceleration: f64 = noise.of_acceleration(bits).to_num();
            close(of_acceleration.sqrt(), velocity * velocity * 2e-8, 6e-8);
        }
    }

    #[test]
    fn nothing_overflows_at_the_ends_of_the_ranges() {
        let errors = EdgeErrors {
            edge_noise_d: 0.2,
            time_noise_s: 1e-4,
            placement_d: 0.25,
            slope: 0.0009,
            curvature_per_d: 1e-5,
        };
        let noise = EdgeNoise::new(&errors, 1000.0, 84e6).unwrap();
        assert_eq!(noise.of_edge(i32::MIN), u32::MAX);
        assert!(noise.of_velocity(i32::MIN) < 4.0);
        assert!(noise.of_acceleration(i32::MIN) < 2000.0);
    }
}
