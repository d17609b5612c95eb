//! Options of a run, as words `key=value` on the image's command line.

use leadscrew::estimator::EstimatorConfig;

/// Lowest tick rate, in Hz.
pub const TICK_HZ_MIN: u32 = 100;
/// Highest tick rate, in Hz.
pub const TICK_HZ_MAX: u32 = 40_000;
/// Longest run, in ticks: a day at 10 kHz.
pub const TICKS_MAX: u32 = 864_000_000;

/// What to run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Control ticks per second.
    pub tick_hz: u32,
    /// Ticks to run; `None` leaves it to the scenario.
    pub ticks: Option<u32>,
    /// Name of the estimator in the loop.
    pub estimator: &'static str,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tick_hz: 1_000,
            ticks: None,
            estimator: "exponential",
        }
    }
}

/// Why a word was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum OptionError {
    /// Not of the form `key=value`.
    NotKeyValue,
    /// The keys are `tick-hz`, `ticks` and `estimator`.
    UnknownKey,
    /// There is no estimator of that name.
    UnknownEstimator,
    /// Not a whole number from `min` to `max`.
    OutOfRange {
        /// Smallest value allowed.
        min: u32,
        /// Largest value allowed.
        max: u32,
    },
}

impl Options {
    /// Takes one word, for instance `tick-hz=2500`.
    pub fn apply(&mut self, word: &str) -> Result<(), OptionError> {
        let (key, value) = word.split_once('=').ok_or(OptionError::NotKeyValue)?;
        match key {
            "tick-hz" => self.tick_hz = number(value, TICK_HZ_MIN, TICK_HZ_MAX)?,
            "ticks" => self.ticks = Some(number(value, 1, TICKS_MAX)?),
            "estimator" => self.estimator = name(value)?,
            _ => return Err(OptionError::UnknownKey),
        }
        Ok(())
    }
}

fn name(text: &str) -> Result<&'static str, OptionError> {
    let known = EstimatorConfig::NAMES.iter().find(|name| **name == text);
    known.copied().ok_or(OptionError::UnknownEstimator)
}

fn number(text: &str, min: u32, max: u32) -> Result<u32, OptionError> {
    text.parse()
        .ok()
        .filter(|value| (min..=max).contains(value))
        .ok_or(OptionError::OutOfRange { min, max })
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;

    #[test]
    fn words_set_their_option() {
        let mut options = Options::default();
        options.apply("tick-hz=2500").unwrap();
        options.apply("ticks=7").unwrap();
        options.apply("estimator=observer").unwrap();
        assert_eq!(
            options,
            Options {
                tick_hz: 2_500,
                ticks: Some(7),
                estimator: "observer",
            }
        );
    }

    #[test]
    fn bad_words_are_refused_with_what_is_allowed() {
        let refused = |word: &str| Options::default().apply(word).unwrap_err();
        let tick_hz = OptionError::OutOfRange {
            min: 100,
            max: 40_000,
        };
        assert_eq!(refused("fast"), OptionError::NotKeyValue);
        assert_eq!(refused("tickhz=1"), OptionError::UnknownKey);
        assert_eq!(refused("estimator=best"), OptionError::UnknownEstimator);
        for value in ["0", "99", "40001", "1e3", "-5", "", "99999999999"] {
            let word = std::format!("tick-hz={value}");
            assert_eq!(refused(&word), tick_hz, "{word}");
        }
    }
}
