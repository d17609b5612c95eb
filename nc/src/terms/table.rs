//! A value over one coordinate, linear between its points: what screw maps and functional coefficients are made of.

use super::{TermError, Trouble, in_range};
use crate::coordinates::Axis;

/// Values at rising places of an axis, two or more.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Table {
    pub axis: Axis,
    places: Vec<f64>,
    values: Vec<f64>,
    steepest: f64,
    largest: f64,
}

impl Table {
    /// # Errors
    /// What is wrong with the numbers, in words.
    pub fn new(axis: Axis, places: Vec<f64>, values: Vec<f64>) -> Result<Self, String> {
        if places.len() != values.len() {
            return Err(format!(
                "{} values for {} places: one value for each is needed",
                values.len(),
                places.len()
            ));
        }
        if places.len() < 2 {
            return Err("two places or more are needed".to_owned());
        }
        if !places
            .iter()
            .chain(&values)
            .all(|number| number.is_finite())
        {
            return Err("all places and values must be finite numbers".to_owned());
        }
        if let Some(pair) = places.windows(2).find(|pair| pair[0] >= pair[1]) {
            return Err(format!(
                "the places must rise from one to the next, and {} follows {}",
                pair[1], pair[0]
            ));
        }
        let rises = places.windows(2).zip(values.windows(2));
        Ok(Self {
            axis,
            steepest: rises
                .map(|(place, value)| ((value[1] - value[0]) / (place[1] - place[0])).abs())
                .fold(0.0, f64::max),
            largest: values.iter().fold(0.0, |most, value| value.abs().max(most)),
            places,
            values,
        })
    }

    pub fn places(&self) -> &[f64] {
        &self.places
    }

    pub fn range(&self) -> (f64, f64) {
        (
            self.places.first().copied().unwrap_or_default(),
            self.places.last().copied().unwrap_or_default(),
        )
    }

    /// The value at a place.
    ///
    /// # Errors
    /// Beyond the first and the last place.
    pub fn at(&self, value: f64, term: &str) -> Result<f64, TermError> {
        let range = self.range();
        let value = in_range(value, range).ok_or_else(|| TermError {
            term: term.to_owned(),
            trouble: Trouble::OutOfRange {
                axis: self.axis,
                value,
                range,
            },
        })?;
        let upper = self.places.partition_point(|place| *place <= value);
        let lower = upper.min(self.places.len() - 1) - 1;
        let (a, b) = (self.places[lower], self.places[lower + 1]);
        let inside = (value - a) / (b - a);
        Ok((1.0 - inside) * self.values[lower] + inside * self.values[lower + 1])
    }

    /// Largest change of the value for one of the place.
    pub const fn steepest(&self) -> f64 {
        self.steepest
    }

    /// Largest value, without its sign.
    pub const fn largest(&self) -> f64 {
        self.largest
    }
}
