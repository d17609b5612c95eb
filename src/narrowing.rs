//! From 64 bits to 32 by a shift that is not known beforehand.

use crate::estimator::saturate;

/// `value` between `low` and `high`; `high` where they are the wrong way round, at which `clamp` panics: for limits that
/// the compiler cannot compare.
#[inline]
pub(crate) fn within_or_high<T: Ord>(value: T, low: T, high: T) -> T {
    value.max(low).min(high)
}

/// A right shift by s, 1 to 31, as numbers: a product costs less than a shift of 64 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Narrowing {
    /// 2ˢ⁻¹: half a unit of what is left, and where the high word of what still fits ends.
    half: i32,
    /// 2³²⁻ˢ.
    multiplier: u32,
}

impl Narrowing {
    /// By `shift`.
    pub const fn by(shift: u32) -> Self {
        let shift = if shift == 0 {
            1
        } else if shift > 31 {
            31
        } else {
            shift
        };
        Self {
            half: 1_i32.wrapping_shl(shift.wrapping_sub(1)),
            multiplier: 1_u32.wrapping_shl(32_u32.wrapping_sub(shift)),
        }
    }

    /// Half a unit of what is left.
    #[inline]
    pub const fn half(self) -> i32 {
        self.half
    }

    /// `sum`/2ˢ, rounded down, and `more`; only the whole saturates.
    #[inline]
    pub fn apply_and_add(self, sum: i64, more: i32) -> i32 {
        let high = sum.wrapping_shr(32) as i32;
        if high >= self.half || high < self.half.wrapping_neg() {
            self.beyond(sum, more)
        } else {
            self.apply(sum).saturating_add(more)
        }
    }

    #[cold]
    #[inline(never)]
    fn beyond(self, sum: i64, more: i32) -> i32 {
        let shift = self.half.trailing_zeros().wrapping_add(1);
        saturate(sum.wrapping_shr(shift).saturating_add(i64::from(more)))
    }

    /// `sum`/2ˢ, rounded down, saturating.
    #[inline]
    pub const fn apply(self, sum: i64) -> i32 {
        let high = sum.wrapping_shr(32) as i32;
        if high >= self.half {
            i32::MAX
        } else if high < self.half.wrapping_neg() {
            i32::MIN
        } else {
            let low = (sum as u32 as u64)
                .wrapping_mul(self.multiplier as u64)
                .wrapping_shr(32) as i32;
            high.wrapping_mul(self.multiplier.cast_signed())
                .wrapping_add(low)
        }
    }
}

/// `sum`/2^`SHIFT`, rounded down; beyond 32 bits within 2^(32 − `SHIFT`) of their end: the high word is held by one
/// instruction, and the low one stays as it is.
#[inline]
pub(crate) fn narrowed<const SHIFT: u32>(sum: i64) -> i32 {
    let most = 1_i32.wrapping_shl(SHIFT.wrapping_sub(1));
    let high = (sum.wrapping_shr(32) as i32).clamp(most.wrapping_neg(), most.wrapping_sub(1));
    let low = (sum as u32).wrapping_shr(SHIFT).cast_signed();
    high.wrapping_shl(32_u32.wrapping_sub(SHIFT)) | low
}

#[cfg(test)]
mod tests {
    use super::{Narrowing, narrowed};

    #[test]
    fn a_known_shift_saturates_but_for_what_the_low_word_holds() {
        for sum in [0, 1, -1, 1 << 40, -(1 << 40), (1 << 51) - 1, -(1 << 51)] {
            assert_eq!(i64::from(narrowed::<20>(sum)), sum >> 20);
        }
        for sum in [1_i64 << 51, 1 << 60, i64::MAX] {
            assert!(narrowed::<20>(sum) >= i32::MAX - 4095);
            assert!(narrowed::<20>(-sum) <= i32::MIN + 4095);
        }
    }

    #[test]
    fn what_does_not_fit_saturates() {
        assert_eq!(Narrowing::by(25).apply(i64::MAX), i32::MAX);
        assert_eq!(Narrowing::by(25).apply(i64::MIN), i32::MIN);
        assert_eq!(Narrowing::by(25).apply((1 << 56) - 1), i32::MAX);
        assert_eq!(Narrowing::by(25).apply(1 << 56), i32::MAX);
        assert_eq!(Narrowing::by(25).apply(-(1 << 56)), i32::MIN);
        assert_eq!(Narrowing::by(31).apply(-1), -1);
        assert_eq!(Narrowing::by(31).apply(3 << 30), 1);
    }
}
