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
    /// Section and name, with a point between them.
    pub name: String,
    /// Its unit, for people.
    pub unit: String,
    /// Its value.
    pub value: f64,
    /// Smallest value allowed.
    pub min: f64,
    /// Largest value allowed.
    pub max: f64,
    /// What it is if nobody sets it.
    pub default: f64,
}

impl Parameter {
    fn of(reply: &Reply<'_>) -> Option<(Self, u16)> {
        let Reply::Parameter {
            count,
            section,
            name,
            unit,
            value,
            min,
            max,
            default,
            ..
        } = *reply
        else {
            return None;
        };
        let parameter = Self {
            name: format!("{section}.{name}"),
            unit: unit.to_owned(),
            value,
            min,
            max,
            default,
        };
        Some((parameter, count))
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

    /// Sets a parameter, while the axis is off.
    ///
    /// # Errors
    /// [`Error::UnknownParameter`] with the nearest name, [`Error::ParameterOutOfRange`] with range and unit,
    /// [`Error::Refused`] while the axis is on or where it does not go with the others.
    pub fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), Error> {
        let parameter = self.parameter(name)?;
        let out_of_range = || Error::ParameterOutOfRange {
            name: name.to_owned(),
            value,
            unit: parameter.unit.clone(),
            min: parameter.min,
            max: parameter.max,
        };
        if !(parameter.min..=parameter.max).contains(&value) {
            return Err(out_of_range());
        }
        let done = self.order(&Request::SetParameter { name, value });
        match done {
            Err(Error::Refused(mut refused)) => {
                if refused.refusal() == Some(Refusal::ParameterOutOfRange) {
                    return Err(out_of_range());
                }
                refused.asked = format!("{name} = {value} {}", parameter.unit);
                Err(Error::Refused(refused))
            }
            done => done,
        }
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
