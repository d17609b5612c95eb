//! Ranges of the axes, spacing and text of their ticks.

use std::sync::Arc;

use kuva::TickFormat;
use kuva::render::render_utils::compute_tick_step;

/// Values beyond are treated as not finite: the square of a range must not overflow.
const LARGEST: f64 = 1e150;
/// A range narrower than this part of its values is drawn as one value.
const NARROWEST: f64 = 1e-9;
/// A range of a lesser ratio is widened on a logarithmic axis.
const LOG_NARROWEST: f64 = 2.0;
/// Room above and below the data, as a part of its range.
const PADDING: f64 = 0.05;
/// An end this near to a tick, as a part of the distance between ticks, moves to it.
const REACH: f64 = 0.03;
/// From here up, and for steps from [`SMALLEST_PLAIN_STEP`] down, numbers take an exponent.
const LARGEST_PLAIN: f64 = 1e7;
const SMALLEST_PLAIN_STEP: f64 = 1e-5;

/// Whether a value has a place on an axis.
pub(super) fn is_drawable(value: f64) -> bool {
    value.abs() <= LARGEST
}

/// An axis from end to end, `low < high`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    pub low: f64,
    pub high: f64,
}

impl Range {
    /// The range of the drawable values, widened around a single one; 0 to 1 for none.
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let ends = values
            .filter(|&value| is_drawable(value))
            .map(|value| (value, value))
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let Some((low, high)) = ends else {
            return Self {
                low: 0.0,
                high: 1.0,
            };
        };
        let largest = low.abs().max(high.abs());
        if high - low > largest * NARROWEST && high - low > f64::MIN_POSITIVE {
            return Self { low, high };
        }
        let half = if largest > f64::MIN_POSITIVE {
            largest * 0.1
        } else {
            1.0
        };
        Self {
            low: low - half,
            high: high + half,
        }
    }

    /// The range with room at both ends.
    pub fn padded(self) -> Self {
        let room = (self.high - self.low) * PADDING;
        Self {
            low: self.low - room,
            high: self.high + room,
        }
    }

    /// The range with an end moved out to the tick it all but reaches: a record of 5 s
    /// ends one sample short of 5.
    pub fn reaching_ticks(self, step: f64) -> Self {
        let nearest = |end: f64| {
            let tick = (end / step).round() * step;
            let near = (tick - end).abs() <= step * REACH;
            if near { tick } else { end }
        };
        Self {
            low: self.low.min(nearest(self.low)),
            high: self.high.max(nearest(self.high)),
        }
    }

    /// The range a touch wider, lest rounding puts the ticks at its ends outside.
    pub fn with_end_ticks(self, step: f64) -> Self {
        let touch = step * 1e-9;
        Self {
            low: self.low - touch,
            high: self.high + touch,
        }
    }

    /// The same of positive values with a ratio for room at both ends, for a logarithmic axis.
    pub fn of_log(values: impl Iterator<Item = f64>) -> Self {
        let positive = values.filter(|&value| is_drawable(value) && value > 0.0);
        let ends = positive
            .map(|value| (value, value))
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let (low, high) = ends.unwrap_or((1.0, 10.0));
        if high / low > LOG_NARROWEST {
            return Self { low, high };
        }
        Self {
            low: low / LOG_NARROWEST,
            high: high * LOG_NARROWEST,
        }
    }

    /// The range with its ends moved out by a share of its decades.
    pub fn padded_log(self) -> Self {
        let room = (self.high / self.low).powf(PADDING);
        Self {
            low: self.low / room,
            high: self.high * room,
        }
    }

    pub fn ends(self) -> (f64, f64) {
        (self.low, self.high)
    }

    /// A round distance between ticks that leaves about `spacing` pixels between them
    /// on an axis `length` pixels long, or less where only that gives three ticks.
    pub fn tick_step(self, length: f64, spacing: f64) -> f64 {
        let wanted = (length / spacing).clamp(2.0, 12.0) as usize;
        let step = |count| compute_tick_step(self.low, self.high, count);
        let ticks = |step: f64| (self.high / step).floor() - (self.low / step).ceil() + 1.0;
        // Six steps to the range hold three ticks wherever it begins.
        let enough = |count: &usize| ticks(step(*count)) >= 3.0;
        step((wanted..=6).find(enough).unwrap_or(wanted.max(6)))
    }

    /// How to write ticks `step` apart: all with the digits the step needs.
    pub fn tick_format(self, step: f64) -> TickFormat {
        let largest = self.low.abs().max(self.high.abs());
        TickFormat::Custom(Arc::new(move |value| tick_text(value, step, largest)))
    }
}

/// A tick's value to the last decimal place of the step, with a true minus sign.
fn tick_text(value: f64, step: f64, largest: f64) -> String {
    if value.abs() < step * 1e-6 {
        return "0".to_owned();
    }
    let place = last_place(step);
    let plain = largest < LARGEST_PLAIN && step > SMALLEST_PLAIN_STEP;
    let text = if plain {
        let decimals = usize::try_from(-place).unwrap_or(0);
        format!("{value:.decimals$}")
    } else {
        let digits = usize::try_from(exponent(value) - place).unwrap_or(0);
        trim_mantissa(&format!("{value:.digits$e}"))
    };
    text.replace('-', "\u{2212}")
}

/// Decimal place of the step's last non-zero digit: −2 for 0.05, −3 for 0.025, 0 for 2.
fn last_place(step: f64) -> i32 {
    let leading = exponent(step);
    let mantissa = step / 10f64.powi(leading);
    if (mantissa - mantissa.round()).abs() < 1e-6 {
        leading
    } else {
        leading - 1
    }
}

/// Decimal exponent of the leading digit; the factor keeps 0.001 from landing at −4.
fn exponent(value: f64) -> i32 {
    (value.abs() * (1.0 + 1e-9)).log10().floor() as i32
}

/// `1.50e7` as `1.5e7`.
fn trim_mantissa(text: &str) -> String {
    match text.split_once('e') {
        Some((mantissa, exponent)) if mantissa.contains('.') => {
            let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
            format!("{mantissa}e{exponent}")
        }
        _ => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(low: f64, high: f64) -> Vec<String> {
        let range = Range { low, high };
        let step = range.tick_step(450.0, 50.0);
        kuva::render::render_utils::generate_ticks_with_step(low, high, step)
            .into_iter()
            .map(|tick| range.tick_format(step).format(tick))
            .collect()
    }

    #[test]
    fn ticks_carry_the_digits_of_their_step() {
        assert_eq!(texts(-2.0, 2.0).first().unwrap(), "−2.0");
        assert_eq!(
            texts(0.0, 0.9),
            [
                "0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9"
            ]
        );
        assert_eq!(texts(0.0, 0.022)[1], "0.0025");
        assert_eq!(texts(0.0, 12_732.0)[1], "1000");
        assert_eq!(texts(0.001, 0.01)[0], "0.001");
    }

    #[test]
    fn extremes_take_an_exponent_without_idle_zeros() {
        assert_eq!(texts(0.0, 9e8)[1], "1e8");
        assert_eq!(texts(-9e-7, 0.0)[0], "−9e−7");
        assert_eq!(texts(1.234e9, 1.234_000_9e9)[1], "1.2340001e9");
    }

    #[test]
    fn a_logarithmic_range_holds_what_is_positive() {
        let range = |values: &[f64]| Range::of_log(values.iter().copied()).ends();
        assert_eq!(range(&[-1.0, 0.0, 10.0, f64::NAN, 1e5]), (10.0, 1e5));
        assert_eq!(range(&[7.0]), (3.5, 14.0));
        assert_eq!(range(&[-7.0]), (1.0, 10.0));
        let (low, high) = Range::of_log([1.0, 1e4].into_iter()).padded_log().ends();
        assert!((0.6..0.7).contains(&low) && (1.5e4..1.6e4).contains(&high));
    }

    #[test]
    fn a_constant_and_nothing_have_a_range() {
        for value in [0.0, 70.25, -1e-300, 1e150, -1e150, f64::MIN_POSITIVE / 4.0] {
            let range = Range::of([value, value].into_iter()).padded();
            assert!(
                range.low < value && value < range.high,
                "{value}: {range:?}"
            );
        }
        assert_eq!(
            Range::of([f64::NAN, f64::INFINITY].into_iter()).ends(),
            (0.0, 1.0)
        );
    }
}
