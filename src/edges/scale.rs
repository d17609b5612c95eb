//! Clocks of the edge timer as ticks, and what else is known of the edges beforehand.

use crate::uncertainty::{EdgeErrors, EdgeNoise};
use crate::units::{RangeError, TICK_HZ, TIMER_HZ, checked};

/// A span of time within some ticks of now, in ticks: 3.7e-9 fine; spans of [`MAX_SPAN_TICKS`] and more
/// are given as just that.
pub type Span = fixed::types::U4F28;

/// Longest [`Span`], ticks.
pub const MAX_SPAN_TICKS: u32 = 8;

/// What the reader has to know: the timer, and how well the encoder's edges are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeConfig {
    /// Clocks of the edge timer to ticks.
    pub scale: EdgeScale,
    /// Noise of the edges.
    pub noise: EdgeNoise,
}

impl EdgeConfig {
    /// For a control rate of `tick_hz`, a timer of `timer_hz` and an encoder with `errors`.
    ///
    /// # Errors
    /// [`RangeError`] for a rate outside 100 Hz to 40 kHz, a clock outside 1 to 250 MHz, or an error of the
    /// encoder out of range.
    pub fn new(tick_hz: f64, timer_hz: f64, errors: &EdgeErrors) -> Result<Self, RangeError> {
        Ok(Self {
            scale: EdgeScale::new(tick_hz, timer_hz)?,
            noise: EdgeNoise::new(errors, tick_hz, timer_hz)?,
        })
    }
}

/// Ticks in a clock of the edge timer.
///
/// A span is counted in parts of a clock, 2^`part_bits` of them, so that a tick has 2²⁸ to 2²⁹ parts; one
/// 32 × 32-bit product then gives ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeScale {
    part_bits: u32,
    /// 2⁶⁰ over the parts of a tick: right to 2⁻³².
    ticks_per_part: u32,
    /// Clocks in [`MAX_SPAN_TICKS`].
    max_clocks: u32,
    /// Clocks in a tick; 0 where they are not a whole number to 2⁻²⁴ of a tick.
    pub(super) clocks_per_tick: u32,
    /// Those as a span.
    pub(super) tick: Span,
}

impl EdgeScale {
    /// The scale of a timer of `timer_hz` at a control rate of `tick_hz`.
    ///
    /// # Errors
    /// [`RangeError`] for a rate outside 100 Hz to 40 kHz or a clock outside 1 to 250 MHz.
    pub fn new(tick_hz: f64, timer_hz: f64) -> Result<Self, RangeError> {
        let tick_hz = checked("tick_hz", tick_hz, TICK_HZ.0, TICK_HZ.1)?;
        let timer_hz = checked("timer_hz", timer_hz, TIMER_HZ.0, TIMER_HZ.1)?;
        let clocks_per_tick = timer_hz / tick_hz;
        let whole_bits = (clocks_per_tick as u32).ilog2();
        let part_bits = 28_u32.wrapping_sub(whole_bits);
        let parts_per_tick = libm::ldexp(clocks_per_tick, part_bits.cast_signed());
        let whole = libm::round(clocks_per_tick);
        let is_whole = (whole - clocks_per_tick).abs() <= libm::ldexp(clocks_per_tick, -24);
        let scale = Self {
            clocks_per_tick: if is_whole { whole as u32 } else { 0 },
            tick: Span::ZERO,
            part_bits,
            ticks_per_part: libm::round(libm::ldexp(1.0, 60) / parts_per_tick) as u32,
            max_clocks: (clocks_per_tick * f64::from(MAX_SPAN_TICKS) * (1.0 - 1e-9)) as u32,
        };
        Ok(Self {
            tick: scale.span(scale.clocks_per_tick),
            ..scale
        })
    }

    /// A span of `clocks`.
    #[must_use]
    pub const fn span(self, clocks: u32) -> Span {
        if clocks >= self.max_clocks {
            return LONGEST;
        }
        self.span_of_parts(clocks.wrapping_shl(self.part_bits))
    }

    /// The mean of `count` spans that add up to `clocks`; `count` is 1 to 2 047.
    pub(super) fn mean_span(self, clocks: u64, count: u32) -> Span {
        // Beyond 32 bits the mean is so large that what is cut off does not matter.
        let (clocks, coarse) = match u32::try_from(clocks) {
            Ok(clocks) => (clocks, 0),
            Err(_) => (clocks.wrapping_shr(COARSE_BITS) as u32, COARSE_BITS),
        };
        let whole = clocks.checked_div(count).unwrap_or(0);
        if whole >= self.max_clocks.wrapping_shr(coarse) {
            return LONGEST;
        }
        let rest = clocks.wrapping_sub(whole.wrapping_mul(count));
        let fine_bits = if self.part_bits < REST_BITS {
            self.part_bits
        } else {
            REST_BITS
        };
        let fraction = rest
            .wrapping_shl(fine_bits)
            .checked_div(count)
            .unwrap_or(0)
            .wrapping_shl(self.part_bits.wrapping_sub(fine_bits));
        let parts = whole.wrapping_shl(self.part_bits).wrapping_add(fraction);
        self.span_of_parts(parts.wrapping_shl(coarse))
    }

    const fn span_of_parts(self, parts: u32) -> Span {
        let product = (parts as u64).wrapping_mul(self.ticks_per_part as u64);
        Span::from_bits(product.wrapping_shr(32) as u32)
    }
}

pub(super) const LONGEST: Span = Span::from_bits(MAX_SPAN_TICKS << Span::FRAC_NBITS);
/// Clocks are cut by so many bits where their sum needs more than 32.
const COARSE_BITS: u32 = 8;
/// A rest of at most 2 047 may be shifted by so much.
const REST_BITS: u32 = 20;
