//! Parameters by their places: all of them in a number, one of them, some of them anew.

use crc::{CRC_32_ISO_HDLC, Crc, Digest, NoTable};
use leadscrew::protocol::refusal::Refusal;
use leadscrew::settings::{Key, Number, Settings, Values};

const CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// The list of parameters, as far as their places go. Firmware with another list has parameters at other registers; a
/// master compares the checksum before it writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ParameterList {
    /// How many there are.
    pub count: u16,
    /// CRC-32 (that of zip) of the name of each, in order, with a line feed behind; a word's name is followed by those that
    /// it may be, each behind a space.
    pub checksum: u32,
}

impl ParameterList {
    /// The list of `settings`.
    #[must_use]
    pub fn of(mut settings: Settings) -> Self {
        let mut names = Names {
            count: 0,
            digest: CRC.digest(),
        };
        settings.visit(&mut names);
        Self {
            count: names.count,
            checksum: names.digest.finalize(),
        }
    }
}

struct Names<'c> {
    count: u16,
    digest: Digest<'c, u32, NoTable>,
}

impl Names<'_> {
    fn add(&mut self, key: Key, words: &[&str]) {
        let texts = key.parts().map(str::as_bytes);
        texts.iter().for_each(|text| self.digest.update(text));
        for word in words {
            self.digest.update(b" ");
            self.digest.update(word.as_bytes());
        }
        self.digest.update(b"\n");
        self.count = self.count.saturating_add(1);
    }
}

impl Values for Names<'_> {
    fn number(&mut self, key: Key, _: &Number, value: f64) -> f64 {
        self.add(key, &[]);
        value
    }

    fn word(&mut self, key: Key, words: &[&'static str], value: &'static str) -> &'static str {
        self.add(key, words);
        value
    }
}

/// A parameter, in its own unit; a word is its place among those that it may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its value.
    pub value: f64,
    /// Smallest value allowed.
    pub min: f64,
    /// Largest value allowed.
    pub max: f64,
    /// What it is if nobody sets it; NaN for words, where that is the board's.
    pub default: f64,
}

impl Parameter {
    /// The parameter of `settings` at a place of the list.
    #[must_use]
    pub fn at(mut settings: Settings, index: u16) -> Option<Self> {
        let mut reader = Reader {
            left: usize::from(index),
            found: None,
        };
        settings.visit(&mut reader);
        reader.found
    }

    fn word(words: &[&str], value: &str) -> Self {
        let at = words.iter().position(|word| *word == value);
        Self {
            value: at.unwrap_or(0) as f64,
            min: 0.0,
            max: words.len().saturating_sub(1) as f64,
            default: f64::NAN,
        }
    }
}

struct Reader {
    left: usize,
    found: Option<Parameter>,
}

impl Reader {
    fn pass(&mut self, parameter: Parameter) {
        match self.left.checked_sub(1) {
            Some(left) => self.left = left,
            None => self.found = self.found.or(Some(parameter)),
        }
    }
}

impl Values for Reader {
    fn number(&mut self, _: Key, number: &Number, value: f64) -> f64 {
        let &Number {
            min, max, default, ..
        } = number;
        self.pass(Parameter {
            value,
            min,
            max,
            default,
        });
        value
    }

    fn word(&mut self, _: Key, words: &[&'static str], value: &'static str) -> &'static str {
        self.pass(Parameter::word(words, value));
        value
    }
}

/// `settings` with the parameters from `first` on anew. Whether they go together is for validation to say.
///
/// # Errors
/// [`Refusal::ParameterOutOfRange`] of a number, [`Refusal::UnknownWord`] of what is no place of a word,
/// [`Refusal::UnknownParameter`] if there are not so many.
pub fn with(mut settings: Settings, first: u16, values: &[f64]) -> Result<Settings, Refusal> {
    let mut writer = Writer {
        before: usize::from(first),
        rest: values,
        refused: None,
    };
    let names = settings.visit(&mut writer);
    if let Some(refusal) = writer.refused {
        return Err(refusal);
    }
    if !writer.rest.is_empty() {
        return Err(Refusal::UnknownParameter);
    }
    // One that cannot be made is found by validation.
    settings.note(names);
    Ok(settings)
}

struct Writer<'v> {
    before: usize,
    rest: &'v [f64],
    refused: Option<Refusal>,
}

impl Writer<'_> {
    /// The new value of the next parameter, if it has one.
    fn next(&mut self) -> Option<f64> {
        if let Some(before) = self.before.checked_sub(1) {
            self.before = before;
            return None;
        }
        let (value, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(*value)
    }

    fn refuse(&mut self, refusal: Refusal) {
        self.refused = self.refused.or(Some(refusal));
    }
}

impl Values for Writer<'_> {
    fn number(&mut self, _: Key, number: &Number, value: f64) -> f64 {
        match self.next() {
            Some(new) if number.allows(new) => new,
            Some(_) => {
                self.refuse(Refusal::ParameterOutOfRange);
                value
            }
            None => value,
        }
    }

    fn word(&mut self, _: Key, words: &[&'static str], value: &'static str) -> &'static str {
        let Some(new) = self.next() else {
            return value;
        };
        let mut places = words.iter().zip(0_u16..);
        let found = places.find(|(_, place)| f64::from(*place) == new);
        if found.is_none() {
            self.refuse(Refusal::UnknownWord);
        }
        found.map_or(value, |(word, _)| *word)
    }
}
