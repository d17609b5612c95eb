//! Settings of an axis as TOML files: every parameter in the section that its name tells of.

mod document;
mod entry;

use std::path::Path;

use leadscrew::estimator::{EstimatorConfig, difference};
use leadscrew::params::ParamError;
use leadscrew::settings::Settings;

pub use entry::{Content, Entry, about, all, entries, text};

use crate::toml_file::{self, TomlFileError};

/// The estimator of a file that names none.
const DEFAULT_ESTIMATOR: &str = "exponential";

/// Reads a file. Keys that it leaves out have their defaults.
///
/// # Errors
/// [`TomlFileError`] with file, line and what was expected.
pub fn read(path: &Path) -> Result<Settings, TomlFileError> {
    toml_file::read(path, document::parse)
}

/// The settings as TOML, every key with its unit, range and meaning.
#[must_use]
pub fn dump(settings: &Settings) -> String {
    let head = "Parameters of an axis. Keys that are left out have their default.";
    text(head, &entries(settings))
}

/// All defaults.
#[must_use]
pub fn defaults() -> Settings {
    let estimator = EstimatorConfig::by_name(DEFAULT_ESTIMATOR).ok().flatten();
    Settings::new(estimator.unwrap_or(EstimatorConfig::Difference(difference::Config)))
}

/// Checks settings as the firmware does before it takes them.
///
/// # Errors
/// The parameter, or what does not go together.
pub fn validate(settings: &Settings) -> Result<(), ParamError> {
    let mut settings = *settings;
    settings.validate().map(drop)
}

#[cfg(test)]
mod tests {
    use leadscrew::estimator::paths::{Choice, PositionFeedback};

    use super::document::parse;
    use super::*;

    #[test]
    fn all_that_is_set_reads_back_the_same() {
        for name in EstimatorConfig::NAMES {
            let mut settings = defaults();
            settings.axis.motion.max_feed_mm_per_min = 8000.0;
            settings.axis.controller.position_gain_per_s = 12.5;
            settings.observer.natural_period_s = 0.1;
            settings.axis.estimator = settings.estimator(name).unwrap().unwrap();
            settings.axis.second_estimator = settings.estimator("polynomial").unwrap();
            settings.axis.paths.position = PositionFeedback::Estimate;
            settings.axis.paths.display = Choice::Second;
            let text = dump(&settings);
            let read = parse(&text).map_err(|complaint| complaint.message);
            assert_eq!(read, Ok(settings), "{name}: {text}");
        }
    }

    #[test]
    fn a_file_of_the_old_shape_is_read() {
        let old = "tick_hz = 2000\nestimator = \"observer\"\nposition = \"estimate\"\n[motion]\ncounts_per_mm = 500\n";
        let read = parse(old).map_err(|complaint| complaint.message).unwrap();
        assert_eq!(read.axis.paths.position, PositionFeedback::Estimate);
        assert_eq!(read.axis.estimator.name(), "observer");
        assert!((read.axis.motion.counts_per_mm - 500.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_not_understood_is_complained_of() {
        for (text, part) in [
            ("tick_hz = 1", "100 to 40000"),
            ("estimator = \"obsrver\"", "did you mean `observer`?"),
            ("second_estimator = \"nune\"", "did you mean `none`?"),
            ("estimator = 3", "a name in quotes"),
            ("position = \"edge\"", "expected one of count, estimate"),
            (
                "[paths]\nvelocity = \"both\"",
                "expected one of first, second",
            ),
            (
                "[paths]\nspeed = \"first\"",
                "unknown key `speed` in [paths]",
            ),
            ("[controler]", "did you mean `controller`?"),
            ("[motion]\ncounts_per_mm = \"x\"", "must be a number"),
            (
                "[motion]\ncount_per_mm = 1",
                "did you mean `counts_per_mm`?",
            ),
            ("[motion]\ncounts_per_mm = -1", "out of range"),
            ("motion = 1", "is a section"),
            ("tick = 1", "did you mean `tick_hz`?"),
        ] {
            let complaint = parse(text).err().map(|complaint| complaint.message);
            let message = complaint.expect("a complaint");
            assert!(message.contains(part), "{message}");
        }
    }
}
