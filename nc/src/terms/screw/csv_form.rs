//! The CSV of the on-board screw table.

use std::ops::Range;

use csv::{ByteRecord, ReaderBuilder, Trim};
use toml::Spanned;

use super::PointFile;
use crate::source::Complaint;

const COLUMNS: [&str; 3] = ["position_mm", "forward_um", "backward_um"];

/// The points of a text, with their places in it.
///
/// # Errors
/// Other columns, values that are no numbers.
pub(super) fn points(text: &str) -> Result<Vec<PointFile>, Complaint> {
    let mut rows = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(Trim::All)
        .from_reader(text.as_bytes());
    let mut points = Vec::new();
    let mut header = true;
    let mut row = ByteRecord::new();
    loop {
        let more = rows.read_byte_record(&mut row);
        if !more.map_err(|error| Complaint::at(text, &(0..0), error.to_string()))? {
            break;
        }
        let fields = fields(text, &row)?;
        if header {
            for ((field, span), column) in fields.iter().zip(COLUMNS) {
                if *field != column {
                    let message = format!("\"{field}\": expected is {column}");
                    return Err(Complaint::at(text, span, message));
                }
            }
            header = false;
            continue;
        }
        let number = |index: usize| {
            let (field, span) = &fields[index];
            match field.parse::<f64>() {
                Ok(number) => Ok(Spanned::new(span.clone(), number)),
                Err(_) => {
                    let message = format!("{} = \"{field}\": a number is expected", COLUMNS[index]);
                    Err(Complaint::at(text, span, message))
                }
            }
        };
        points.push(PointFile {
            position_mm: number(0)?,
            forward_um: number(1)?,
            backward_um: Some(number(2)?),
        });
    }
    Ok(points)
}

/// The three fields of a row with their places; numbers have no quotes, so commas tell.
fn fields<'t>(text: &'t str, row: &ByteRecord) -> Result<[(&'t str, Range<usize>); 3], Complaint> {
    let mut start = row
        .position()
        .and_then(|position| usize::try_from(position.byte()).ok())
        .unwrap_or(0);
    // Empty lines and comments before a row belong to its position.
    while let Some(rest) = text.get(start..) {
        let line = rest.lines().next().unwrap_or("");
        let is_row = !(line.trim().is_empty() || line.starts_with('#'));
        if is_row || rest.is_empty() {
            break;
        }
        start += rest.find('\n').map_or(rest.len(), |newline| newline + 1);
    }
    let line = text
        .get(start..)
        .and_then(|rest| rest.lines().next())
        .unwrap_or("");
    let mut at = start;
    let fields: Vec<_> = line
        .split(',')
        .map(|raw| {
            let before = raw.len() - raw.trim_start().len();
            let span = at + before..at + raw.trim_end().len().max(before);
            at += raw.len() + 1;
            (raw.trim(), span)
        })
        .collect();
    <[_; 3]>::try_from(fields).map_err(|fields| {
        let message = format!(
            "{} values, expected are {}",
            fields.len(),
            COLUMNS.join(", ")
        );
        Complaint::at(text, &(start..start), message)
    })
}
