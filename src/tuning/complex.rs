//! Complex numbers, as far as frequency responses need them.

use core::ops::{Add, Div, Mul, Sub};

/// re + i·im.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complex {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Complex {
    /// 1.
    pub const ONE: Self = Self::real(1.0);
    /// 0.
    pub const ZERO: Self = Self::real(0.0);

    /// A real number.
    #[must_use]
    pub const fn real(re: f64) -> Self {
        Self { re, im: 0.0 }
    }

    /// e^(i·`angle`), angle in rad.
    #[must_use]
    pub fn turned(angle: f64) -> Self {
        Self {
            re: libm::cos(angle),
            im: libm::sin(angle),
        }
    }

    /// Magnitude.
    #[must_use]
    pub fn size(self) -> f64 {
        libm::hypot(self.re, self.im)
    }

    /// Angle in rad, −π to π.
    #[must_use]
    pub fn angle(self) -> f64 {
        libm::atan2(self.im, self.re)
    }

    /// This times a real number.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self {
            re: self.re * factor,
            im: self.im * factor,
        }
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            re: self.re + other.re,
            im: self.im + other.im,
        }
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self {
            re: self.re - other.re,
            im: self.im - other.im,
        }
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }
}

impl Div for Complex {
    type Output = Self;
    /// Of 0/0 comes not-a-number, as with `f64`.
    fn div(self, other: Self) -> Self {
        let square = other.re * other.re + other.im * other.im;
        Self {
            re: (self.re * other.re + self.im * other.im) / square,
            im: (self.im * other.re - self.re * other.im) / square,
        }
    }
}
