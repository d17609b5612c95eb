//! The filters of the feedback part: what the command will still do while it travels, a notch and a low-pass.
//!
//! **Prediction.** A drive answers `delay` ticks late; until then the state does not show what the last commands will
//! do to it. With the drive's state a tick later F·s + g·u, the state when a command arrives is
//! F^D·s + Σ F^(i−1)·g·u₋ᵢ, i = 1…D. State feedback K on that state is K·F^D on the state now, which are the gains, and the
//! taps cᵢ = K·F^(i−1)·g on the feedback parts of the last D commands:
//!
//! u = filtered(feedback − Σ cᵢ·u₋ᵢ)
//!
//! The feedforward part needs none: the setpoint knows it. The taps come from [`crate::tuning`]; without them and
//! without sections nothing is done.

use super::biquad::{Section, State as SectionState, bounded};
use crate::units::{Command, RangeError, checked};

/// Most ticks of delay that are predicted over.
pub const MAX_TAPS: usize = 8;
/// Most sections.
pub const MAX_SECTIONS: usize = 2;
/// Largest sum of the taps' magnitudes.
pub const MAX_TAP_SUM: f64 = 1.9;

/// Filters of the feedback part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Config {
    sections: [Section; MAX_SECTIONS],
    section_count: usize,
    /// cᵢ, Q2.30.
    taps: [i32; MAX_TAPS],
    tap_count: usize,
    /// 1/(1 + Σcᵢ), Q2.30.
    steady_gain: i32,
    is_on: bool,
}

impl Config {
    /// Taps `taps` and the sections that there are.
    ///
    /// # Errors
    /// [`RangeError`] for taps whose magnitudes add up to more than 1.9, or a sum below −0.5.
    pub fn new(
        taps: &[f64; MAX_TAPS],
        sections: [Option<Section>; MAX_SECTIONS],
    ) -> Result<Self, RangeError> {
        let size: f64 = taps.iter().map(|tap| libm::fabs(*tap)).sum();
        checked("sum of the prediction's taps", size, 0.0, MAX_TAP_SUM)?;
        let sum: f64 = taps.iter().sum();
        checked("sum of the prediction's taps", sum, -0.5, MAX_TAP_SUM)?;
        let fixed =
            |value: f64| libm::round(libm::ldexp(value, Command::FRAC_NBITS.cast_signed())) as i32;
        let used = taps.iter().rposition(|tap| *tap != 0.0);
        let mut config = Self {
            taps: taps.map(fixed),
            tap_count: used.map_or(0, |last| last.wrapping_add(1)),
            steady_gain: fixed(1.0 / (1.0 + sum)),
            ..Self::default()
        };
        for section in sections.into_iter().flatten() {
            if let Some(place) = config.sections.get_mut(config.section_count) {
                *place = section;
                config.section_count = config.section_count.wrapping_add(1);
            }
        }
        config.is_on = config.section_count != 0 || config.tap_count != 0;
        Ok(config)
    }

    /// There is something to do.
    #[inline]
    #[must_use]
    pub const fn is_on(&self) -> bool {
        self.is_on
    }

    /// What `feedback` comes to after a long time, Q.30; without filters it passes as it is.
    #[must_use]
    pub fn steady(&self, feedback: i32) -> i32 {
        if !self.is_on() {
            return feedback;
        }
        i64::from(bounded(feedback))
            .wrapping_mul(i64::from(self.steady_gain))
            .wrapping_shr(Command::FRAC_NBITS) as i32
    }

    /// The sections in use.
    pub fn sections(&self) -> impl Iterator<Item = &Section> {
        self.sections.iter().take(self.section_count)
    }

    /// The taps as quantised.
    #[must_use]
    pub fn taps(&self) -> [f64; MAX_TAPS] {
        self.taps.map(|tap| {
            libm::ldexp(
                f64::from(tap),
                Command::FRAC_NBITS.cast_signed().wrapping_neg(),
            )
        })
    }
}

/// State of the filters.
#[derive(Clone, Debug, Default)]
pub struct State {
    sections: [SectionState; MAX_SECTIONS],
    /// The last feedback parts, the newest first.
    past: [i32; MAX_TAPS],
}

impl State {
    /// As after a long time without a feedback.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            sections: [SectionState::steady(0); MAX_SECTIONS],
            past: [0; MAX_TAPS],
        }
    }

    /// As after a long time under `feedback`, Q.30.
    #[cold]
    #[inline(never)]
    pub fn steady(config: &Config, feedback: i32) -> Self {
        let value = bounded(config.steady(feedback));
        Self {
            sections: [SectionState::steady(value); MAX_SECTIONS],
            past: [value; MAX_TAPS],
        }
    }

    /// One tick.
    #[inline]
    pub fn step(&mut self, config: &Config, feedback: i32) -> i32 {
        let mut value = bounded(feedback.saturating_sub(self.foreseen(config)));
        // No loop: two of them are fewer than what it takes to go round.
        let ([one, other], [first, second]) = (&config.sections, &mut self.sections);
        if config.section_count != 0 {
            value = first.step(one, value);
        }
        if config.section_count == MAX_SECTIONS {
            value = second.step(other, value);
        }
        let [newest, ..] = &mut self.past;
        *newest = value;
        value
    }

    /// Σ cᵢ·u₋ᵢ; makes room for the newest. Five products at most add up in 64 bits, the taps' sum is below 2.
    #[inline]
    fn foreseen(&mut self, config: &Config) -> i32 {
        let mut sum = 0_i64;
        let mut newer = 0;
        for (tap, past) in config
            .taps
            .iter()
            .zip(&mut self.past)
            .take(config.tap_count)
        {
            sum = sum.wrapping_add(i64::from(*tap).wrapping_mul(i64::from(*past)));
            core::mem::swap(past, &mut newer);
        }
        sum.wrapping_shr(Command::FRAC_NBITS) as i32
    }
}
