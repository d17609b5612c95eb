//! The CSV of the on-board screw table.

use toml::Spanned;

use super::PointFile;
use crate::csv_text::CsvText;
use crate::source::Complaint;

const COLUMNS: [&str; 3] = ["position_mm", "forward_um", "backward_um"];

/// The points of a text, with their places in it.
///
/// # Errors
/// Other columns, values that are no numbers.
pub(super) fn points(text: &str) -> Result<Vec<PointFile>, Complaint> {
    let table = CsvText::read(text, &COLUMNS, &[])?;
    let points = table.rows().map(|row| {
        let number = |column| {
            let number = row.number(column, (f64::MIN, f64::MAX))?;
            Ok(Spanned::new(row.span(column), number))
        };
        Ok(PointFile {
            position_mm: number(COLUMNS[0])?,
            forward_um: number(COLUMNS[1])?,
            backward_um: Some(number(COLUMNS[2])?),
        })
    });
    points.collect()
}
