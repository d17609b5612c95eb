//! The bytes of a set of parameters: entries one after the other, each
//!
//! | bytes | content |
//! | --- | --- |
//! | 1 | length n of the name |
//! | 1 | type: 0 a number (f64), 1 a word (UTF-8) |
//! | 1 | length v of the value |
//! | n | name, `section.name` |
//! | v | value; numbers little endian |
//!
//! so that an entry of unknown name or type can be passed over, and kept.

use leadscrew::settings::Key;

const HEADER: usize = 3;
const NUMBER: u8 = 0;
const WORD: u8 = 1;

/// A value as it is stored. Numbers have 64 bits since parameters have: what was set is read back to the last bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<'s> {
    /// A number in the parameter's unit.
    Number(f64),
    /// One of a few words.
    Word(&'s str),
    /// Of a type that this firmware does not know.
    Other,
}

/// One entry of a set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetEntry<'s> {
    /// `section.name`.
    pub name: &'s str,
    /// Its value.
    pub value: Value<'s>,
    pub(super) bytes: &'s [u8],
}

/// Goes over the entries of a set; ends where the bytes make none.
#[derive(Clone, Copy, Debug)]
pub(super) struct Set<'s> {
    rest: &'s [u8],
}

impl<'s> Set<'s> {
    pub const fn new(bytes: &'s [u8]) -> Self {
        Self { rest: bytes }
    }

    /// The value of that name.
    pub fn value(self, key: Key) -> Option<Value<'s>> {
        self.into_iter()
            .find(|entry| key.is(entry.name))
            .map(|entry| entry.value)
    }
}

impl<'s> Iterator for Set<'s> {
    type Item = SetEntry<'s>;

    fn next(&mut self) -> Option<SetEntry<'s>> {
        let [name_len, kind, value_len, ..] = *self.rest else {
            return None;
        };
        let (name_len, value_len) = (usize::from(name_len), usize::from(value_len));
        let (bytes, rest) = self.rest.split_at_checked(HEADER + name_len + value_len)?;
        let (name, value) = bytes[HEADER..].split_at(name_len);
        self.rest = rest;
        let number = || value.try_into().ok().map(f64::from_le_bytes);
        let value = match kind {
            NUMBER => number().map(Value::Number),
            WORD => str::from_utf8(value).ok().map(Value::Word),
            _ => None,
        };
        Some(SetEntry {
            // A name that is no text is nobody's: it is kept as unknown.
            name: str::from_utf8(name).unwrap_or_default(),
            value: value.unwrap_or(Value::Other),
            bytes,
        })
    }
}

/// Writes entries into lent memory.
#[derive(Debug)]
pub(super) struct SetWriter<'m> {
    memory: &'m mut [u8],
    /// Bytes written, or that would have been.
    len: usize,
}

impl<'m> SetWriter<'m> {
    pub const fn new(memory: &'m mut [u8]) -> Self {
        Self { memory, len: 0 }
    }

    pub const fn len(&self) -> usize {
        self.len
    }

    pub fn entry(&mut self, key: Key, value: Value<'_>) {
        let number;
        let (kind, value) = match value {
            Value::Number(value) => {
                number = value.to_le_bytes();
                (NUMBER, number.as_slice())
            }
            Value::Word(word) => (WORD, word.as_bytes()),
            Value::Other => return,
        };
        let [section, dot, name] = key.parts();
        let name_len = section.len() + dot.len() + name.len();
        self.push(&[name_len as u8, kind, value.len() as u8]);
        for part in [section, dot, name] {
            self.push(part.as_bytes());
        }
        self.push(value);
    }

    fn push(&mut self, bytes: &[u8]) {
        if let Some(place) = self.memory.get_mut(self.len..self.len + bytes.len()) {
            place.copy_from_slice(bytes);
        }
        self.len += bytes.len();
    }
}
