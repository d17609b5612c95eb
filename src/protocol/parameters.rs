//! Parameters over the link: by their place in the list of all sections, or by `section.name`.

use super::refusal::Refusal;
use super::reply::Reply;
use crate::parameter_table::ParameterTable;
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
    /// Place of the one found.
    index: u16,
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
    /// Goes over the names of a section; the place of the one that is searched for.
    // What does not depend on the section's type is in calls: there are many sections.
    #[inline(never)]
    fn place(
        &mut self,
        section: &str,
        names: &mut dyn Iterator<Item = &'static str>,
    ) -> Option<usize> {
        let mut place = None;
        for (index, name) in names.enumerate() {
            let is_it = match self.which {
                Which::At(at) => at == self.count,
                Which::Named(asked) => asked.split_once('.') == Some((section, name)),
            };
            if is_it {
                place = Some(index);
                self.index = self.count;
            }
            self.count = self.count.saturating_add(1);
        }
        place
    }

    /// Keeps what was found; gives the value to write, if there is one and it may be.
    #[inline(never)]
    fn keep(&mut self, found: Found) -> Option<f64> {
        let [_, min, max, _] = found.figures;
        self.found = Some(found);
        self.value.filter(|value| (min..=max).contains(value))
    }
}

impl SectionVisitor for Search<'_> {
    fn section<T: ParameterTable>(&mut self, section: &'static str, table: &mut T) {
        let names = &mut T::FIELDS.iter().map(|field| field.name);
        let place = self.place(section, names);
        if let Some(field) = place.and_then(|place| T::FIELDS.get(place)) {
            let default = (field.get)(&T::default());
            let value = self.keep(Found {
                index: self.index,
                section,
                name: field.name,
                unit: field.unit,
                figures: [(field.get)(table), field.min, field.max, default],
            });
            if let Some(value) = value {
                (field.set)(table, value);
            }
        }
    }
}

// A call: it goes through every section.
#[inline(never)]
fn search<'n>(params: &mut AxisParams, which: Which<'n>, value: Option<f64>) -> Search<'n> {
    let mut search = Search {
        which,
        value,
        count: 0,
        index: 0,
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
