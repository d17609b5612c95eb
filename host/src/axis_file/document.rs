//! From a document to settings.

use std::ops::Range;

use leadscrew::settings::{Key, Number, Settings, Values};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::entry::{Entry, all};
use crate::machine_file::stray_key;
use crate::toml_file::{self, Complaint, plain_number, suggestion};

/// What files of version 0.0 had above the sections, and where it is now.
const MOVED: (&str, &str) = ("position", "paths.position");

/// Makes settings of a text.
pub(super) fn parse(text: &str) -> Result<Settings, Complaint> {
    let document = toml_file::document(text)?;
    let document = document.get_ref();
    check_names(document, &all())?;
    let mut settings = super::defaults();
    let mut fill = Fill {
        document,
        complaint: None,
    };
    let names = settings.visit(&mut fill);
    if let Some(complaint) = fill.complaint {
        return Err(complaint);
    }
    let at = document.get("estimator").map_or(0..0, Spanned::span);
    settings
        .choose(names)
        .map_err(|error| Complaint::new(at, format!("the observer cannot be made: {error}")))?;
    Ok(settings)
}

/// Complains of the first key or section that there is not.
fn check_names(document: &DeTable<'_>, known: &[Entry]) -> Result<(), Complaint> {
    let in_section = |section: &str| -> Vec<&str> {
        let parts = known.iter().map(Entry::parts);
        parts
            .filter(|(of, _)| *of == section)
            .map(|(_, name)| name)
            .collect()
    };
    let mut sections: Vec<&str> = known.iter().map(|entry| entry.parts().0).collect();
    sections.retain(|section| !section.is_empty());
    sections.dedup();
    let mut above = in_section("");
    above.push(MOVED.0);
    for (key, value) in document {
        let name: &str = key.get_ref();
        let DeValue::Table(table) = value.get_ref() else {
            if above.contains(&name) {
                continue;
            }
            let message = stray_key(name, &sections, &above);
            return Err(Complaint::new(key.span(), message));
        };
        if !sections.contains(&name) {
            let hint = suggestion(name, sections.iter().copied());
            let message = format!("unknown section [{name}]{hint}");
            return Err(Complaint::new(key.span(), message));
        }
        let names = in_section(name);
        let stray = table
            .iter()
            .find(|(key, _)| !names.contains(&key.get_ref().as_ref()));
        if let Some((key, _)) = stray {
            let hint = suggestion(key.get_ref(), names);
            let message = format!("unknown key `{}` in [{name}]{hint}", key.get_ref());
            return Err(Complaint::new(key.span(), message));
        }
    }
    Ok(())
}

/// Gives the values of a document, and keeps the first complaint.
struct Fill<'a> {
    document: &'a DeTable<'a>,
    complaint: Option<Complaint>,
}

impl<'a> Fill<'a> {
    fn find(&self, key: Key) -> Option<&'a Spanned<DeValue<'a>>> {
        if key.section.is_empty() {
            return self.document.get(key.name);
        }
        let section = self.document.get(key.section);
        let found = section
            .and_then(|section| section.get_ref().as_table())
            .and_then(|table| table.get(key.name));
        let moved = || self.document.get(MOVED.0).filter(|_| key.is(MOVED.1));
        found.or_else(moved)
    }

    fn complain(&mut self, at: Range<usize>, message: String) {
        self.complaint.get_or_insert(Complaint::new(at, message));
    }
}

impl Values for Fill<'_> {
    fn number(&mut self, key: Key, number: &Number, value: f64) -> f64 {
        let Some(found) = self.find(key) else {
            return value;
        };
        let Number { unit, min, max, .. } = number;
        let name = key.name;
        match plain_number(found) {
            Some(read) if number.allows(read) => return read,
            Some(read) => {
                let message =
                    format!("{name} = {read} is out of range: allowed {min} to {max} ({unit})");
                self.complain(found.span(), message);
            }
            None => {
                let message = format!("{name} must be a number ({unit}, {min} to {max})");
                self.complain(found.span(), message);
            }
        }
        value
    }

    fn word(&mut self, key: Key, words: &[&'static str], value: &'static str) -> &'static str {
        let Some(found) = self.find(key) else {
            return value;
        };
        let name = key.name;
        let Some(read) = found.get_ref().as_str() else {
            let words = words.join(", ");
            let message = format!("{name} must be a name in quotes: one of {words}");
            self.complain(found.span(), message);
            return value;
        };
        if let Some(word) = words.iter().find(|word| **word == read) {
            return word;
        }
        let hint = suggestion(read, words.iter().copied());
        self.complain(found.span(), format!("unknown {name} `{read}`{hint}"));
        value
    }
}
