//! Parameters over the link: by their place in the list of all, or by `section.name`.

use super::refusal::Refusal;
use super::reply::Reply;
use crate::settings::{Key, Number, Settings, Values};

/// Which parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which<'n> {
    /// By its place in the list.
    At(u16),
    /// By section and name.
    Named(&'n str),
}

/// What it is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NewValue<'n> {
    /// A number, in the parameter's unit.
    Number(f64),
    /// One of its words.
    Word(&'n str),
}

/// A parameter as the link tells of it, found on the way through all of them.
struct Search<'n> {
    which: Which<'n>,
    /// Written where it is found.
    value: Option<NewValue<'n>>,
    /// Parameters seen so far.
    count: u16,
    found: Option<Found>,
    refused: Option<Refusal>,
}

#[derive(Clone, Copy)]
struct Found {
    index: u16,
    key: Key,
    what: What,
}

#[derive(Clone, Copy)]
enum What {
    Number(Number, f64),
    Word {
        word: &'static str,
        at: u8,
        words: u8,
    },
}

impl Search<'_> {
    /// Goes over one parameter; true if it is the one.
    fn is_it(&mut self, key: Key) -> bool {
        let is_it = match self.which {
            Which::At(at) => at == self.count,
            Which::Named(name) => key.is(name),
        };
        self.count = self.count.saturating_add(1);
        is_it
    }

    fn keep(&mut self, key: Key, what: What) {
        let index = self.count.saturating_sub(1);
        self.found = Some(Found { index, key, what });
    }
}

impl Values for Search<'_> {
    fn number(&mut self, key: Key, number: &Number, value: f64) -> f64 {
        if !self.is_it(key) {
            return value;
        }
        self.keep(key, What::Number(*number, value));
        match self.value {
            Some(NewValue::Number(new)) if number.allows(new) => new,
            Some(NewValue::Number(_)) => {
                self.refused = Some(Refusal::ParameterOutOfRange);
                value
            }
            Some(NewValue::Word(_)) => {
                self.refused = Some(Refusal::WrongType);
                value
            }
            None => value,
        }
    }

    fn word(&mut self, key: Key, words: &[&'static str], value: &'static str) -> &'static str {
        if !self.is_it(key) {
            return value;
        }
        let at = words.iter().position(|word| *word == value);
        let what = What::Word {
            word: value,
            at: at.unwrap_or(0) as u8,
            words: words.len() as u8,
        };
        self.keep(key, what);
        match self.value {
            Some(NewValue::Word(new)) => {
                let known = words.iter().find(|word| **word == new);
                known.copied().unwrap_or_else(|| {
                    self.refused = Some(Refusal::UnknownWord);
                    value
                })
            }
            Some(NewValue::Number(_)) => {
                self.refused = Some(Refusal::WrongType);
                value
            }
            None => value,
        }
    }
}

// A call: it goes through every parameter.
#[inline(never)]
fn search<'n>(
    settings: &mut Settings,
    which: Which<'n>,
    value: Option<NewValue<'n>>,
) -> Search<'n> {
    let mut search = Search {
        which,
        value,
        count: 0,
        found: None,
        refused: None,
    };
    let names = settings.visit(&mut search);
    if value.is_some() {
        // One that cannot be made is found again by validation, once all are set.
        settings.note(names);
    }
    search
}

/// What is to be told of a parameter.
///
/// # Errors
/// [`Refusal::UnknownParameter`]
pub fn parameter(settings: &mut Settings, which: Which<'_>) -> Result<Reply<'static>, Refusal> {
    let search = search(settings, which, None);
    let count = search.count;
    let Found { index, key, what } = search.found.ok_or(Refusal::UnknownParameter)?;
    let Key { section, name } = key;
    Ok(match what {
        What::Number(number, value) => Reply::Parameter {
            index,
            count,
            section,
            name,
            unit: number.unit,
            value,
            min: number.min,
            max: number.max,
            default: number.default,
        },
        What::Word { word, at, words } => Reply::Word {
            index,
            count,
            section,
            name,
            word,
            at,
            words,
        },
    })
}

/// Writes a parameter. Whether it goes with the others is for [`Settings::validate`] to say.
///
/// # Errors
/// [`Refusal::UnknownParameter`], [`Refusal::ParameterOutOfRange`], [`Refusal::UnknownWord`], [`Refusal::WrongType`];
/// nothing is changed then.
pub fn write(
    settings: &mut Settings,
    which: Which<'_>,
    value: NewValue<'_>,
) -> Result<(), Refusal> {
    let search = search(settings, which, Some(value));
    search.found.ok_or(Refusal::UnknownParameter)?;
    search.refused.map_or(Ok(()), Err)
}
