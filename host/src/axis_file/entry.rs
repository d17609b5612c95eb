//! Values by name, with what is to be said of each; and the text of a file of them.

use std::fmt::Write as _;

use leadscrew::settings::{Key, Number, Settings, Values};

/// A value with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Section and name, with a point between them; the name alone where it has no section.
    pub name: String,
    /// What it is for; empty where this tool does not know it.
    pub description: &'static str,
    /// The value.
    pub content: Content,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// A number with its unit and its range.
    Number {
        /// The number.
        value: f64,
        /// Its unit, for people.
        unit: String,
        /// Smallest value allowed.
        min: f64,
        /// Largest value allowed.
        max: f64,
        /// What it is if nobody sets it.
        default: f64,
    },
    /// One of a few words.
    Word {
        /// The word.
        word: String,
        /// All of them, where they are known.
        words: Vec<&'static str>,
    },
}

impl Entry {
    /// Section, empty where there is none, and name.
    #[must_use]
    pub fn parts(&self) -> (&str, &str) {
        self.name.split_once('.').unwrap_or(("", &self.name))
    }

    /// True where both are the same number or word.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        match (&self.content, &other.content) {
            (Content::Number { value, .. }, Content::Number { value: other, .. }) => {
                value.to_bits() == other.to_bits() || value == other
            }
            (Content::Word { word, .. }, Content::Word { word: other, .. }) => word == other,
            _ => false,
        }
    }
}

impl std::fmt::Display for Content {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number { value, unit, .. } => write!(f, "{value} {unit}"),
            Self::Word { word, .. } => f.write_str(word),
        }
    }
}

/// Meaning of the words, which the core only names.
fn description_of_word(key: Key) -> &'static str {
    match (key.section, key.name) {
        ("paths", "position") => {
            "Position in the loop: the middle of the count, or the estimator's, which is to have no lag"
        }
        ("paths", "velocity") => "Estimator whose velocity the loop takes",
        ("paths", "acceleration") => "Estimator whose acceleration the loop takes",
        ("paths", "display") => "Estimator that is shown",
        ("", "estimator") => "First estimator",
        ("", "second_estimator") => "Second estimator, beside the first",
        _ => "",
    }
}

struct Collect(Vec<Entry>);

impl Values for Collect {
    fn number(&mut self, key: Key, number: &Number, value: f64) -> f64 {
        self.0.push(Entry {
            name: key.to_string(),
            description: number.description,
            content: Content::Number {
                value,
                unit: number.unit.to_owned(),
                min: number.min,
                max: number.max,
                default: number.default,
            },
        });
        value
    }

    fn word(&mut self, key: Key, words: &[&'static str], value: &'static str) -> &'static str {
        self.0.push(Entry {
            name: key.to_string(),
            description: description_of_word(key),
            content: Content::Word {
                word: value.to_owned(),
                words: words.to_vec(),
            },
        });
        value
    }
}

/// The values of settings, in the order of the core.
#[must_use]
pub fn entries(settings: &Settings) -> Vec<Entry> {
    let mut settings = *settings;
    let mut collect = Collect(Vec::new());
    settings.visit(&mut collect);
    collect.0
}

/// The defaults of all values that this tool knows.
#[must_use]
pub fn all() -> Vec<Entry> {
    entries(&super::defaults())
}

/// What this tool knows of a value; `None` of another version's.
#[must_use]
pub fn about(name: &str) -> Option<Entry> {
    all().into_iter().find(|entry| entry.name == name)
}

/// The text of a file: what has no section first, then section by section. `head` may have lines.
#[must_use]
pub fn text(head: &str, entries: &[Entry]) -> String {
    let mut text = String::new();
    for line in head.lines() {
        let _ = writeln!(text, "# {line}");
    }
    let mut sections: Vec<&str> = vec![""];
    for entry in entries {
        let (section, _) = entry.parts();
        if !sections.contains(&section) {
            sections.push(section);
        }
    }
    for section in sections {
        if !section.is_empty() {
            let _ = write!(text, "\n[{section}]\n");
        }
        for entry in entries.iter().filter(|entry| entry.parts().0 == section) {
            key(&mut text, entry);
        }
    }
    text
}

/// A key with its comment. Writing to a string cannot fail.
fn key(text: &mut String, entry: &Entry) {
    let (_, name) = entry.parts();
    let blank = if entry.description.is_empty() {
        ""
    } else {
        " "
    };
    let _ = write!(text, "# {}{blank}", entry.description);
    let _ = match &entry.content {
        Content::Number {
            value,
            unit,
            min,
            max,
            ..
        } => writeln!(text, "({unit}, {min} to {max})\n{name} = {value:?}"),
        Content::Word { word, words } if words.is_empty() => {
            writeln!(text, "(a word)\n{name} = \"{word}\"")
        }
        Content::Word { word, words } => {
            let words = words.join(", ");
            writeln!(text, "(one of {words})\n{name} = \"{word}\"")
        }
    };
}
