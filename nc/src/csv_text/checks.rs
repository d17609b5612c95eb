//! What is no table: another header, other delimiters, rows of another length.

use csv::StringRecord;

use super::field;
use crate::source::{Complaint, decimal_comma, nearest};

/// Refuses a header whose columns are not the expected ones.
pub(super) fn check_header(
    text: &str,
    header: &StringRecord,
    columns: &[String],
    needed: &[&str],
    optional: &[&str],
) -> Result<(), Complaint> {
    let complain =
        |at, message: String| Err(Complaint::at(text, &field(text, header, at), message));
    if columns.is_empty() {
        let message = format!(
            "the file is empty: expected the header {}",
            needed.join(",")
        );
        return complain(0, message);
    }
    check_delimiter(text, header)?;
    let known = || needed.iter().chain(optional).copied();
    for (at, column) in columns.iter().enumerate() {
        if !known().any(|known| known == column) {
            let expected = known().collect::<Vec<_>>().join(", ");
            let meant = nearest(column, known())
                .map_or_else(String::new, |near| format!("; did you mean {near}?"));
            let message = format!("column \"{column}\" is not known: expected {expected}{meant}");
            return complain(at, message);
        }
        if columns[..at].contains(column) {
            return complain(at, format!("column \"{column}\" is there twice: leave one"));
        }
    }
    let is_missing = |needed: &&&str| !columns.iter().any(|column| column == *needed);
    match needed.iter().find(is_missing) {
        None => Ok(()),
        Some(missing) => {
            let header = needed.join(",");
            complain(
                0,
                format!("there is no column \"{missing}\": the header is to be {header}"),
            )
        }
    }
}

/// Refuses a record that is one field because something else than commas parts what is in it.
fn check_delimiter(text: &str, record: &StringRecord) -> Result<(), Complaint> {
    let [only] = record.iter().collect::<Vec<_>>()[..] else {
        return Ok(());
    };
    let others = [(';', "semicolons"), ('\t', "tabs"), ('|', "bars")];
    let Some((delimiter, name)) = others.into_iter().find(|(other, _)| only.contains(*other))
    else {
        return Ok(());
    };
    let start = field(text, record, 0).start;
    let at = start + text[start..].find(delimiter).unwrap_or(0);
    let message = format!(
        "{name} part the fields: expected commas, and decimal points (12.5): save the table so"
    );
    Err(Complaint::at(text, &(at..at), message))
}

/// Refuses a record with more or fewer fields than there are columns.
pub(super) fn check_length(
    text: &str,
    record: &StringRecord,
    columns: usize,
) -> Result<(), Complaint> {
    if record.len() == columns {
        return Ok(());
    }
    check_delimiter(text, record)?;
    let fields = match record.len() {
        1 => "1 field".to_owned(),
        count => format!("{count} fields"),
    };
    let mut at = 0;
    let mut message = format!("{fields}, and the header has {columns} columns");
    if record.len() > columns {
        match &split_numbers(record)[..] {
            [] => message += ": a field with a comma in it is to stand in quotes",
            [(index, number)] => {
                at = *index;
                message +=
                    &format!(": has a number a decimal comma? It is to be a point, {number}");
            }
            _ => message += ": has a number a decimal comma? It is to be a point, 12.5",
        }
    }
    Err(Complaint::at(text, &field(text, record, at), message))
}

/// Where two fields may be one number with a decimal comma between them, and that number as it should be.
fn split_numbers(record: &StringRecord) -> Vec<(usize, String)> {
    let fields: Vec<&str> = record.iter().collect();
    let pairs = fields.windows(2).enumerate();
    pairs
        .filter(|(_, pair)| pair[1].starts_with(|c: char| c.is_ascii_digit()))
        .filter(|(_, pair)| pair[0].parse::<i64>().is_ok())
        .filter_map(|(at, pair)| Some((at, decimal_comma(&pair.join(","))?)))
        .collect()
}
