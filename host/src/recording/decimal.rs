//! Decimal numbers as written, exact: times and rates never pass through a floating-point number,
//! which would move edges by a tick.

/// `mantissa` × 10^−`digits`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Decimal {
    pub mantissa: i128,
    /// Decimal places, as written.
    pub digits: u32,
}

/// Beyond this a number is no time or rate, and powers of ten stay far from overflow.
const LARGEST_EXPONENT: i32 = 30;

impl Decimal {
    /// Reads `12`, `-0.000000001`, `1.5e-7`; None where the text is no decimal number or needs more
    /// than 127 bits.
    pub(super) fn parse(text: &str) -> Option<Decimal> {
        let (number, exponent) = match text.split_once(['e', 'E']) {
            Some((number, exponent)) => (number, exponent.parse::<i32>().ok()?),
            None => (text, 0),
        };
        if exponent.abs() > LARGEST_EXPONENT {
            return None;
        }
        let (negative, unsigned) = match number.strip_prefix('-') {
            Some(unsigned) => (true, unsigned),
            None => (false, number.strip_prefix('+').unwrap_or(number)),
        };
        let (whole, fraction) = unsigned.split_once('.').unwrap_or((unsigned, ""));
        let magnitude = digits_of(whole, fraction)?;
        let signed = if negative { -magnitude } else { magnitude };
        let places = i32::try_from(fraction.len()).ok()? - exponent;
        Decimal {
            mantissa: signed,
            digits: 0,
        }
        .with_places(places)
    }

    /// The mantissa stands for units of 10^−`places`; negative places are multiplied out.
    fn with_places(self, places: i32) -> Option<Decimal> {
        match u32::try_from(places) {
            Ok(digits) => Some(Decimal { digits, ..self }),
            Err(_) => {
                let factor = 10_i128.checked_pow(places.unsigned_abs())?;
                Some(Decimal {
                    mantissa: self.mantissa.checked_mul(factor)?,
                    digits: 0,
                })
            }
        }
    }

    /// The number in units of 10^−`digits`, where that is a whole number of them.
    pub(super) fn in_units(self, digits: u32) -> Option<i128> {
        if digits >= self.digits {
            self.mantissa
                .checked_mul(10_i128.checked_pow(digits - self.digits)?)
        } else {
            let factor = 10_i128.checked_pow(self.digits - digits)?;
            (self.mantissa % factor == 0).then(|| self.mantissa / factor)
        }
    }

    /// Drops zeros at the end of the fraction as long as more than `kept` places remain.
    pub(super) fn trim_zeros(mut self, kept: u32) -> Decimal {
        while self.digits > kept && self.mantissa % 10 == 0 {
            self.mantissa /= 10;
            self.digits -= 1;
        }
        self
    }
}

fn digits_of(whole: &str, fraction: &str) -> Option<i128> {
    if whole.is_empty() && fraction.is_empty() {
        return None;
    }
    whole
        .bytes()
        .chain(fraction.bytes())
        .try_fold(0_i128, |value, byte| {
            let digit = byte.is_ascii_digit().then(|| i128::from(byte - b'0'))?;
            value.checked_mul(10)?.checked_add(digit)
        })
}

#[cfg(test)]
mod tests {
    use super::Decimal;

    fn parse(text: &str) -> Option<(i128, u32)> {
        Decimal::parse(text).map(|decimal| (decimal.mantissa, decimal.digits))
    }

    #[test]
    fn numbers_are_kept_as_written() {
        assert_eq!(parse("0"), Some((0, 0)));
        assert_eq!(parse("-0.000000001"), Some((-1, 9)));
        assert_eq!(parse("+1.50"), Some((150, 2)));
        assert_eq!(parse(".5"), Some((5, 1)));
        assert_eq!(parse("5."), Some((5, 0)));
        assert_eq!(parse("1.5e-7"), Some((15, 8)));
        assert_eq!(parse("1.5E+03"), Some((1500, 0)));
        // 2^53 + 1 is the first whole number that an f64 cannot hold.
        assert_eq!(
            parse("9007199254740993e-15"),
            Some((9_007_199_254_740_993, 15))
        );
    }

    #[test]
    fn what_is_no_number_is_refused() {
        for text in [
            "", ".", "-", "1.2.3", "0x10", "1e", "1e99", "--1", "1 2", "NaN", "inf", "²",
        ] {
            assert_eq!(parse(text), None, "{text}");
        }
        assert_eq!(parse(&"9".repeat(60)), None);
    }

    #[test]
    fn units_are_exact_or_refused() {
        let value = Decimal::parse("12.5").expect("a number");
        assert_eq!(value.in_units(6), Some(12_500_000));
        assert_eq!(value.in_units(0), None);
        let zeros = Decimal::parse("2.500000000000000").expect("a number");
        assert_eq!(
            zeros.trim_zeros(9),
            Decimal {
                mantissa: 2_500_000_000,
                digits: 9
            }
        );
        assert_eq!(zeros.in_units(1), Some(25));
    }
}
