//! Values of parameters as people write them.

use leadscrew_client::{Axis, Error, Parameter, Value};

use crate::axis_file::{self, Content, Entry};
use crate::error::CommandError;
use crate::toml_file::suggestion;

/// A value that a parameter is to have.
#[derive(Clone, Debug, PartialEq)]
pub enum NewValue {
    /// A number in the parameter's unit.
    Number(f64),
    /// A word.
    Word(String),
}

/// A parameter that is to be set.
#[derive(Clone, Debug, PartialEq)]
pub struct Edit {
    /// Section and name, with a point between them.
    pub name: String,
    /// What it is to be.
    pub value: NewValue,
}

/// What the axis says of a parameter, with what this tool knows of it.
#[must_use]
pub fn entry(parameter: Parameter) -> Entry {
    let known = axis_file::about(&parameter.name);
    let description = known.as_ref().map_or("", |known| known.description);
    let content = match parameter.value {
        Value::Number {
            value,
            unit,
            min,
            max,
            default,
        } => Content::Number {
            value,
            unit,
            min,
            max,
            default,
        },
        Value::Word(word) => Content::Word {
            word,
            words: match known.map(|known| known.content) {
                Some(Content::Word { words, .. }) => words,
                _ => Vec::new(),
            },
        },
    };
    Entry {
        name: parameter.name,
        description,
        content,
    }
}

/// All parameters of the axis.
///
/// # Errors
/// Of a lost axis.
pub fn entries(axis: &mut Axis) -> Result<Vec<Entry>, Error> {
    Ok(axis.parameters()?.into_iter().map(entry).collect())
}

/// A number and the unit behind it, which may be empty; `None` if it does not begin with a number.
#[must_use]
pub fn split_unit(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let ends = text.char_indices().map(|(at, _)| at).chain([text.len()]);
    let mut ends: Vec<usize> = ends.filter(|at| *at > 0).collect();
    ends.reverse();
    ends.into_iter().find_map(|end| {
        let (number, unit) = text.split_at(end);
        let value = number.trim_end().parse().ok()?;
        Some((value, unit.trim()))
    })
}

/// The number of a text in `unit`, which may be behind it.
///
/// # Errors
/// It is none, or in another unit: a sentence that begins with `what`.
pub fn number_in(what: &str, text: &str, unit: &str) -> Result<f64, String> {
    let example = || {
        if is_plain(unit) {
            "as 0.5".to_owned()
        } else {
            format!("as 5 or 5{unit}")
        }
    };
    let Some((value, given)) = split_unit(text) else {
        return Err(format!(
            "{what} = {text}: this is no number. Give a number in {}, {}",
            named(unit),
            example()
        ));
    };
    if given.is_empty() || spelt(given) == spelt(unit) {
        return Ok(value);
    }
    Err(format!(
        "{what} = {text}: its unit is {}, not {given}. Give the value in {}, {}",
        named(unit),
        named(unit),
        example()
    ))
}

/// True of what is no unit that could stand behind a number.
fn is_plain(unit: &str) -> bool {
    unit.is_empty() || unit == "1" || unit.contains(' ')
}

fn named(unit: &str) -> &str {
    match unit {
        "" | "1" => "plain numbers",
        unit => unit,
    }
}

/// A unit in the letters of every keyboard.
fn spelt(unit: &str) -> String {
    unit.replace('²', "2")
        .replace('³', "3")
        .replace(['µ', 'μ'], "u")
        .replace('·', "*")
        .replace(' ', "")
}

/// Makes an edit of a name and a text, after asking the axis what that parameter is.
///
/// # Errors
/// No such parameter, another unit, out of range, no such word.
pub fn edit(axis: &mut Axis, name: &str, text: &str) -> Result<Edit, CommandError> {
    let known = entry(axis.parameter(name)?);
    let value = match known.content {
        Content::Number { unit, min, max, .. } => {
            let value = number_in(name, text, &unit).map_err(CommandError::Usage)?;
            if !(min..=max).contains(&value) {
                let name = name.to_owned();
                return Err(CommandError::Axis(Error::ParameterOutOfRange {
                    name,
                    value,
                    unit,
                    min,
                    max,
                }));
            }
            NewValue::Number(value)
        }
        Content::Word { words, .. } => {
            if !words.is_empty() && !words.contains(&text) {
                let hint = suggestion(text, words);
                let message = format!("{name} = {text}: there is no such word{hint}");
                return Err(CommandError::Usage(message));
            }
            NewValue::Word(text.to_owned())
        }
    };
    Ok(Edit {
        name: name.to_owned(),
        value,
    })
}

/// Sets all of them at once.
///
/// # Errors
/// [`Error::Refused`]: nothing is changed then.
pub fn set(axis: &mut Axis, edits: &[Edit]) -> Result<(), Error> {
    let done = axis.edit_parameters(|axis| {
        edits.iter().try_for_each(|edit| match &edit.value {
            NewValue::Number(value) => axis.set_parameter(&edit.name, *value),
            NewValue::Word(word) => axis.set_word(&edit.name, word),
        })
    });
    done.map_err(|error| named_request(error, "Setting parameters"))
}

/// The same error with other words for the request that was refused, unless it has some of its own.
#[must_use]
pub fn named_request(error: Error, asked: &str) -> Error {
    match error {
        Error::Refused(mut refused) if !refused.asked.contains(' ') => {
            asked.clone_into(&mut refused.asked);
            Error::Refused(refused)
        }
        error => error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_taken_where_it_is_the_right_one() {
        for (text, unit, value) in [
            ("9000mm/min", "mm/min", 9000.0),
            ("-1.5e-3 mm", "mm", -0.0015),
            ("3 1/s2", "1/s²", 3.0),
            ("0.25", "of full command", 0.25),
            ("7", "1", 7.0),
        ] {
            let read = number_in("x", text, unit);
            assert!(
                read.is_ok_and(|read| (read - value).abs() < 1e-12),
                "{text}"
            );
        }
    }

    #[test]
    fn another_unit_is_refused_with_the_right_one() {
        for (text, unit, part) in [
            ("5m", "mm", "its unit is mm, not m"),
            ("5 %", "1", "its unit is plain numbers, not %"),
            ("150mm/s", "mm/min", "5mm/min"),
            ("fast", "mm/min", "no number"),
            ("1,5", "mm", "not ,5"),
            ("", "mm", "no number"),
        ] {
            let message = number_in("x", text, unit).expect_err(text);
            assert!(message.contains(part), "{message}");
        }
    }
}
