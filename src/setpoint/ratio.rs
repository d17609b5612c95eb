//! Exact rational ratios: an electronic gear between counts.
//!
//! A step of `delta` counts is `delta`·N/D d. The whole multiples of 2⁻¹⁶ d are given out, the rest of the division
//! is carried to the next step, so that after any number of counts the sum is ⌊2¹⁶·N·counts/D⌋: it never drifts.
//! The rest is carried by one 32-bit division, for which the target has hardware.

use crate::estimator::saturate;
use crate::units::{Position, RangeError, checked};

/// Largest step, counts; |step|·D and the rest then stay below 2³².
pub const MAX_STEP: i32 = 2047;
/// Largest numerator and denominator.
pub const MAX_TERM: f64 = 1_048_576.0;
/// Largest and smallest size of a ratio, d a count.
const SIZE: (f64, f64) = (1.0 / 65_536.0, 1024.0);

/// d a count, as a fraction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ratio {
    /// ⌊2¹⁶·N/D⌋.
    per_count: i64,
    /// 2¹⁶·N − D·[`Self::per_count`]: 0 to D − 1.
    rest: u32,
    denominator: u32,
    /// N/D, for derivatives.
    factor: Factor,
}

/// A factor, right to 2⁻³⁰ of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Factor {
    /// The factor·2^`shift`, 2³⁰ to 2³¹ in size.
    mantissa: i32,
    shift: u32,
}

impl Factor {
    /// For zero, or a size of 2⁻³² to 2²⁹.
    pub(super) fn new(value: f64) -> Self {
        let exponent = libm::floor(libm::log2(libm::fabs(value)));
        let shift = 30_i32.wrapping_sub(exponent.clamp(-32.0, 29.0) as i32);
        Self {
            mantissa: saturate(libm::round(libm::ldexp(value, shift)) as i64),
            shift: shift.cast_unsigned(),
        }
    }

    /// A product with the fractional bits of `value`, to nearest.
    #[inline]
    #[must_use]
    pub fn of(&self, value: i32) -> i64 {
        let half = 1_i64.wrapping_shl(self.shift.wrapping_sub(1));
        i64::from(value)
            .wrapping_mul(i64::from(self.mantissa))
            .wrapping_add(half)
            .wrapping_shr(self.shift)
    }

    /// The factor.
    #[must_use]
    pub fn to_num(&self) -> f64 {
        libm::ldexp(
            f64::from(self.mantissa),
            self.shift.cast_signed().wrapping_neg(),
        )
    }
}

/// What an exact division leaves over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Carried(u32);

impl Carried {
    /// Nothing.
    pub const ZERO: Self = Self(0);
}

impl Ratio {
    /// `numerator`/`denominator` d a count; a negative numerator turns the direction round.
    ///
    /// # Errors
    /// [`RangeError`] unless both are whole, 1 ≤ `denominator` ≤ 1 048 576, 1 ≤ |`numerator`| ≤ 1 048 576 and their
    /// ratio is 2⁻¹⁶ to 1 024 d a count in size.
    pub fn new(
        numerator: (&'static str, f64),
        denominator: (&'static str, f64),
    ) -> Result<Self, RangeError> {
        let (name, over) = numerator;
        let whole = whole(name, over, -MAX_TERM)?;
        checked(name, libm::fabs(over), 1.0, MAX_TERM)?;
        let under = self::whole(denominator.0, denominator.1, 1.0)?;
        let size = libm::fabs(over) / denominator.1;
        checked("d a count of the electronic gear", size, SIZE.0, SIZE.1)?;
        let scaled = whole.wrapping_shl(Position::FRAC_NBITS);
        // 1 or more.
        let per_count = scaled.checked_div_euclid(under).unwrap_or(0);
        let rest = scaled.wrapping_sub(per_count.wrapping_mul(under));
        Ok(Self {
            per_count,
            rest: rest as u32,
            denominator: under as u32,
            factor: Factor::new(over / denominator.1),
        })
    }

    /// 2¹⁶ times the way of `delta` counts, |`delta`| ≤ [`MAX_STEP`], rounded down together with what was carried.
    #[inline]
    pub fn step(&self, carried: &mut Carried, delta: i32) -> i64 {
        let whole = i64::from(delta).wrapping_mul(self.per_count);
        if self.rest == 0 {
            return whole;
        }
        let rest = delta.unsigned_abs().wrapping_mul(self.rest);
        let last = self.denominator.wrapping_sub(1);
        let is_forward = delta >= 0;
        // Backwards ⌊y/D⌋ = −((D − 1 − y) div D), with y what is carried less the rest of the step.
        let start = if is_forward {
            carried.0
        } else {
            last.wrapping_sub(carried.0)
        };
        let sum = start.wrapping_add(rest);
        let quotient = sum.checked_div(self.denominator).unwrap_or(0);
        let left = sum.wrapping_sub(quotient.wrapping_mul(self.denominator));
        carried.0 = if is_forward {
            left
        } else {
            last.wrapping_sub(left)
        };
        let quotient = i64::from(quotient);
        if is_forward {
            whole.wrapping_add(quotient)
        } else {
            whole.wrapping_sub(quotient)
        }
    }

    /// A quantity of the counts in d, with the same fractional bits and to nearest; wide, so that whoever takes it
    /// sees what is out of range.
    #[inline]
    #[must_use]
    pub fn of(&self, value: i32) -> i64 {
        self.factor.of(value)
    }

    /// d a count.
    #[must_use]
    pub fn to_num(&self) -> f64 {
        self.factor.to_num()
    }
}

/// A whole number.
fn whole(name: &'static str, value: f64, least: f64) -> Result<i64, RangeError> {
    let value = checked(name, value, least, MAX_TERM)?;
    let nearest = libm::round(value);
    checked(name, value, nearest, nearest)?;
    Ok(nearest as i64)
}
