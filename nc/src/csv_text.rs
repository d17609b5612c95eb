//! CSV with a header line: columns by name, numbers with their place where they are wrong. `checks` says what is no such table.

mod checks;

use std::ops::Range;

use crate::source::{Complaint, Place, number_of};
use checks::{check_header, check_length};
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
    /// With line and column: no CSV, fields that something else than commas parts, a column that is missing, unknown or there
    /// twice.
    pub fn read(text: &'t str, needed: &[&str], optional: &[&str]) -> Result<Self, Complaint> {
        let mut reader = ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(Trim::All)
            .flexible(true)
            .from_reader(text.as_bytes());
        let header = reader.headers().map_err(|error| complaint(&error))?.clone();
        let columns: Vec<_> = header.iter().map(str::to_lowercase).collect();
        check_header(text, &header, &columns, needed, optional)?;
        let mut records = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|error| complaint(&error))?;
            check_length(text, &record, columns.len())?;
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
        let value = number_of(text).map_err(|expected| {
            self.complain(column, format!("{column} = \"{text}\": {expected}"))
        })?;
        if value.is_finite() && (min..=max).contains(&value) {
            return Ok(value);
        }
        let expected = if (min, max) == (f64::MIN, f64::MAX) {
            "expected a finite number".to_owned()
        } else {
            format!("allowed {min} to {max}")
        };
        let message = format!("{column} = {text} is out of range: {expected}");
        Err(self.complain(column, message))
    }

    /// The finite number of a field, none where it is empty or not there.
    ///
    /// # Errors
    /// Something else.
    pub fn optional_number(&self, column: &str) -> Result<Option<f64>, Complaint> {
        if self.text(column).is_empty() {
            return Ok(None);
        }
        self.number(column, (f64::MIN, f64::MAX)).map(Some)
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
        assert_eq!(error.to_string(), "5:3: x = \"zwei\": expected a number");
        assert_eq!(first.complain("x", "here").to_string(), "4:9: here");
        assert_eq!(table.complain_of_header("no").to_string(), "2:1: no");
    }

    #[test]
    fn what_is_no_table_is_refused() {
        let message = |text| read(text).map(|_| ()).unwrap_err().to_string();
        assert_eq!(
            message(""),
            "1:1: the file is empty: expected the header name"
        );
        assert_eq!(
            message("# only\n\n"),
            "3:1: the file is empty: expected the header name"
        );
        assert_eq!(
            message("x"),
            "1:1: there is no column \"name\": the header is to be name"
        );
        assert_eq!(
            message("name,z"),
            "1:6: column \"z\" is not known: expected name, x, y"
        );
        assert_eq!(
            message("name,x,x"),
            "1:8: column \"x\" is there twice: leave one"
        );
        assert_eq!(
            message("name,x\na,1,2\n"),
            "2:3: 3 fields, and the header has 2 columns: has a number a decimal comma? It is to be a point, 1.2"
        );
        assert_eq!(
            message("name,x\n3,1,2\n"),
            "2:1: 3 fields, and the header has 2 columns: has a number a decimal comma? It is to be a point, 12.5"
        );
        assert_eq!(
            message("name,x\na,b,2\n"),
            "2:1: 3 fields, and the header has 2 columns: a field with a comma in it is to stand in quotes"
        );
        assert_eq!(
            message("name,x\na\n"),
            "2:1: 1 field, and the header has 2 columns"
        );
        assert_eq!(
            message("name, nmae"),
            "1:7: column \"nmae\" is not known: expected name, x, y; did you mean name?"
        );
    }

    #[test]
    fn what_parts_the_fields_instead_of_commas_is_named() {
        for (delimiter, name) in [(";", "semicolons"), ("\t", "tabs"), ("|", "bars")] {
            let text = format!("# a;b\nname{delimiter}x\na{delimiter}1\n");
            let error = read(&text).unwrap_err().to_string();
            assert!(error.starts_with(&format!("2:5: {name} part")), "{error}");
            let row = format!("name,x\na{delimiter}1,5\nb{delimiter}2\n");
            let error = read(&row).unwrap_err().to_string();
            assert!(error.starts_with(&format!("3:2: {name} part")), "{error}");
        }
    }

    #[test]
    fn numbers_are_finite_and_have_a_point() {
        let said = |number: &str| {
            let text = format!("name,x\na,{number}\n");
            let table = read(&text).unwrap();
            let row = table.rows().next().unwrap();
            row.optional_number("x").unwrap_err().to_string()
        };
        assert_eq!(
            said("\"12,5\""),
            "2:3: x = \"12,5\": expected a number with a decimal point, 12.5"
        );
        for number in ["nan", "-inf", "1e999"] {
            let expected = format!("2:3: x = {number} is out of range: expected a finite number");
            assert_eq!(said(number), expected);
        }
    }
}
