//! Numbers as they are written, and others written like them.

use std::fmt;

/// How a number shows its sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Not at all.
    None,
    /// `+`
    Plus,
    /// `-`
    Minus,
}

/// A number of a program: what it says, and its style.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Number {
    mantissa: i64,
    sign: Sign,
    integer_digits: u8,
    decimals: u8,
    point: bool,
    /// It has zeros before its first digit.
    padded: bool,
}

/// Why some text is no number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberError {
    /// No digit in it.
    NoDigits,
    /// More than 17 digits.
    TooLong,
}

impl fmt::Display for NumberError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoDigits => "a number needs a digit",
            Self::TooLong => "a number has at most 17 digits",
        })
    }
}

/// Most digits of a number: what an `i64` holds with room for a sum.
const MAX_DIGITS: u8 = 17;

const POWERS: [f64; 19] = [
    1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18,
];

fn power(decimals: u8) -> f64 {
    POWERS[usize::from(decimals).min(POWERS.len() - 1)]
}

impl Number {
    /// Reads a number from its characters; blanks between them count for nothing. What is neither sign, digit nor point ends it,
    /// and the count of bytes read comes back with it.
    ///
    /// # Errors
    /// Where there is no digit, or too many.
    pub fn read(text: &[u8], blanks: bool) -> Result<(Self, usize), NumberError> {
        let mut number = Self {
            mantissa: 0,
            sign: Sign::None,
            integer_digits: 0,
            decimals: 0,
            point: false,
            padded: false,
        };
        let mut end = 0;
        let mut at = 0;
        while let Some(&byte) = text.get(at) {
            match byte {
                b'+' | b'-' if end == 0 => {
                    number.sign = if byte == b'-' {
                        Sign::Minus
                    } else {
                        Sign::Plus
                    };
                }
                b'.' if !number.point => number.point = true,
                b'0'..=b'9' => number.push(byte - b'0')?,
                b' ' | b'\t' if blanks && end > 0 => {
                    at += 1;
                    continue;
                }
                _ => break,
            }
            at += 1;
            end = at;
        }
        if number.integer_digits + number.decimals == 0 {
            return Err(NumberError::NoDigits);
        }
        if number.sign == Sign::Minus {
            number.mantissa = -number.mantissa;
        }
        Ok((number, end))
    }

    /// A style to write numbers in that were not there.
    #[must_use]
    pub const fn style(sign: Sign, integer_digits: u8, decimals: u8, point: bool) -> Self {
        Self {
            mantissa: 0,
            sign,
            integer_digits,
            decimals,
            point,
            padded: integer_digits > 1,
        }
    }

    /// The same style with so many digits before the point, zeros in front.
    #[must_use]
    pub const fn with_width(self, integer_digits: u8) -> Self {
        Self {
            integer_digits,
            padded: true,
            ..self
        }
    }

    fn push(&mut self, digit: u8) -> Result<(), NumberError> {
        self.padded |= !self.point && self.integer_digits == 1 && self.mantissa == 0;
        let digits = if self.point {
            &mut self.decimals
        } else {
            &mut self.integer_digits
        };
        *digits += 1;
        if self.integer_digits + self.decimals > MAX_DIGITS {
            return Err(NumberError::TooLong);
        }
        self.mantissa = self.mantissa * 10 + i64::from(digit);
        Ok(())
    }

    /// What it says, a point where there is none after the last digit.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.mantissa as f64 / power(self.decimals)
    }

    /// What it says as a whole number; none where it has decimals other than 0.
    #[must_use]
    pub fn whole(&self) -> Option<i64> {
        let power = 10_i64.pow(u32::from(self.decimals));
        (self.mantissa % power == 0).then_some(self.mantissa / power)
    }

    /// Ten times what it says, as a whole number: G38.2 is 382. None where it has more decimals.
    #[must_use]
    pub fn tenths(&self) -> Option<i64> {
        if self.decimals == 0 {
            return self.mantissa.checked_mul(10);
        }
        let power = 10_i64.pow(u32::from(self.decimals - 1));
        (self.mantissa % power == 0).then_some(self.mantissa / power)
    }

    /// How it shows its sign.
    #[must_use]
    pub const fn sign(&self) -> Sign {
        self.sign
    }

    /// [`Sign::Plus`] where it shows its plus.
    #[must_use]
    pub const fn sign_shown(&self) -> Sign {
        match self.sign {
            Sign::Plus => Sign::Plus,
            Sign::None | Sign::Minus => Sign::None,
        }
    }

    /// Digits before the point.
    #[must_use]
    pub const fn integer_digits(&self) -> u8 {
        self.integer_digits
    }

    /// Digits after the point.
    #[must_use]
    pub const fn decimals(&self) -> u8 {
        self.decimals
    }

    /// True where it has a point.
    #[must_use]
    pub const fn has_point(&self) -> bool {
        self.point
    }

    /// Writes itself as it was read, blanks apart.
    pub fn write(&self, out: &mut Vec<u8>) {
        let magnitude = self.mantissa.unsigned_abs();
        // "-0.000" comes back as it was.
        let minus = self.sign == Sign::Minus;
        self.write_digits(minus, false, magnitude, self.decimals, out);
    }

    /// Writes another number in its style: `steps` of 10^−`decimals` each. Sign shown, leading zeros and width stay; it has
    /// as many decimals as it had, and more only where the number needs them. `signed` shows a `+` in any case.
    pub fn write_like(&self, steps: i64, decimals: u8, signed: bool, out: &mut Vec<u8>) {
        let mut magnitude = steps.unsigned_abs();
        let mut decimals = decimals;
        while decimals > self.decimals && magnitude.is_multiple_of(10) {
            magnitude /= 10;
            decimals -= 1;
        }
        while decimals < self.decimals && magnitude < 10_u64.pow(17) {
            magnitude *= 10;
            decimals += 1;
        }
        self.write_digits(steps < 0, signed, magnitude, decimals, out);
    }

    fn write_digits(
        &self,
        negative: bool,
        signed: bool,
        magnitude: u64,
        decimals: u8,
        out: &mut Vec<u8>,
    ) {
        if negative {
            out.push(b'-');
        } else if signed || self.sign == Sign::Plus {
            out.push(b'+');
        }
        // Leading zeros stay; without them a shorter number is a shorter word.
        let integer_digits = match self.integer_digits {
            digits if self.padded => usize::from(digits),
            digits => usize::from(digits.min(1)),
        };
        let decimals = usize::from(decimals);
        let mut digits = [b'0'; 40];
        let mut first = digits.len();
        let mut rest = magnitude;
        while rest > 0 {
            first -= 1;
            digits[first] = b'0' + (rest % 10) as u8;
            rest /= 10;
        }
        let first = first.min(digits.len() - decimals - integer_digits);
        let (whole, part) = digits[first..].split_at(digits.len() - first - decimals);
        out.extend_from_slice(whole);
        if self.point || decimals > 0 {
            out.push(b'.');
        }
        out.extend_from_slice(part);
    }

    /// Digits that a whole number of steps needs, for fixed widths.
    #[must_use]
    pub fn digits_of(steps: i64) -> u32 {
        steps.unsigned_abs().checked_ilog10().map_or(1, |n| n + 1)
    }
}
