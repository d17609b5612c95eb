//! Division of several dividends by one divisor, without a 64-bit division.

/// 1/divisor as mantissa and exponent, right to 2⁻²⁹ of itself.
#[derive(Clone, Copy, Debug)]
pub struct Reciprocal {
    /// 2³¹ to 2³².
    mantissa: u32,
    /// Leading zeros of the divisor: 1/divisor = mantissa·2^(zeros − 95).
    zeros: u32,
}

impl Reciprocal {
    /// Of a positive divisor; that of 0 is of no use, but defined.
    #[inline]
    pub fn new(divisor: u64) -> Self {
        let (normal, zeros) = normalised(divisor);
        let normal = normal | 1 << 31;
        // Sixteen bits by division, the others by a step of Newton's method.
        let guess = u32::MAX
            .checked_div(normal.wrapping_shr(16))
            .unwrap_or(0)
            .wrapping_shl(15);
        let product = u64::from(guess).wrapping_mul(u64::from(normal));
        let miss = (1_u64 << 63).wrapping_sub(product).cast_signed();
        let miss = miss.wrapping_shr(31) as i32;
        let correction = i64::from(miss)
            .wrapping_mul(i64::from(guess))
            .wrapping_shr(32) as i32;
        Self {
            mantissa: guess.saturating_add_signed(correction),
            zeros,
        }
    }

    /// `dividend`/divisor·2^`frac`, right to 0.6 and 2⁻²⁹ of itself, saturating at 31 bits. `frac` is below 32.
    #[inline]
    pub fn ratio(self, dividend: i64, frac: u32) -> i32 {
        // One product where the dividend and the quotient are of 32 bits.
        let shift = 62_u32.wrapping_sub(frac).wrapping_sub(self.zeros);
        if dividend == i64::from(dividend as i32) && (1..32).contains(&shift) {
            let product = dividend.wrapping_mul(i64::from(self.mantissa.wrapping_shr(1)));
            let high = product.wrapping_shr(32);
            let half = 1_i64.wrapping_shl(shift.wrapping_sub(1));
            return high.wrapping_add(half).wrapping_shr(shift) as i32;
        }
        self.long_ratio(dividend, frac)
    }

    #[inline(never)]
    fn long_ratio(self, dividend: i64, frac: u32) -> i32 {
        let size = self
            .size(dividend.unsigned_abs(), frac)
            .min(i32::MAX.cast_unsigned())
            .cast_signed();
        if dividend < 0 {
            size.wrapping_neg()
        } else {
            size
        }
    }

    /// `dividend`/divisor·2^`frac`, to nearest, saturating at 32 bits.
    #[inline]
    pub fn size(self, dividend: u64, frac: u32) -> u32 {
        let (normal, zeros) = normalised(dividend);
        let product = u64::from(normal).wrapping_mul(u64::from(self.mantissa));
        let high = product.wrapping_shr(32) as u32;
        // What is left: high·2^(frac + self.zeros − zeros − 31), with its highest bit at 30 or 31.
        let excess = zeros
            .wrapping_add(31)
            .wrapping_sub(self.zeros.wrapping_add(frac))
            .cast_signed();
        match excess {
            ..0 => u32::MAX,
            0 => high,
            1..33 => high
                .wrapping_shr(excess.wrapping_sub(1).cast_unsigned())
                .wrapping_add(1)
                .wrapping_shr(1),
            _ => 0,
        }
    }
}

/// A number's highest 32 bits from its first one on, and how many zeros lead; 0 has 64 of them.
#[inline]
fn normalised(value: u64) -> (u32, u32) {
    let (high, low) = (value.wrapping_shr(32) as u32, value as u32);
    if high == 0 {
        let zeros = low.leading_zeros();
        (low.wrapping_shl(zeros & 31), zeros.wrapping_add(32))
    } else {
        let zeros = high.leading_zeros();
        let rest = low.wrapping_shr(1).wrapping_shr(31_u32.wrapping_sub(zeros));
        (high.wrapping_shl(zeros) | rest, zeros)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_are_right_to_their_stated_bound() {
        let mut seed = 1_u64;
        let mut next = || {
            seed = seed.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(1);
            seed >> (seed >> 58)
        };
        for _ in 0..200_000 {
            let (dividend, divisor) = (next() >> 1, next().max(1));
            let exact = dividend as f64 / divisor as f64;
            for frac in [0, 8, 24] {
                let expected = exact * f64::from(1 << frac);
                if expected < f64::from(i32::MAX) {
                    let found = Reciprocal::new(divisor).ratio(dividend as i64, frac);
                    let error = (f64::from(found) - expected).abs();
                    assert!(
                        error <= 0.6 + expected * 2.0_f64.powi(-29),
                        "{dividend}/{divisor}: {found} instead of {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn what_is_too_large_saturates_and_nothing_is_undefined() {
        assert_eq!(Reciprocal::new(1).ratio(i64::MAX, 0), i32::MAX);
        assert_eq!(Reciprocal::new(1).ratio(i64::MIN, 30), -i32::MAX);
        assert_eq!(Reciprocal::new(u64::MAX).ratio(1, 0), 0);
        assert_eq!(Reciprocal::new(0).ratio(0, 8), 0);
        assert_eq!(Reciprocal::new(3).ratio(-10, 1), -7);
        assert_eq!(Reciprocal::new(5).size(0, 28), 0);
    }
}
