//! Parameters of an axis as TOML files, a section for each of their tables.

use std::fmt::Write as _;
use std::ops::Range;
use std::path::Path;

use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer;
use leadscrew::estimator::paths::PositionFeedback;
use leadscrew::parameter_table::ParameterTable;
use leadscrew::params::{AxisParams, SectionVisitor};
use leadscrew::settings::Settings;
use leadscrew::units::{AxisScale, TICK_HZ, TIMER_HZ};
use leadscrew_hal_mock::scenario::{Visitor, visit_axis};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::machine_file::{fill_sections, section};
use crate::toml_file::{self, Complaint, TomlFileError, plain_number, suggestion};

/// Keys above the sections.
const KEYS: [&str; 4] = ["tick_hz", "timer_hz", "estimator", "position"];
/// What the loop takes for the position, by name.
const POSITIONS: [(&str, PositionFeedback); 2] = [
    ("count", PositionFeedback::Count),
    ("estimate", PositionFeedback::Estimate),
];
/// The estimator of a file that names none.
const DEFAULT_ESTIMATOR: &str = "exponential";

/// Reads a file.
///
/// # Errors
/// [`TomlFileError`] with file, line and what was expected.
pub fn read(path: &Path) -> Result<Settings, TomlFileError> {
    toml_file::read(path, parse)
}

fn parse(text: &str) -> Result<Settings, Complaint> {
    let document = toml_file::document(text)?;
    let document = document.get_ref();
    let (name, at) = name_at(document, KEYS[2], DEFAULT_ESTIMATOR, EstimatorConfig::NAMES)?;
    let estimator = match EstimatorConfig::by_name(name) {
        Ok(Some(estimator)) => estimator,
        _ => {
            let known = suggestion(name, EstimatorConfig::NAMES.iter().copied());
            let message = format!("unknown estimator `{name}`{known}");
            return Err(Complaint::new(at, message));
        }
    };
    let mut file = Settings::new(estimator);
    for (key, (low, high), place) in [
        (KEYS[0], TICK_HZ, &mut file.axis.tick_hz),
        (KEYS[1], TIMER_HZ, &mut file.axis.timer_hz),
    ] {
        if let Some(value) = document.get(key) {
            *place = rate(key, value, low, high)?;
        }
    }
    let names = POSITIONS.map(|(name, _)| name);
    let (position, position_at) = name_at(document, KEYS[3], names[0], &names)?;
    let found = POSITIONS.iter().find(|(name, _)| *name == position);
    let Some((_, position)) = found else {
        let known = suggestion(position, names);
        let message = format!("unknown position `{position}`{known}");
        return Err(Complaint::new(position_at, message));
    };
    file.axis.paths.position = *position;
    let sections = sections(&mut file.axis);
    fill_sections(document, &sections, &KEYS, |name, fill| {
        if name == OBSERVER {
            Some(fill.visit(&mut file.observer))
        } else {
            visit_axis(&mut file.axis, name, fill)
        }
    })?;
    if matches!(file.axis.estimator, EstimatorConfig::Observer(_)) {
        file.axis.estimator = observer_of(&file)
            .map_err(|error| Complaint::new(at, format!("the observer cannot be made: {error}")))?;
    }
    Ok(file)
}

/// Section of the observer's parameters.
const OBSERVER: &str = "observer";

fn observer_of(file: &Settings) -> Result<EstimatorConfig, leadscrew::units::RangeError> {
    let scale = AxisScale::new(file.axis.motion.counts_per_mm, file.axis.tick_hz)?;
    observer::Config::new(&file.observer, scale).map(EstimatorConfig::Observer)
}

/// The name that `key` gives, else `default`, and where it stands.
fn name_at<'a>(
    document: &'a DeTable<'_>,
    key: &str,
    default: &'a str,
    known: &[&str],
) -> Result<(&'a str, Range<usize>), Complaint> {
    let Some(value) = document.get(key) else {
        return Ok((default, 0..0));
    };
    let found = value.get_ref().as_str().ok_or_else(|| {
        let known = known.join(", ");
        let message = format!("{key} must be a name in quotes: one of {known}");
        Complaint::new(value.span(), message)
    })?;
    Ok((found, value.span()))
}

fn rate(key: &str, value: &Spanned<DeValue<'_>>, low: f64, high: f64) -> Result<f64, Complaint> {
    plain_number(value)
        .filter(|rate| (low..=high).contains(rate))
        .ok_or_else(|| {
            let message = format!("{key} must be a number (Hz, {low} to {high})");
            Complaint::new(value.span(), message)
        })
}

/// Names of all sections.
fn sections(axis: &mut AxisParams) -> Vec<&'static str> {
    struct Names(Vec<&'static str>);
    impl SectionVisitor for Names {
        fn section<T: ParameterTable>(&mut self, name: &'static str, _: &mut T) {
            self.0.push(name);
        }
    }
    let mut names = Names(Vec::new());
    axis.visit_sections(&mut names);
    names.0.push(OBSERVER);
    names.0
}

/// The file as TOML, every key with its unit, range and meaning.
#[must_use]
pub fn dump(file: &Settings) -> String {
    struct Dump(String);
    impl SectionVisitor for Dump {
        fn section<T: ParameterTable>(&mut self, name: &'static str, table: &mut T) {
            section(&mut self.0, name, table);
        }
    }
    let mut axis = file.axis;
    let mut text =
        "# Parameters of an axis. Keys that are left out keep their default.\n".to_owned();
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "# Control rate (Hz, {} to {})\n{} = {:?}",
        TICK_HZ.0, TICK_HZ.1, KEYS[0], axis.tick_hz
    );
    let _ = writeln!(
        text,
        "# Clock of the edge timer (Hz, {} to {})\n{} = {:?}",
        TIMER_HZ.0, TIMER_HZ.1, KEYS[1], axis.timer_hz
    );
    let known = EstimatorConfig::NAMES.join(", ");
    let _ = writeln!(
        text,
        "# Estimator in the loop (one of {known})\n{} = \"{}\"",
        KEYS[2],
        axis.estimator.name()
    );
    let position = axis.paths.position;
    let [name, other] = POSITIONS.map(|(name, is)| (name, is == position));
    let _ = writeln!(
        text,
        "# Position in the loop: the middle of the count, or the estimator's, which is to have no lag ({} or {})\n\
         {} = \"{}\"",
        name.0,
        other.0,
        KEYS[3],
        if other.1 { other.0 } else { name.0 }
    );
    let mut dump = Dump(text);
    axis.visit_sections(&mut dump);
    if matches!(axis.estimator, EstimatorConfig::Observer(_)) {
        section(&mut dump.0, OBSERVER, &file.observer);
    }
    dump.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dumped_axis_reads_back_the_same() {
        for name in EstimatorConfig::NAMES {
            let estimator = EstimatorConfig::by_name(name).ok().flatten();
            let mut file = Settings::new(estimator.expect("a name of the list"));
            file.axis.motion.max_feed_mm_per_min = 8000.0;
            file.axis.controller.position_gain_per_s = 12.5;
            if matches!(file.axis.estimator, EstimatorConfig::Observer(_)) {
                file.observer.natural_period_s = 0.1;
                file.axis.estimator = observer_of(&file).expect("an observer");
                file.axis.paths.position = PositionFeedback::Estimate;
            }
            let text = dump(&file);
            let read = parse(&text).map_err(|complaint| complaint.message);
            assert_eq!(read, Ok(file), "{name}: {text}");
        }
    }

    #[test]
    fn what_is_not_understood_is_complained_of() {
        for (text, part) in [
            ("tick_hz = 1", "100 to 40000"),
            ("estimator = \"obsrver\"", "did you mean `observer`?"),
            ("estimator = 3", "a name in quotes"),
            ("position = \"edge\"", "expected one of count, estimate"),
            ("[controler]", "did you mean `controller`?"),
            ("[motion]\ncounts_per_mm = \"x\"", "must be a number"),
            ("motion = 1", "is a section"),
            ("tick = 1", "did you mean `tick_hz`?"),
        ] {
            let complaint = parse(text).err().map(|complaint| complaint.message);
            let message = complaint.expect("a complaint");
            assert!(message.contains(part), "{message}");
        }
    }
}
