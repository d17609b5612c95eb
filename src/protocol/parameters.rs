//! Parameters over the link: by their place in the list of all sections, or by `section.name`.

use super::refusal::Refusal;
use super::reply::Reply;
use crate::parameter_table::{Field, ParameterTable};
use crate::params::{AxisParams, SectionVisitor};

/// Which parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which<'n> {
    /// By its place in the list.
    At(u16),
    /// By section and name.
    Named(&'n str),
}

/// A parameter as the link tells of it, found on the way through the sections.
struct Search<'n> {
    which: Which<'n>,
    /// Written where it is found.
    value: Option<f64>,
    /// Parameters seen so far.
    count: u16,
    found: Option<Found>,
}

#[derive(Clone, Copy)]
struct Found {
    index: u16,
    section: &'static str,
    name: &'static str,
    unit: &'static str,
    /// Value before, smallest, largest, default.
    figures: [f64; 4],
}

impl Search<'_> {
    fn is_it(&self, section: &str, name: &str) -> bool {
        match self.which {
            Which::At(index) => index == self.count,
            Which::Named(asked) => asked.split_once('.') == Some((section, name)),
        }
    }
}

impl SectionVisitor for Search<'_> {
    fn section<T: ParameterTable>(&mut self, section: &'static str, table: &mut T) {
        for field in T::FIELDS {
            if self.is_it(section, field.name) {
                let Field {
                    name,
                    unit,
                    min,
                    max,
                    get,
                    set,
                    ..
                } = *field;
                let figures = [get(table), min, max, get(&T::default())];
                self.found = Some(Found {
                    index: self.count,
                    section,
                    name,
                    unit,
                    figures,
                });
                if let Some(value) = self.value
                    && (min..=max).contains(&value)
                {
                    set(table, value);
                }
            }
            self.count = self.count.saturating_add(1);
        }
    }
}

fn search<'n>(params: &mut AxisParams, which: Which<'n>, value: Option<f64>) -> Search<'n> {
    let mut search = Search {
        which,
        value,
        count: 0,
        found: None,
    };
    params.visit_sections(&mut search);
    search
}

/// What is to be told of a parameter.
///
/// # Errors
/// [`Refusal::UnknownParameter`]
pub fn parameter(params: &mut AxisParams, which: Which<'_>) -> Result<Reply<'static>, Refusal> {
    let search = search(params, which, None);
    let found = search.found.ok_or(Refusal::UnknownParameter)?;
    let [value, min, max, default] = found.figures;
    Ok(Reply::Parameter {
        index: found.index,
        count: search.count,
        section: found.section,
        name: found.name,
        unit: found.unit,
        value,
        min,
        max,
        default,
    })
}

/// Writes a parameter; gives the value before. Whether it goes with the others is for validation to say.
///
/// # Errors
/// [`Refusal::UnknownParameter`], [`Refusal::ParameterOutOfRange`]; nothing is changed then.
pub fn write(params: &mut AxisParams, which: Which<'_>, value: f64) -> Result<f64, Refusal> {
    let found = search(params, which, Some(value))
        .found
        .ok_or(Refusal::UnknownParameter)?;
    let [before, min, max, _] = found.figures;
    if (min..=max).contains(&value) {
        Ok(before)
    } else {
        Err(Refusal::ParameterOutOfRange)
    }
}
