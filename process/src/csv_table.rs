//! Tables as CSV, with the place of every cell for complaints.
//!
//! The first line names the columns; empty lines and lines that begin with `#` are passed over. A cell ends with its line.

use std::ops::Range;

use leadscrew_nc::source::Complaint;

/// A cell: its content and where it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Without blanks around it and quotes.
    pub content: String,
    span: Range<usize>,
}

/// A table, all as text.
#[derive(Clone, Debug)]
pub struct CsvTable<'a> {
    text: &'a str,
    columns: Vec<Cell>,
    rows: Vec<Vec<Cell>>,
}

impl<'a> CsvTable<'a> {
    /// Reads a table whose columns are all among `known`.
    ///
    /// # Errors
    /// No columns, one that is unknown or twice there, or a row with another number of cells.
    pub fn read(text: &'a str, known: &[&str]) -> Result<Self, Complaint> {
        let mut lines = lines(text);
        let (_, columns) = lines.next().ok_or_else(|| {
            Complaint::at(
                text,
                &(0..0),
                format!("empty: expected the columns {}", known.join(",")),
            )
        })?;
        for (index, column) in columns.iter().enumerate() {
            let name = column.content.as_str();
            let message = if !known.contains(&name) {
                format!("unknown column `{name}`: known are {}", known.join(", "))
            } else if columns[..index].iter().any(|other| other.content == name) {
                format!("column `{name}` is there twice")
            } else {
                continue;
            };
            return Err(Complaint::at(text, &column.span, message));
        }
        let mut rows = Vec::new();
        for (line, row) in lines {
            if row.len() != columns.len() {
                let (found, expected) = (row.len(), columns.len());
                let message = format!("{found} cells: expected {expected}, one for each column");
                return Err(Complaint::at(text, &line, message));
            }
            rows.push(row);
        }
        Ok(Self {
            text,
            columns,
            rows,
        })
    }

    /// The index of a column, if it is there.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns
            .iter()
            .position(|column| column.content == name)
    }

    /// The index of a column that must be there.
    ///
    /// # Errors
    /// It is not.
    pub fn needed(&self, name: &str) -> Result<usize, Complaint> {
        self.column(name).ok_or_else(|| {
            let at = self
                .columns
                .first()
                .map_or(0..0, |column| column.span.clone());
            Complaint::at(self.text, &at, format!("column `{name}` is missing"))
        })
    }

    /// The rows.
    #[must_use]
    pub fn rows(&self) -> &[Vec<Cell>] {
        &self.rows
    }

    /// A complaint about a cell.
    pub fn complain(&self, cell: &Cell, message: impl Into<String>) -> Complaint {
        Complaint::at(self.text, &cell.span, message)
    }

    /// A finite number, none for an empty cell.
    ///
    /// # Errors
    /// The cell holds something else.
    pub fn number(&self, cell: &Cell) -> Result<Option<f64>, Complaint> {
        if cell.content.is_empty() {
            return Ok(None);
        }
        let number: Option<f64> = cell.content.parse().ok();
        let finite = number.filter(|number| number.is_finite());
        finite
            .map(Some)
            .ok_or_else(|| self.complain(cell, format!("`{}`: expected a number", cell.content)))
    }
}

/// Lines with something in them: their span and their cells.
fn lines(text: &str) -> impl Iterator<Item = (Range<usize>, Vec<Cell>)> {
    let mut from = 0;
    text.split_inclusive('\n').filter_map(move |line| {
        let start = from;
        from += line.len();
        let content = line.trim_end_matches(['\n', '\r']);
        let content = content
            .strip_prefix('\u{feff}')
            .filter(|_| start == 0)
            .unwrap_or(content);
        let blank = content.trim().is_empty() || content.trim_start().starts_with('#');
        (!blank).then(|| {
            (
                start..start + content.len(),
                cells(line_offset(start, line, content), content),
            )
        })
    })
}

/// Where the content of a line begins in the text.
fn line_offset(start: usize, line: &str, content: &str) -> usize {
    start + line.find(content).unwrap_or(0)
}

fn cells(start: usize, line: &str) -> Vec<Cell> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .trim(csv::Trim::All)
        .from_reader(line.as_bytes());
    let record = reader
        .records()
        .next()
        .and_then(Result::ok)
        .unwrap_or_default();
    let spans = spans(line);
    let cell = |(content, span): (&str, Range<usize>)| Cell {
        content: content.to_owned(),
        span: start + span.start..start + span.end,
    };
    record.iter().zip(spans).map(cell).collect()
}

/// Where the cells of a line stand: commas between quotes part none.
fn spans(line: &str) -> Vec<Range<usize>> {
    let mut spans = Vec::new();
    let (mut from, mut quoted) = (0, false);
    for (at, byte) in line.bytes().enumerate() {
        match byte {
            b'"' => quoted = !quoted,
            b',' if !quoted => {
                spans.push(trimmed(line, from..at));
                from = at + 1;
            }
            _ => {}
        }
    }
    spans.push(trimmed(line, from..line.len()));
    spans
}

fn trimmed(line: &str, span: Range<usize>) -> Range<usize> {
    let cell = &line[span.clone()];
    let blanks = cell.len() - cell.trim_start().len();
    let start = (span.start + blanks).min(span.end);
    start..(start + cell.trim().len())
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: [&str; 3] = ["name", "x", "y"];

    #[test]
    fn cells_keep_their_places() {
        let text = "# a table\nname, x,y\n\n\"a, b\", 1.5 ,\nc,zwei,3\n";
        let table = CsvTable::read(text, &KNOWN).unwrap();
        assert_eq!(table.rows().len(), 2);
        assert_eq!(table.rows()[0][0].content, "a, b");
        assert_eq!(table.number(&table.rows()[0][1]).unwrap(), Some(1.5));
        assert_eq!(table.number(&table.rows()[0][2]).unwrap(), None);
        let error = table.number(&table.rows()[1][1]).unwrap_err();
        assert_eq!(error.to_string(), "5:3: `zwei`: expected a number");
        let error = table.complain(&table.rows()[0][1], "here").to_string();
        assert_eq!(error, "4:9: here");
    }

    #[test]
    fn what_is_no_table_is_refused() {
        let message = |text| CsvTable::read(text, &KNOWN).unwrap_err().to_string();
        assert_eq!(message(""), "1:1: empty: expected the columns name,x,y");
        assert_eq!(
            message("name,z"),
            "1:6: unknown column `z`: known are name, x, y"
        );
        assert_eq!(message("name,x,x"), "1:8: column `x` is there twice");
        assert_eq!(
            message("name,x\na,1,2\n"),
            "2:1: 3 cells: expected 2, one for each column"
        );
        let table = CsvTable::read("name\n", &KNOWN).unwrap();
        assert_eq!(
            table.needed("x").unwrap_err().to_string(),
            "1:1: column `x` is missing"
        );
    }
}
