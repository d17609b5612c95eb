//! Parameters as text and as JSON.

use std::fmt::Write as _;

use serde::Serialize;

use crate::axis_file::{Content, Entry, about};

/// A parameter in JSON.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub enum Row {
    /// A number.
    Number {
        name: String,
        value: f64,
        unit: String,
        min: f64,
        max: f64,
        default: f64,
        description: &'static str,
    },
    /// A word.
    Word {
        name: String,
        word: String,
        words: Vec<&'static str>,
        default: Option<String>,
        description: &'static str,
    },
}

impl Row {
    /// Of a parameter.
    pub fn of(entry: &Entry) -> Self {
        let (name, description) = (entry.name.clone(), entry.description);
        match &entry.content {
            Content::Number {
                value,
                unit,
                min,
                max,
                default,
            } => Self::Number {
                name,
                value: *value,
                unit: unit.clone(),
                min: *min,
                max: *max,
                default: *default,
                description,
            },
            Content::Word { word, words } => Self::Word {
                word: word.clone(),
                words: words.clone(),
                default: default_word(&name),
                name,
                description,
            },
        }
    }
}

/// The default of a word, which the axis does not tell.
fn default_word(name: &str) -> Option<String> {
    match about(name)?.content {
        Content::Word { word, .. } => Some(word),
        Content::Number { .. } => None,
    }
}

/// A parameter that was changed, or that differs.
#[derive(Debug, Serialize)]
pub struct Change {
    name: String,
    before: serde_json::Value,
    after: serde_json::Value,
    unit: String,
}

impl Change {
    /// Of a pair.
    pub fn of((before, after): &(Entry, Entry)) -> Self {
        let value = |entry: &Entry| match &entry.content {
            Content::Number { value, .. } => (*value).into(),
            Content::Word { word, .. } => word.clone().into(),
        };
        let unit = match &after.content {
            Content::Number { unit, .. } => unit.clone(),
            Content::Word { .. } => String::new(),
        };
        Self {
            name: after.name.clone(),
            before: value(before),
            after: value(after),
            unit,
        }
    }
}

/// Changes, a line each. Writing to a string cannot fail.
pub fn changes(changes: &[Change]) -> String {
    let plain = |value: &serde_json::Value| match value {
        serde_json::Value::String(word) => word.clone(),
        // As people write it, not as JSON does.
        value => value
            .as_f64()
            .map_or_else(|| value.to_string(), |number| number.to_string()),
    };
    let width = changes.iter().map(|change| change.name.len()).max();
    let width = width.unwrap_or_default();
    let mut text = String::new();
    for change in changes {
        let (before, after) = (plain(&change.before), plain(&change.after));
        let line = format!(
            "{:width$}  {before} -> {after} {}",
            change.name, change.unit
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

/// A table of parameters: those that are not at their default are marked.
pub fn table(entries: &[Entry]) -> String {
    let cells = entries.iter().map(cells);
    let rows: Vec<[String; 4]> = cells.collect();
    let width = |column: usize| {
        let widths = rows.iter().map(|row| row[column].chars().count());
        widths.max().unwrap_or_default()
    };
    let [name, value, range] = [width(0), width(1), width(2)];
    let mut text = String::new();
    for [a, b, c, d] in &rows {
        let line = format!("{a:name$}  {b:value$}  {c:range$}  {d}");
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text.push_str("(* is not the default)\n");
    text
}

fn cells(entry: &Entry) -> [String; 4] {
    let (is_default, range) = match &entry.content {
        Content::Number {
            value,
            min,
            max,
            default,
            ..
        } => (
            value == default,
            format!("{min} to {max}, default {default}"),
        ),
        Content::Word { word, words } => {
            let default = default_word(&entry.name);
            let is_default = default.as_ref().is_none_or(|default| default == word);
            let told = default.map_or_else(String::new, |default| format!(", default {default}"));
            (is_default, format!("{}{told}", words.join("|")))
        }
    };
    let mark = if is_default { "" } else { " *" };
    [
        entry.name.clone(),
        format!("{}{mark}", entry.content),
        range,
        entry.description.to_owned(),
    ]
}

/// One parameter.
pub fn one(entry: &Entry) -> String {
    let [name, value, range, description] = cells(entry);
    let blank = if description.is_empty() { "" } else { "\n" };
    format!("{name} = {value}\n({range})\n{description}{blank}")
}
