//! A filter section of second order for the feedback part of the command.
//!
//! y = b₀x + b₁x₋₁ + b₂x₋₂ − a₁y₋₁ − a₂y₋₂ in direct form, coefficients in Q2.30, summed in 64 bits. What
//! the shift cuts off is added to the next sum (error feedback), so no part of a steady input is lost: b₁ is chosen such
//! that the gain at rest is exactly 1, and a constant input ends at itself. What may be left of a limit cycle is then
//! an LSB of a command, 1e-9 of full command; a test holds it to two.

use core::f64::consts::TAU;

use crate::units::{Command, RangeError, checked};

const FRAC: u32 = Command::FRAC_NBITS;
/// Full command: inputs and outputs are held to it, so that five products add up in 64 bits.
const FULL: i32 = 1 << FRAC;
/// What is cut off by the shift.
const CUT: u32 = (1 << FRAC) - 1;

/// Lowest frequency of a section, of the tick rate: below it the coefficients are too coarse.
pub const LOWEST_SHARE: f64 = 1e-4;
/// Highest frequency of a section, of the tick rate.
pub const HIGHEST_SHARE: f64 = 0.45;

/// Coefficients of a section.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Section {
    b: [i32; 3],
    /// −a₁ and −a₂: so all products are added.
    minus_a: [i32; 2],
}

/// Coefficients b₀…b₂ and a₁, a₂ in `f64`.
pub type Coefficients = ([f64; 3], [f64; 2]);

/// 2πf of a frequency given as a share of the tick rate, rad/tick.
fn angle(name: &'static str, share: f64) -> Result<f64, RangeError> {
    Ok(TAU * checked(name, share, LOWEST_SHARE, HIGHEST_SHARE)?)
}

impl Section {
    /// A low-pass of second order with its natural frequency at `share` of the tick rate:
    /// ω²/(s² + 2ζωs + ω²), warped such that ω stays where it is.
    ///
    /// # Errors
    /// [`RangeError`] unless 1e-4 ≤ `share` ≤ 0.45 and 0.05 ≤ `damping` ≤ 5.
    pub fn low_pass(share: f64, damping: f64) -> Result<Self, RangeError> {
        let angle = angle("low_pass_hz / tick_hz", share)?;
        let damping = checked("low_pass_damping", damping, 0.05, 5.0)?;
        let (cosine, bend) = (libm::cos(angle), libm::sin(angle) * damping);
        let edge = (1.0 - cosine) / 2.0;
        Ok(Self::normalised([edge, edge], cosine, bend))
    }

    /// A notch at `share` of the tick rate: (s² + ω²)/(s² + 2ζωs + ω²); 2ζω is its width at −3 dB.
    ///
    /// # Errors
    /// [`RangeError`] unless 1e-4 ≤ `share` ≤ 0.45 and 0.01 ≤ `damping` ≤ 5.
    pub fn notch(share: f64, damping: f64) -> Result<Self, RangeError> {
        let angle = angle("notch_hz / tick_hz", share)?;
        let damping = checked("notch_damping", damping, 0.01, 5.0)?;
        let (cosine, bend) = (libm::cos(angle), libm::sin(angle) * damping);
        Ok(Self::normalised([1.0, 1.0], cosine, bend))
    }

    /// The section whose numerator has the ends `outer`; its middle follows from the gain at rest.
    fn normalised(outer: [f64; 2], cosine: f64, bend: f64) -> Self {
        let whole = 1.0 + bend;
        let fixed = |value: f64| libm::round(libm::ldexp(value / whole, FRAC.cast_signed()));
        let [b0, b2] = outer.map(fixed);
        let (a1, a2) = (fixed(-2.0 * cosine), fixed(1.0 - bend));
        let b1 = libm::ldexp(1.0, FRAC.cast_signed()) + a1 + a2 - b0 - b2;
        Self {
            b: [b0 as i32, b1 as i32, b2 as i32],
            minus_a: [-a1 as i32, -a2 as i32],
        }
    }

    /// The coefficients as quantised.
    #[must_use]
    pub fn coefficients(&self) -> Coefficients {
        let real = |bits: i32| libm::ldexp(f64::from(bits), FRAC.cast_signed().wrapping_neg());
        (self.b.map(real), self.minus_a.map(|bits| -real(bits)))
    }
}

/// What a section remembers.
#[derive(Clone, Copy, Debug, Default)]
pub struct State {
    x: [i32; 2],
    y: [i32; 2],
    /// What the last shift cut off.
    cut: u32,
}

impl State {
    /// As after a long time at `value`.
    #[must_use]
    pub const fn steady(value: i32) -> Self {
        Self {
            x: [value; 2],
            y: [value; 2],
            cut: 0,
        }
    }

    /// One tick; input and output are within ± full command.
    #[inline]
    pub fn step(&mut self, section: &Section, x: i32) -> i32 {
        let [b0, b1, b2] = section.b;
        let [a1, a2] = section.minus_a;
        let [x1, x2] = self.x;
        let [y1, y2] = self.y;
        // |b₀| + |b₁| + |b₂| + |a₁| + |a₂| ≤ 7, times full command: below 2⁶³.
        let sum = i64::from(self.cut)
            .wrapping_add(product(b0, x))
            .wrapping_add(product(b1, x1))
            .wrapping_add(product(b2, x2))
            .wrapping_add(product(a1, y1))
            .wrapping_add(product(a2, y2));
        let y = narrowed(sum);
        self.cut = sum as u32 & CUT;
        self.x = [x, x1];
        self.y = [y, y1];
        y
    }
}

#[inline]
const fn product(one: i32, other: i32) -> i64 {
    (one as i64).wrapping_mul(other as i64)
}

/// `value` within ± full command, and an LSB less at the upper end: one instruction.
#[inline]
pub(super) fn bounded(value: i32) -> i32 {
    value.clamp(-FULL, FULL.wrapping_sub(1))
}

/// `sum`/2³⁰ within ± full command.
#[inline]
fn narrowed(sum: i64) -> i32 {
    // By the high word, for both ends at once.
    const HIGHEST: u32 = 1 << (2 * FRAC - 32);
    let high = sum.wrapping_shr(32) as u32;
    if high.wrapping_add(HIGHEST) < 2 * HIGHEST {
        sum.wrapping_shr(FRAC) as i32
    } else {
        full_of(sum)
    }
}

#[cold]
fn full_of(sum: i64) -> i32 {
    if sum < 0 { -FULL } else { FULL }
}
