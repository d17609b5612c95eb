//! What is set on the cross-check, and the scale of its readings.

use crate::parameter_table;
use crate::parameter_table::ParameterTable;
use crate::units::{AxisScale, Lag, RangeError, Velocity, checked};

parameter_table! {
    /// Parameters of the cross-check by a tachogenerator.
    pub struct TachogeneratorParams {
        /// Feed for which the tachogenerator is scaled; that at full command will do
        full_feed_mm_per_min: 9600.0, "mm/min", 0.001..=1e6;
        /// How far a reading may be off at rest
        floor_mm_per_min: 25.0, "mm/min", 0.0..=1e5;
        /// The same until the gain is learned: offset of the reading included
        start_floor_mm_per_min: 60.0, "mm/min", 0.0..=1e5;
        /// How far a reading may be off, of the speed
        tolerance: 0.03, "1", 0.001..=0.5;
        /// The same until the gain is learned: how well the scale of the readings is known
        start_tolerance: 0.2, "1", 0.001..=0.5;
        /// Distance beyond the tolerance that makes a disagreement
        distance_mm: 0.1, "mm", 0.0001..=1000.0;
        /// Time of motion in agreement that ends one
        clear_s: 0.2, "s", 0.001..=100.0;
        /// Time over which gain and offset are fitted, rounded to a power of two of ticks
        fit_s: 0.25, "s", 0.01..=100.0;
        /// Age of a reading at the sampling instant: ½ for a mean over the tick
        reading_age_ticks: 0.5, "ticks", 0.0..=1.0;
    }
}

/// Fractional bits of v/V.
pub(super) const PHI_FRAC: u32 = 12;
const VELOCITY_FRAC: u32 = Velocity::FRAC_NBITS;
/// Forgetting, powers of two of ticks: the shifts of the fit stay within their type.
const FORGET_BITS: (f64, f64) = (8.0, 16.0);
/// Times the fit's time constant in motion after which the gain is known to 2 % of what it was off.
const LEARN_TIMES: u32 = 4;
/// Beyond this velocities saturate, d/tick.
const MAX_VELOCITY: f64 = 2047.0;
/// Least distance, d.
const MIN_DISTANCE: f64 = 2.0;
/// Power of two of V, Q12.20.
const UNIT_BITS: (f64, f64) = (PHI_FRAC as f64, 30.0);

/// Parameters as the tick uses them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    start: Limits,
    learned: Limits,
    /// Q.20 d.
    pub(super) distance: i64,
    pub(super) clear_ticks: u32,
    pub(super) forget_bits: u32,
    pub(super) learn_ticks: u32,
    /// From a velocity to v/V.
    pub(super) phi_shift: u32,
    /// From a step of gain·V to one of the gain, with what the step is finer than the gain; not negative with
    /// the forgetting.
    pub(super) unit_bits: u32,
    /// Q.32 d/tick.
    pub(super) most_offset: i64,
    pub(super) reading_age: Lag,
}

/// How far a reading may be off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Limits {
    /// Q.20 d/tick.
    pub(super) floor: i64,
    /// Of the speed, Q.20.
    pub(super) tolerance: i64,
}

impl Limits {
    /// At a speed in Q.20 d/tick, below 2³¹.
    pub(super) const fn band(&self, speed: u32) -> i64 {
        (speed as i64)
            .wrapping_mul(self.tolerance)
            .wrapping_shr(VELOCITY_FRAC)
            .wrapping_add(self.floor)
    }
}

impl Config {
    /// For an axis of this scale.
    ///
    /// # Errors
    /// [`RangeError`] for a parameter out of range, or a distance of more than 1e8 d. Velocities above 2 047 d/tick count
    /// as that, distances below 2 d as those.
    pub fn new(params: &TachogeneratorParams, scale: AxisScale) -> Result<Self, RangeError> {
        params.check()?;
        let velocity =
            |feed| Ok::<_, RangeError>(scale.velocity_from_feed(feed)?.min(MAX_VELOCITY));
        let full = velocity(params.full_feed_mm_per_min)?;
        let floor = velocity(params.floor_mm_per_min)?;
        let start_floor = velocity(params.start_floor_mm_per_min)?;
        // Counting alone makes a discrete of difference.
        let distance = scale.counts_from_mm(params.distance_mm).max(MIN_DISTANCE);
        let distance = checked("distance_d", distance, MIN_DISTANCE, 1e8)?;
        let ticks = |time_s: f64| time_s * scale.tick_hz();
        let (least, most) = FORGET_BITS;
        let forget_bits = libm::round(libm::log2(ticks(params.fit_s))).clamp(least, most) as u32;
        let (least, most) = UNIT_BITS;
        let unit = libm::round(libm::log2(libm::ldexp(
            full / 4.0,
            VELOCITY_FRAC.cast_signed(),
        )));
        let unit = unit.clamp(least, most) as u32;
        Ok(Self {
            start: Limits {
                floor: fraction(start_floor),
                tolerance: fraction(params.start_tolerance),
            },
            learned: Limits {
                floor: fraction(floor),
                tolerance: fraction(params.tolerance),
            },
            distance: fraction(distance),
            clear_ticks: libm::ceil(ticks(params.clear_s)) as u32,
            forget_bits,
            learn_ticks: LEARN_TIMES.wrapping_shl(forget_bits),
            phi_shift: unit.wrapping_sub(PHI_FRAC),
            // Wraps below zero for slow axes; the forgetting, of 8 bits or more, brings it back.
            unit_bits: unit.wrapping_sub(VELOCITY_FRAC),
            most_offset: libm::round(libm::ldexp(start_floor, 32)) as i64,
            reading_age: Lag::saturating_from_num(params.reading_age_ticks),
        })
    }

    /// What holds before and after the gain is learned.
    pub(super) const fn limits(&self, is_learned: bool) -> Limits {
        if is_learned { self.learned } else { self.start }
    }
}

/// Q.20.
fn fraction(value: f64) -> i64 {
    libm::round(libm::ldexp(value, VELOCITY_FRAC.cast_signed())) as i64
}

/// Counts of a converter to d/tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReadingScale {
    /// 2³⁰ to 2³¹.
    mantissa: i32,
    shift: u32,
    zero: i32,
}

impl ReadingScale {
    /// A converter that reads `zero` counts at rest and a count more for each `d_per_tick_per_count`; negative if it
    /// reads the other way round.
    ///
    /// # Errors
    /// [`RangeError`] unless 1e-5 ≤ |`d_per_tick_per_count`| ≤ 100 and |`zero`| ≤ 2²³.
    pub fn new(d_per_tick_per_count: f64, zero: i32) -> Result<Self, RangeError> {
        let size = libm::fabs(d_per_tick_per_count);
        checked("d_per_tick_per_count", size, 1e-5, 100.0)?;
        let most = f64::from(1 << 23);
        checked("zero_counts", f64::from(zero), -most, most)?;
        let exponent = libm::floor(libm::log2(size)) as i32;
        let shift = 30_i32.wrapping_sub(exponent);
        let mantissa = libm::round(libm::ldexp(d_per_tick_per_count, shift));
        Ok(Self {
            mantissa: mantissa as i32,
            shift: shift.cast_unsigned().wrapping_sub(VELOCITY_FRAC),
            zero,
        })
    }

    /// The velocity of a reading of so many counts; saturates.
    #[must_use]
    pub fn velocity(&self, counts: i32) -> Velocity {
        let counts = counts.saturating_sub(self.zero);
        let product = i64::from(counts).wrapping_mul(i64::from(self.mantissa));
        Velocity::from_bits(crate::estimator::saturate(product.wrapping_shr(self.shift)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_are_scaled() {
        for (factor, zero, counts) in [
            (0.233, 0, 644),
            (-0.0732, 2048, 4095),
            (1e-5, -7, 8_000_000),
            (100.0, 3, 20),
            (2.0, 0, -5),
        ] {
            let scale = ReadingScale::new(factor, zero).unwrap();
            let expected = factor * f64::from(counts - zero);
            let found: f64 = scale.velocity(counts).to_num();
            assert!(
                (found - expected).abs() <= 2e-9 * expected.abs() + 1e-6,
                "{found} {expected}"
            );
        }
        let scale = ReadingScale::new(100.0, 0).unwrap();
        assert_eq!(scale.velocity(i32::MAX), Velocity::MAX);
        assert_eq!(scale.velocity(i32::MIN), Velocity::MIN);
        for factor in [0.0, 1e-6, 101.0, f64::NAN] {
            assert!(ReadingScale::new(factor, 0).is_err(), "{factor}");
        }
    }
}
