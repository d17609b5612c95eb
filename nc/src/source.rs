//! What is wrong in a text, and where: the same for programs, settings and tables.

mod encoding;
mod words;

use std::borrow::Cow;
use std::fmt;
use std::ops::Range;

use serde::de::DeserializeOwned;
use toml::de::DeTable;

pub use encoding::{UTF_8_MARK, text_of, wide_mark};
pub use words::{decimal_comma, nearest, number_of, toml_message};

/// A message that is longer is shown without its middle, characters.
const LONGEST_MESSAGE: usize = 800;
/// What is shown of the beginning and the end of such a one, characters.
const SHOWN: (usize, usize) = (80, 320);

/// A place in a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1, characters.
    pub column: usize,
}

impl Place {
    /// The place of a byte of `text`; beyond its end the place after its last character.
    #[must_use]
    pub fn of(text: &str, byte: usize) -> Self {
        let mut end = byte.min(text.len());
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        let before = &text[..end];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Self {
            line: 1 + before.matches('\n').count(),
            column: 1 + before[line_start..].chars().count(),
        }
    }
}

/// What is wrong in a text: what was found, what was expected, what to do. Who knows the file puts its name and a colon in
/// front.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Complaint {
    /// Where.
    pub place: Place,
    /// What is wrong and what was expected.
    pub message: String,
}

impl Complaint {
    /// A complaint about a stretch of `text`.
    #[must_use]
    pub fn at(text: &str, span: &Range<usize>, message: impl Into<String>) -> Self {
        Self {
            place: Place::of(text, span.start),
            message: message.into(),
        }
    }
}

impl fmt::Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Place { line, column } = self.place;
        write!(f, "{line}:{column}: {}", one_line(&self.message))
    }
}

impl std::error::Error for Complaint {}

/// A message as one line of a length that can be read: what was found in a file may be long, or have line ends in it.
fn one_line(message: &str) -> Cow<'_, str> {
    let count = message.chars().count();
    if count <= LONGEST_MESSAGE && !message.contains(char::is_control) {
        return Cow::Borrowed(message);
    }
    let shown = |c: char| match c {
        '\t' | '\n' | '\r' => ' ',
        c if c.is_control() => char::REPLACEMENT_CHARACTER,
        c => c,
    };
    let characters = || message.chars().map(shown);
    if count <= LONGEST_MESSAGE {
        return characters().collect();
    }
    let (first, last) = SHOWN;
    let beginning = characters().take(first).chain(" … ".chars());
    beginning.chain(characters().skip(count - last)).collect()
}

/// A TOML text as the type that derives [`serde::Deserialize`]; values whose range is checked later keep their place as
/// [`toml::Spanned`].
///
/// # Errors
/// Where the text is no TOML, or a key is missing, unknown or of another type.
pub fn read_toml<T: DeserializeOwned>(text: &str) -> Result<T, Complaint> {
    toml::from_str(text).map_err(|error| {
        Complaint::at(
            text,
            &error.span().unwrap_or(0..0),
            toml_message(text, &error),
        )
    })
}

/// Where the value of a key stands in a TOML text, `["control", "start", "X"]`; where it is not there, the nearest table around it.
#[must_use]
pub fn span_of(text: &str, key: &[&str]) -> Range<usize> {
    let (root, _) = DeTable::parse_recoverable(text);
    let mut span = 0..0;
    let mut table = Some(root.get_ref());
    for name in key {
        let Some(value) = table.and_then(|table| table.get(*name)) else {
            break;
        };
        span = value.span();
        table = value.get_ref().as_table();
    }
    span
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::*;

    #[test]
    fn a_place_counts_lines_and_characters_from_1() {
        let text = "aä\nbc";
        let place = |byte| {
            let Place { line, column } = Place::of(text, byte);
            (line, column)
        };
        assert_eq!(place(0), (1, 1));
        assert_eq!(place(2), (1, 2), "in the middle of a character");
        assert_eq!(place(3), (1, 3));
        assert_eq!(place(4), (2, 1));
        assert_eq!(place(99), (2, 3));
    }

    #[test]
    fn what_a_file_says_does_not_break_or_swamp_the_message() {
        let shown = |message: &str| Complaint::at("", &(0..0), message).to_string();
        assert_eq!(shown("`a\n\tb\0`: no"), "1:1: `a  b\u{fffd}`: no");
        let long = shown(&format!("`{}`: expected a number", "ä".repeat(1_000_000)));
        assert_eq!(long.chars().count(), "1:1: ".len() + SHOWN.0 + 3 + SHOWN.1);
        assert!(long.starts_with("1:1: `ä") && long.ends_with("ä`: expected a number"));
    }

    #[test]
    fn a_key_is_found_by_its_path() {
        let text = "a = 1\n[control]\nstart = { X = 2 }\n[control.tools.3]\nlength = 5\n";
        let at = |key: &[&str]| &text[span_of(text, key)];
        assert_eq!(at(&["control", "start", "X"]), "2");
        assert_eq!(at(&["control", "start", "Y"]), "{ X = 2 }");
        assert_eq!(at(&["control", "tools", "3", "length"]), "5");
        assert_eq!(at(&["a", "b"]), "1");
        assert_eq!(at(&["c"]), "");
    }

    #[test]
    fn a_toml_error_tells_its_line_and_column() {
        #[derive(Debug, Deserialize)]
        #[serde(deny_unknown_fields)]
        struct File {
            _length_mm: f64,
        }
        let error = read_toml::<File>("_length_mm = 1.0\n  widht_mm = 2.0\n").unwrap_err();
        assert_eq!(error.place, Place { line: 2, column: 3 });
        assert!(
            error.to_string().starts_with("2:3: unknown field"),
            "{error}"
        );
        assert!(read_toml::<File>("_length_mm = 1.0").is_ok());
    }
}
