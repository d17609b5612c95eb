//! CSV with a header line: columns by name, numbers with their place where they are wrong.

use std::ops::Range;

use crate::source::{Complaint, Place};
use csv::{ReaderBuilder, StringRecord, Trim};

/// A text as records.
#[derive(Debug)]
pub struct CsvText<'t> {
    text: &'t str,
    columns: Vec<String>,
    records: Vec<StringRecord>,
}

/// A record of it.
#[derive(Clone, Copy, Debug)]
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
    #[must_use]
    pub fn has(&self, column: &str) -> bool {
        self.columns.iter().any(|known| known == column)
    }

    /// What is wrong with the header as a whole.
    pub fn complain_of_header(&self, message: impl Into<String>) -> Complaint {
        let at = self.text.len() - skipped(self.text).len();
        Complaint::at(self.text, &(at..at), message)
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
    #[must_use]
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

    /// The finite number of a field, none where it is empty or not there.
    ///
    /// # Errors
    /// Something else.
    pub fn optional_number(&self, column: &str) -> Result<Option<f64>, Complaint> {
        let text = self.text(column);
        if text.is_empty() {
            return Ok(None);
        }
        let finite = text.parse().ok().filter(|number: &f64| number.is_finite());
        finite
            .map(Some)
            .ok_or_else(|| self.complain(column, format!("`{text}`: expected a number")))
    }

    /// What is wrong with a field.
    pub fn complain(&self, column: &str, message: impl Into<String>) -> Complaint {
        Complaint::at(self.csv.text, &self.span(column), message)
    }

    /// Where a field stands in the text; that of the first one for a column that is not there.
    #[must_use]
    pub fn span(&self, column: &str) -> Range<usize> {
        field(self.csv.text, self.record, self.index(column).unwrap_or(0))
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
    let span = spans(line).into_iter().nth(index).unwrap_or(0..0);
    begins + span.start..begins + span.end
}

/// Where the fields of a line stand, without blanks around them: a comma between quotes parts none.
fn spans(line: &str) -> Vec<Range<usize>> {
    let (mut from, mut is_quoted) = (0, false);
    let mut spans = Vec::new();
    for (at, byte) in line.bytes().chain([b',']).enumerate() {
        match byte {
            b'"' => is_quoted = !is_quoted,
            b',' if !is_quoted || at == line.len() => {
                let field = &line[from..at];
                let start = from + field.len() - field.trim_start().len();
                spans.push(start..start + field.trim().len());
                from = at + 1;
            }
            _ => {}
        }
    }
    spans
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

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<CsvText<'_>, Complaint> {
        CsvText::read(text, &["name"], &["x", "y"])
    }

    #[test]
    fn fields_keep_their_places() {
        let text = "# a table\nname, x,y\n\n\"a, b\", 1.5 ,\nc,zwei,3\n";
        let table = read(text).unwrap();
        let [first, second] = table.rows().collect::<Vec<_>>()[..] else {
            panic!("two rows");
        };
        assert_eq!(first.text("name"), "a, b");
        assert_eq!(first.optional_number("x").unwrap(), Some(1.5));
        assert_eq!(first.optional_number("y").unwrap(), None);
        let error = second.optional_number("x").unwrap_err();
        assert_eq!(error.to_string(), "5:3: `zwei`: expected a number");
        assert_eq!(first.complain("x", "here").to_string(), "4:9: here");
        assert_eq!(table.complain_of_header("no").to_string(), "2:1: no");
    }

    #[test]
    fn what_is_no_table_is_refused() {
        let message = |text| read(text).map(|_| ()).unwrap_err().to_string();
        assert_eq!(
            message(""),
            "1:1: there is no column \"name\": the header is to be name"
        );
        assert_eq!(
            message("name,z"),
            "1:6: column \"z\" is not known: expected name, x, y"
        );
        assert_eq!(message("name,x,x"), "1:8: column \"x\" is there twice");
        assert_eq!(
            message("name,x\na,1,2\n"),
            "2:1: 3 fields, and the header has 2 columns"
        );
    }
}
