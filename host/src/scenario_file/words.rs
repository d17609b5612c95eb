//! Keys of a table: what each may be, and errors that say so.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::toml_file::{Complaint, plain_number, suggestion};

/// A key and what may stand there.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Its name, unit included.
    pub name: &'static str,
    /// What it is.
    pub what: &'static str,
    /// What may stand there.
    pub value: Value,
    /// What it is where it is left out; `None` if it must be there. Of a word, its place in the list.
    pub default: Option<f64>,
}

/// What may stand at a key.
#[derive(Clone, Copy, Debug)]
pub enum Value {
    /// A number.
    Number {
        /// Its unit.
        unit: &'static str,
        /// Smallest.
        min: f64,
        /// Largest.
        max: f64,
    },
    /// A whole number.
    Whole {
        /// Smallest.
        min: u32,
        /// Largest.
        max: u32,
    },
    /// One of some words; stands for its place in the list.
    Word(&'static [&'static str]),
}

impl Key {
    /// What is allowed, for people.
    #[must_use]
    pub fn allowed(&self) -> String {
        match self.value {
            Value::Number { unit, min, max } => format!("{min} to {max} ({unit})"),
            Value::Whole { min, max } => format!("a whole number from {min} to {max}"),
            Value::Word(words) => words
                .iter()
                .map(|word| format!("\"{word}\""))
                .collect::<Vec<_>>()
                .join(", "),
        }
    }

    /// Reads its value.
    pub(super) fn read(&self, value: &Spanned<DeValue<'_>>) -> Result<f64, Complaint> {
        let name = self.name;
        let complain = |message| Err(Complaint::new(value.span(), message));
        match self.value {
            Value::Number { min, max, .. } => match plain_number(value) {
                Some(number) if (min..=max).contains(&number) => Ok(number),
                Some(number) => complain(format!(
                    "{name} = {number} is out of range: allowed {}",
                    self.allowed()
                )),
                None => complain(format!("{name} must be a number, {}", self.allowed())),
            },
            Value::Whole { min, max } => match plain_number(value) {
                Some(number)
                    if number.fract() == 0.0
                        && (f64::from(min)..=f64::from(max)).contains(&number) =>
                {
                    Ok(number)
                }
                _ => complain(format!("{name} must be {}", self.allowed())),
            },
            Value::Word(words) => {
                let Some(word) = value.get_ref().as_str() else {
                    return complain(format!(
                        "{name} must be a word in quotes: one of {}",
                        self.allowed()
                    ));
                };
                let place = words.iter().position(|known| *known == word);
                match place {
                    Some(place) => Ok(place as f64),
                    None => {
                        let hint = suggestion(word, words.iter().copied());
                        complain(format!("unknown {name} `{word}`{hint}"))
                    }
                }
            }
        }
    }
}

/// Values of all `keys` in `table`, in their order; `others` stand there too and are read elsewhere. `place` is where
/// the table is, `of` what it is called.
pub(super) fn read_all(
    table: &DeTable<'_>,
    keys: &[&Key],
    others: &[&str],
    of: &str,
    place: Range<usize>,
) -> Result<Vec<f64>, Complaint> {
    for (key, _) in table {
        let name: &str = key.get_ref();
        if !others.contains(&name) && !keys.iter().any(|known| known.name == name) {
            let known = keys.iter().map(|known| known.name);
            let hint = suggestion(name, known.chain(others.iter().copied()));
            return Err(Complaint::new(
                key.span(),
                format!("unknown key `{name}` of {of}{hint}"),
            ));
        }
    }
    let value = |key: &&Key| match (table.get(key.name), key.default) {
        (Some(value), _) => key.read(value),
        (None, Some(default)) => Ok(default),
        (None, None) => Err(Complaint::new(
            place.clone(),
            format!(
                "{of} needs `{}` ({}): {}",
                key.name,
                key.what,
                key.allowed()
            ),
        )),
    };
    keys.iter().map(value).collect()
}
