//! The settings of an axis as the core has them, and what differs between two of them.

use leadscrew::estimator::{EstimatorConfig, difference};
use leadscrew::settings::{Key, Number, Settings, Values};
use leadscrew_client::{Axis, Error, Parameter, Value};

use super::ProcedureError;

/// A setting that changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Section and name.
    pub name: String,
    /// Its unit; empty for a word.
    pub unit: &'static str,
    /// What it is.
    pub before: Setting,
    /// What it is to be.
    pub after: Setting,
}

/// The value of a setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setting {
    /// A number.
    Number(f64),
    /// A word.
    Word(&'static str),
}

/// Reads all settings of the axis. What this tool does not know of it is left out.
///
/// # Errors
/// Of a lost axis; an observer that cannot be made.
pub fn read_settings(axis: &mut Axis) -> Result<Settings, ProcedureError> {
    let parameters = axis.parameters()?;
    let mut settings = Settings::new(EstimatorConfig::Difference(difference::Config));
    let names = settings.visit(&mut Given(&parameters));
    settings.choose(names)?;
    Ok(settings)
}

/// What differs, in the order of the settings.
#[must_use]
pub fn differences(before: &Settings, after: &Settings) -> Vec<Change> {
    let (before, after) = (listed(before), listed(after));
    let pairs = before.into_iter().zip(after);
    let differing = pairs.filter(|(before, after)| before.value != after.value);
    differing
        .map(|(before, after)| Change {
            name: before.name,
            unit: before.unit,
            before: before.value,
            after: after.value,
        })
        .collect()
}

/// Sets what changes, all of it or nothing, while the axis is off.
///
/// # Errors
/// [`Error::Refused`] if the whole is not consistent.
pub fn apply(axis: &mut Axis, changes: &[Change]) -> Result<(), Error> {
    if changes.is_empty() {
        return Ok(());
    }
    axis.edit_parameters(|edit| {
        changes.iter().try_for_each(|change| match change.after {
            Setting::Number(value) => edit.set_parameter(&change.name, value),
            Setting::Word(word) => edit.set_word(&change.name, word),
        })
    })
}

/// Takes the values of parameters.
struct Given<'p>(&'p [Parameter]);

impl Given<'_> {
    fn value(&self, key: Key) -> Option<&Value> {
        let found = self.0.iter().find(|parameter| key.is(&parameter.name));
        found.map(|parameter| &parameter.value)
    }
}

impl Values for Given<'_> {
    fn number(&mut self, key: Key, _: &Number, value: f64) -> f64 {
        match self.value(key) {
            Some(Value::Number { value, .. }) => *value,
            _ => value,
        }
    }

    fn word(&mut self, key: Key, words: &[&'static str], value: &'static str) -> &'static str {
        let Some(Value::Word(given)) = self.value(key) else {
            return value;
        };
        let known = words.iter().find(|word| *word == given);
        known.copied().unwrap_or(value)
    }
}

struct Listed {
    name: String,
    unit: &'static str,
    value: Setting,
}

/// Lists all values.
struct List(Vec<Listed>);

impl Values for List {
    fn number(&mut self, key: Key, number: &Number, value: f64) -> f64 {
        self.0.push(Listed {
            name: key.to_string(),
            unit: number.unit,
            value: Setting::Number(value),
        });
        value
    }

    fn word(&mut self, key: Key, _: &[&'static str], value: &'static str) -> &'static str {
        self.0.push(Listed {
            name: key.to_string(),
            unit: "",
            value: Setting::Word(value),
        });
        value
    }
}

fn listed(settings: &Settings) -> Vec<Listed> {
    let mut list = List(Vec::new());
    let mut settings = *settings;
    settings.visit(&mut list);
    list.0
}
