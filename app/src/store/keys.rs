//! Every value of the settings by its name.

use core::fmt;

use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer;
use leadscrew::estimator::paths::{Choice, PositionFeedback};
use leadscrew::parameter_table::ParameterTable;
use leadscrew::params::SectionVisitor;
use leadscrew::units::{AxisScale, RangeError, TICK_HZ, TIMER_HZ};

use super::Settings;

/// Name of a value: `section.name`, or `name` alone. Names are added, none is used anew for something else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key {
    /// Its section; empty for what belongs to none.
    pub section: &'static str,
    /// Its name there.
    pub name: &'static str,
}

impl Key {
    const fn alone(name: &'static str) -> Self {
        Self { section: "", name }
    }

    /// What the name is put together of.
    pub(super) const fn parts(self) -> [&'static str; 3] {
        let dot = if self.section.is_empty() { "" } else { "." };
        [self.section, dot, self.name]
    }

    pub(super) fn is(self, name: &str) -> bool {
        let rest = self.parts().into_iter().try_fold(name, str::strip_prefix);
        rest.is_some_and(str::is_empty)
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.parts().iter().try_for_each(|part| f.write_str(part))
    }
}

/// Whoever goes over the values, and may give others.
pub(super) trait Values {
    /// A number, its range, its value now.
    fn number(&mut self, key: Key, range: (f64, f64), value: f64) -> f64;
    /// One of a few words.
    fn word(&mut self, key: Key, words: &[&'static str], value: &'static str) -> &'static str;
}

/// No second estimator.
const NONE: &str = "none";
/// Names for a second estimator: those of all, after none.
const SECOND: [&str; EstimatorConfig::NAMES.len() + 1] = {
    let mut names = [NONE; EstimatorConfig::NAMES.len() + 1];
    let (_, others) = names.split_at_mut(1);
    others.copy_from_slice(EstimatorConfig::NAMES);
    names
};
const CHOICES: [&str; 2] = ["first", "second"];
const POSITIONS: [&str; 2] = ["count", "estimate"];

/// The estimators by their names.
#[derive(Clone, Copy, Debug)]
pub(super) struct EstimatorNames {
    first: &'static str,
    second: &'static str,
}

impl Settings {
    /// Shows every value to `values`; gives the names of the estimators, which are not made.
    pub(super) fn visit(&mut self, values: &mut impl Values) -> EstimatorNames {
        let axis = &mut self.axis;
        axis.tick_hz = values.number(Key::alone("tick_hz"), TICK_HZ, axis.tick_hz);
        axis.timer_hz = values.number(Key::alone("timer_hz"), TIMER_HZ, axis.timer_hz);
        let mut sections = Sections { values };
        axis.visit_sections(&mut sections);
        sections.section("observer", &mut self.observer);
        self.visit_paths(values);
        let names = EstimatorConfig::NAMES;
        let first = self.axis.estimator.name();
        let first = values.word(Key::alone("estimator"), names, first);
        let second = self.axis.second_estimator;
        let second = second.map_or(NONE, |estimator| estimator.name());
        let second = values.word(Key::alone("second_estimator"), &SECOND, second);
        EstimatorNames { first, second }
    }

    fn visit_paths(&mut self, values: &mut impl Values) {
        let paths = &mut self.axis.paths;
        let choices = [
            ("velocity", &mut paths.velocity),
            ("acceleration", &mut paths.acceleration),
            ("display", &mut paths.display),
        ];
        for (name, choice) in choices {
            let section = "paths";
            let [first, second] = CHOICES;
            let now = if *choice == Choice::First {
                first
            } else {
                second
            };
            let word = values.word(Key { section, name }, &CHOICES, now);
            *choice = if word == first {
                Choice::First
            } else {
                Choice::Second
            };
        }
        let [count, estimate] = POSITIONS;
        let is_count = paths.position == PositionFeedback::Count;
        let now = if is_count { count } else { estimate };
        let key = Key {
            section: "paths",
            name: "position",
        };
        paths.position = if values.word(key, &POSITIONS, now) == count {
            PositionFeedback::Count
        } else {
            PositionFeedback::Estimate
        };
    }

    /// Makes the estimators of those names.
    ///
    /// # Errors
    /// The observer cannot be made with its parameters; the estimators are then those that they were.
    pub(super) fn choose(&mut self, names: EstimatorNames) -> Result<(), RangeError> {
        let first = self.estimator(names.first)?;
        self.axis.second_estimator = self.estimator(names.second)?;
        self.axis.estimator = first.unwrap_or(self.axis.estimator);
        Ok(())
    }

    /// The estimator that these settings know by that name.
    pub(super) fn estimator(&self, name: &str) -> Result<Option<EstimatorConfig>, RangeError> {
        let estimator = EstimatorConfig::by_name(name)?;
        if !matches!(estimator, Some(EstimatorConfig::Observer(_))) {
            return Ok(estimator);
        }
        let scale = AxisScale::new(self.axis.motion.counts_per_mm, self.axis.tick_hz)?;
        let config = observer::Config::new(&self.observer, scale)?;
        Ok(Some(EstimatorConfig::Observer(config)))
    }
}

struct Sections<'v, V> {
    values: &'v mut V,
}

impl<V: Values> SectionVisitor for Sections<'_, V> {
    fn section<T: ParameterTable>(&mut self, section: &'static str, table: &mut T) {
        for field in T::FIELDS {
            let name = field.name;
            let range = (field.min, field.max);
            let key = Key { section, name };
            let value = self.values.number(key, range, (field.get)(table));
            (field.set)(table, value);
        }
    }
}
