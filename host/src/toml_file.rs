//! What all TOML files have in common: their errors, with file and line, and numbers within a range.

use std::ops::Range;
use std::path::{Path, PathBuf};

use leadscrew::parameter_table::{Field, ParameterTable};
use leadscrew_nc::source::{nearest, toml_message};
use thiserror::Error;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::text_file::{self, TextFileError};

/// Why a TOML file cannot be used.
#[derive(Debug, Error)]
pub enum TomlFileError {
    /// It gives no text.
    #[error(transparent)]
    Text(#[from] TextFileError),
    /// It says something that is not understood or not allowed.
    #[error("{}:{line}: {message}", file.display())]
    Content {
        /// The file.
        file: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong and what was expected.
        message: String,
    },
}

/// What is wrong, and where in the text.
pub(crate) struct Complaint {
    pub at: Range<usize>,
    pub message: String,
}

impl Complaint {
    pub fn new(at: Range<usize>, message: impl Into<String>) -> Self {
        Self {
            at,
            message: message.into(),
        }
    }
}

/// Reads a file and makes of its text what `parse` does.
pub(crate) fn read<T>(
    path: &Path,
    parse: impl FnOnce(&str) -> Result<T, Complaint>,
) -> Result<T, TomlFileError> {
    let text = text_file::read(path)?;
    parse(&text).map_err(|Complaint { at, message }| TomlFileError::Content {
        file: path.to_owned(),
        line: 1 + text.get(..at.start).unwrap_or(&text).matches('\n').count(),
        message,
    })
}

/// The document in a text.
pub(crate) fn document(text: &str) -> Result<Spanned<DeTable<'_>>, Complaint> {
    DeTable::parse(text)
        .map_err(|error| Complaint::new(error.span().unwrap_or(0..0), toml_message(text, &error)))
}

/// Sets the keys of a section.
pub(crate) fn fill<T: ParameterTable>(
    params: &mut T,
    section: &str,
    table: &DeTable<'_>,
) -> Result<(), Complaint> {
    for (key, value) in table {
        let name: &str = key.get_ref();
        let Some(field) = T::FIELDS.iter().find(|field| field.name == name) else {
            let hint = suggestion(name, T::FIELDS.iter().map(|field| field.name));
            return Err(Complaint::new(
                key.span(),
                format!("unknown key `{name}` in [{section}]{hint}"),
            ));
        };
        (field.set)(params, number(field, value)?);
    }
    Ok(())
}

fn number<T>(field: &Field<T>, value: &Spanned<DeValue<'_>>) -> Result<f64, Complaint> {
    let Field {
        name,
        unit,
        min,
        max,
        ..
    } = field;
    let number = plain_number(value).ok_or_else(|| {
        Complaint::new(
            value.span(),
            format!("{name} must be a number ({unit}, {min} to {max})"),
        )
    })?;
    if !(*min..=*max).contains(&number) {
        return Err(Complaint::new(
            value.span(),
            format!("{name} = {number} is out of range: allowed {min} to {max} ({unit})"),
        ));
    }
    match rule(name) {
        Some((holds, expected)) if !holds(number) => Err(Complaint::new(
            value.span(),
            format!("{name} = {number} is not allowed: it must be {expected}"),
        )),
        _ => Ok(number),
    }
}

/// The number that a value is, if it is one.
pub(crate) fn plain_number(value: &Spanned<DeValue<'_>>) -> Option<f64> {
    match value.get_ref() {
        DeValue::Float(float) => float.as_str().replace('_', "").parse().ok(),
        DeValue::Integer(integer) => {
            i64::from_str_radix(&integer.as_str().replace('_', ""), integer.radix())
                .ok()
                .map(|whole| whole as f64)
        }
        _ => None,
    }
}

/// Whether a value keeps a rule.
type Holds = fn(f64) -> bool;

/// What a key must keep beside its range, and the same in words.
fn rule(name: &str) -> Option<(Holds, &'static str)> {
    match name {
        "edges_per_revolution" => Some((|edges| edges % 4.0 == 0.0, "a multiple of 4")),
        "linear_scale" => Some((|choice| choice == 0.0 || choice == 1.0, "0 or 1")),
        _ => None,
    }
}

/// «: did you mean …?» for a word close to a known one, else the known ones.
pub(crate) fn suggestion<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    match nearest(word, known.iter().copied()) {
        Some(near) => format!(": did you mean `{near}`?"),
        None => format!(": expected one of {}", known.join(", ")),
    }
}
