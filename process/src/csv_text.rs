//! CSV with a header line: columns by name, numbers with their place where they are wrong.

use std::ops::Range;

use csv::{ReaderBuilder, StringRecord, Trim};
use leadscrew_nc::source::{Complaint, Place};

/// A text as records.
pub struct CsvText<'t> {
    text: &'t str,
    columns: Vec<String>,
    records: Vec<StringRecord>,
}

/// A record of it.
#[derive(Clone, Copy)]
pub struct Row<'c> {
    csv: &'c CsvText<'c>,
    record: &'c StringRecord,
}

impl<'t> CsvText<'t> {
    /// Reads a text whose header has `needed` columns and may have `optional` ones. Lines that begin with # are comments.
    ///
    /// # Errors
    /// With line and column: no CSV, a column that is missing, unknown or there twice.
    pub fn read(text: &'t str, needed: &[&str], optional: &[&str]) -> Result<Self, Complaint> {
        let mut reader = ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(Trim::All)
            .flexible(true)
            .from_reader(text.as_bytes());
        let header = reader.headers().map_err(|error| complaint(&error))?.clone();
        let columns: Vec<_> = header.iter().map(str::to_lowercase).collect();
        let known = || needed.iter().chain(optional).copied();
        for (at, column) in columns.iter().enumerate() {
            let place = || field(text, &header, at);
            if !known().any(|known| known == column) {
                let known = known().collect::<Vec<_>>().join(", ");
                let message = format!("column \"{column}\" is not known: expected {known}");
                return Err(Complaint::at(text, &place(), message));
            }
            if columns[..at].contains(column) {
                let message = format!("column \"{column}\" is there twice");
                return Err(Complaint::at(text, &place(), message));
            }
        }
        if let Some(missing) = needed
            .iter()
            .find(|needed| !columns.iter().any(|column| column == *needed))
        {
            let message = format!(
                "there is no column \"{missing}\": the header is to be {}",
                needed.join(",")
            );
            return Err(Complaint::at(text, &field(text, &header, 0), message));
        }
        let mut records = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|error| complaint(&error))?;
            if record.len() != columns.len() {
                let (found, expected) = (record.len(), columns.len());
                let message = format!("{found} fields, and the header has {expected} columns");
                return Err(Complaint::at(text, &field(text, &record, 0), message));
            }
            records.push(record);
        }
        Ok(Self {
            text,
            columns,
            records,
        })
    }

    /// Whether it has a column.
    pub fn has(&self, column: &str) -> bool {
        self.columns.iter().any(|known| known == column)
    }

    /// Its records.
    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.records
            .iter()
            .map(move |record| Row { csv: self, record })
    }
}

impl Row<'_> {
    /// The text of a field; empty where the column is not there.
    pub fn text(&self, column: &str) -> &str {
        self.index(column)
            .and_then(|at| self.record.get(at))
            .unwrap_or_default()
    }

    /// The number of a field.
    ///
    /// # Errors
    /// No number, or out of range.
    pub fn number(&self, column: &str, (min, max): (f64, f64)) -> Result<f64, Complaint> {
        let text = self.text(column);
        let value: f64 = text.parse().map_err(|_| {
            self.complain(column, format!("{column} = \"{text}\": expected a number"))
        })?;
        if (min..=max).contains(&value) {
            return Ok(value);
        }
        let message = format!("{column} = {text} is out of range: allowed {min} to {max}");
        Err(self.complain(column, message))
    }

    /// What is wrong with a field.
    pub fn complain(&self, column: &str, message: impl Into<String>) -> Complaint {
        let at = field(self.csv.text, self.record, self.index(column).unwrap_or(0));
        Complaint::at(self.csv.text, &at, message)
    }

    fn index(&self, column: &str) -> Option<usize> {
        self.csv.columns.iter().position(|known| known == column)
    }
}

/// The bytes of a field, by the commas of its line.
fn field(text: &str, record: &StringRecord, index: usize) -> Range<usize> {
    let start = record
        .position()
        .map_or(0, |position| position.byte() as usize);
    // What the reader skips before a record.
    let line = text.get(start..).unwrap_or_default();
    let begins = start + line.len() - skipped(line).len();
    let line = text.get(begins..).unwrap_or_default();
    let line = line.split('\n').next().unwrap_or_default();
    let fields = line.split(',').scan(begins, |at, field| {
        let begins = *at + field.len() - field.trim_start().len();
        *at += field.len() + 1;
        Some(begins..begins + field.trim().len())
    });
    fields.into_iter().nth(index).unwrap_or(begins..begins)
}

/// The text behind empty lines and comments.
fn skipped(mut text: &str) -> &str {
    loop {
        let rest = text.trim_start_matches(['\n', '\r']);
        if !rest.starts_with('#') {
            return rest;
        }
        text = rest.split_once('\n').map_or("", |(_, rest)| rest);
    }
}

fn complaint(error: &csv::Error) -> Complaint {
    let line = error
        .position()
        .map_or(1, |position| position.line() as usize);
    Complaint {
        place: Place { line, column: 1 },
        message: error.to_string(),
    }
}
