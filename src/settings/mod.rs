//! All that is set on an axis, value by value and by name: for the store, for the link, for files.

mod keys;

pub use keys::Key;

use crate::estimator::EstimatorConfig;
use crate::estimator::observer::{self, ObserverParams};
use crate::estimator::paths::{Choice, PositionFeedback};
use crate::parameter_table::ParameterTable;
use crate::params::{AxisConfig, AxisParams, ParamError, SectionVisitor};
use crate::units::{AxisScale, RangeError, TICK_HZ, TIMER_HZ};

/// All that is set on an axis: its parameters, and those of the observer, which [`AxisParams`] holds only as they come
/// to in ticks. Other estimators are known by their names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The parameters; the estimators among them follow from their names and from the observer's parameters.
    pub axis: AxisParams,
    /// The observer's parameters.
    pub observer: ObserverParams,
}

/// What is to be said of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    /// Its unit, for people.
    pub unit: &'static str,
    /// What it is.
    pub description: &'static str,
    /// Smallest value allowed.
    pub min: f64,
    /// Largest value allowed.
    pub max: f64,
    /// What it is if nobody sets it.
    pub default: f64,
}

impl Number {
    /// True for a value that may be; others are NaN and those out of range.
    #[must_use]
    pub fn allows(&self, value: f64) -> bool {
        (self.min..=self.max).contains(&value)
    }
}

/// Whoever goes over the values, and may give others.
pub trait Values {
    /// A number and its value now; gives the one that is to be.
    fn number(&mut self, key: Key, number: &Number, value: f64) -> f64;
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
pub struct EstimatorNames {
    first: &'static str,
    second: &'static str,
}

impl Settings {
    /// All defaults, with `estimator`.
    #[must_use]
    pub fn new(estimator: EstimatorConfig) -> Self {
        Self {
            axis: AxisParams::new(estimator),
            observer: ObserverParams::default(),
        }
    }

    /// Makes the estimators anew from their names and parameters, then validates and quantises.
    ///
    /// # Errors
    /// [`ParamError`]
    pub fn validate(&mut self) -> Result<AxisConfig, ParamError> {
        let names = self.visit(&mut Nothing);
        self.choose(names)?;
        self.axis.validate()
    }

    /// Shows every value to `values`, always in the same order; gives the names of the estimators, which are not made:
    /// [`Self::choose`] does.
    pub fn visit(&mut self, values: &mut impl Values) -> EstimatorNames {
        let rates = [
            ("tick_hz", "Control rate", TICK_HZ, 1000.0),
            ("timer_hz", "Clock of the edge timer", TIMER_HZ, 84e6),
        ];
        let axis = &mut self.axis;
        let places = [&mut axis.tick_hz, &mut axis.timer_hz];
        for ((name, description, (min, max), default), place) in rates.into_iter().zip(places) {
            let number = Number {
                unit: "Hz",
                description,
                min,
                max,
                default,
            };
            *place = values.number(Key::alone(name), &number, *place);
        }
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

    /// Notes the estimators of those names, which [`Self::validate`] makes of their parameters.
    pub fn note(&mut self, names: EstimatorNames) {
        let named = |name| EstimatorConfig::by_name(name).ok().flatten();
        if names.first != self.axis.estimator.name() {
            self.axis.estimator = named(names.first).unwrap_or(self.axis.estimator);
        }
        let second = self.axis.second_estimator;
        if names.second != second.map_or(NONE, |estimator| estimator.name()) {
            self.axis.second_estimator = named(names.second);
        }
    }

    /// Makes the estimators of those names.
    ///
    /// # Errors
    /// The observer cannot be made with its parameters; the estimators are then those that they were.
    pub fn choose(&mut self, names: EstimatorNames) -> Result<(), RangeError> {
        let first = self.estimator(names.first)?;
        self.axis.second_estimator = self.estimator(names.second)?;
        self.axis.estimator = first.unwrap_or(self.axis.estimator);
        Ok(())
    }

    /// The estimator that these settings know by that name.
    ///
    /// # Errors
    /// The observer cannot be made with its parameters.
    pub fn estimator(&self, name: &str) -> Result<Option<EstimatorConfig>, RangeError> {
        let estimator = EstimatorConfig::by_name(name)?;
        if !matches!(estimator, Some(EstimatorConfig::Observer(_))) {
            return Ok(estimator);
        }
        let scale = AxisScale::new(self.axis.motion.counts_per_mm, self.axis.tick_hz)?;
        let config = observer::Config::new(&self.observer, scale)?;
        Ok(Some(EstimatorConfig::Observer(config)))
    }
}

/// Leaves every value as it is.
struct Nothing;

impl Values for Nothing {
    fn number(&mut self, _: Key, _: &Number, value: f64) -> f64 {
        value
    }

    fn word(&mut self, _: Key, _: &[&'static str], value: &'static str) -> &'static str {
        value
    }
}

struct Sections<'v, V> {
    values: &'v mut V,
}

impl<V: Values> SectionVisitor for Sections<'_, V> {
    fn section<T: ParameterTable>(&mut self, section: &'static str, table: &mut T) {
        let defaults = T::default();
        for field in T::FIELDS {
            let key = Key {
                section,
                name: field.name,
            };
            let number = Number {
                unit: field.unit,
                description: field.description,
                min: field.min,
                max: field.max,
                default: (field.get)(&defaults),
            };
            let value = self.values.number(key, &number, (field.get)(table));
            (field.set)(table, value);
        }
    }
}
