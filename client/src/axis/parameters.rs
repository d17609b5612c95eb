//! The axis's parameters by name.

use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;

use super::Axis;
use crate::error::Error;

/// Names less alike than this are no suggestion.
const ALIKE: f64 = 0.7;

/// A parameter of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Section and name, with a point between them; the name alone where it has no section.
    pub name: String,
    /// What it is.
    pub value: Value,
}

/// The value of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Number {
        /// The number.
        value: f64,
        /// Its unit, for people.
        unit: String,
        /// Smallest value allowed.
        min: f64,
        /// Largest value allowed.
        max: f64,
        /// What it is if nobody sets it.
        default: f64,
    },
    /// One of a few words.
    Word(String),
}

impl Parameter {
    /// Its value if it is a number.
    #[must_use]
    pub const fn number(&self) -> Option<f64> {
        match self.value {
            Value::Number { value, .. } => Some(value),
            Value::Word(_) => None,
        }
    }

    fn of(reply: &Reply<'_>) -> Option<(Self, u16)> {
        let (section, name, count) = match *reply {
            Reply::Parameter {
                section,
                name,
                count,
                ..
            }
            | Reply::Word {
                section,
                name,
                count,
                ..
            } => (section, name, count),
            _ => return None,
        };
        let name = if section.is_empty() {
            name.to_owned()
        } else {
            format!("{section}.{name}")
        };
        let value = Value::of(reply)?;
        Some((Self { name, value }, count))
    }
}

impl Value {
    fn of(reply: &Reply<'_>) -> Option<Self> {
        Some(match *reply {
            Reply::Parameter {
                unit,
                value,
                min,
                max,
                default,
                ..
            } => Self::Number {
                value,
                unit: unit.to_owned(),
                min,
                max,
                default,
            },
            Reply::Word { word, .. } => Self::Word(word.to_owned()),
            _ => return None,
        })
    }
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number { value, unit, .. } if unit.is_empty() => write!(f, "{value}"),
            Self::Number { value, unit, .. } => write!(f, "{value} {unit}"),
            Self::Word(word) => f.write_str(word),
        }
    }
}

impl Axis {
    /// All parameters, in the order of the axis.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn parameters(&mut self) -> Result<Vec<Parameter>, Error> {
        let mut all = Vec::new();
        let mut index = 0;
        loop {
            let (parameter, count) = self.query(&Request::ParameterAt { index }, Parameter::of)?;
            all.push(parameter);
            index += 1;
            if index >= count {
                return Ok(all);
            }
        }
    }

    /// The parameter of that name: section and name, with a point between them.
    ///
    /// # Errors
    /// [`Error::UnknownParameter`] with the nearest name.
    pub fn parameter(&mut self, name: &str) -> Result<Parameter, Error> {
        match self.parameter_at(name) {
            Err(error) if error.refusal() == Some(Refusal::UnknownParameter) => {
                Err(self.unknown(name)?)
            }
            outcome => outcome,
        }
    }

    /// Sets a parameter that is a number, while the axis is off; in the edit, if one is open.
    ///
    /// # Errors
    /// [`Error::UnknownParameter`] with the nearest name, [`Error::ParameterOutOfRange`] with range and unit,
    /// [`Error::Refused`] while the axis is on, where it does not go with the others, or where it is a word.
    pub fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), Error> {
        let parameter = self.parameter(name)?;
        let mut asked = format!("{name} = {value}");
        if let Value::Number { unit, min, max, .. } = parameter.value {
            if !(min..=max).contains(&value) {
                return Err(Error::ParameterOutOfRange {
                    name: name.to_owned(),
                    value,
                    unit,
                    min,
                    max,
                });
            }
            asked = format!("{asked} {unit}");
        }
        let done = self.order(&Request::SetParameter { name, value });
        done.map_err(|error| error.asked(&asked))
    }

    /// Sets a parameter that is one of a few words, while the axis is off; in the edit, if one is open.
    ///
    /// # Errors
    /// [`Error::UnknownParameter`] with the nearest name; [`Error::Refused`] for a word that it does not know, and as of
    /// [`Self::set_parameter`].
    pub fn set_word(&mut self, name: &str, word: &str) -> Result<(), Error> {
        self.parameter(name)?;
        let done = self.order(&Request::SetWord { name, word });
        done.map_err(|error| error.asked(&format!("{name} = {word}")))
    }

    /// Sets many parameters at once: `edit` sets them in a copy, which is validated as a whole, and taken or dropped.
    ///
    /// # Errors
    /// Those of `edit`; [`Error::Refused`] if the whole is not consistent. Nothing is changed then.
    pub fn edit_parameters(
        &mut self,
        edit: impl FnOnce(&mut Self) -> Result<(), Error>,
    ) -> Result<(), Error> {
        self.order(&Request::EditParameters {})?;
        let done = edit(self).and_then(|()| self.order(&Request::TakeParameters {}));
        if done.is_err() {
            // An axis that is lost drops it with the session.
            let _ = self.order(&Request::DropParameters {});
        }
        done
    }

    pub(super) fn parameter_at(&mut self, name: &str) -> Result<Parameter, Error> {
        let found = self.query(&Request::Parameter { name }, Parameter::of);
        found.map(|(parameter, _)| parameter)
    }

    fn unknown(&mut self, name: &str) -> Result<Error, Error> {
        let all = self.parameters()?;
        let likeness = |parameter: &Parameter| {
            // Who leaves the section out, or takes another one, is understood.
            let last = parameter.name.rsplit('.').next().unwrap_or_default();
            let asked = name.rsplit('.').next().unwrap_or_default();
            strsim::jaro_winkler(&parameter.name, name).max(strsim::jaro_winkler(last, asked))
        };
        let nearest = all
            .iter()
            .map(|parameter| (likeness(parameter), &parameter.name))
            .max_by(|(one, _), (other, _)| one.total_cmp(other));
        Ok(Error::UnknownParameter {
            name: name.to_owned(),
            nearest: nearest
                .filter(|(likeness, _)| *likeness >= ALIKE)
                .map(|(_, name)| name.clone()),
        })
    }
}
