//! Which format a file is in, by its first line with anything on it.

use std::io::{BufRead, Chain, Cursor, Read};

use super::error::{Located, Problem, excerpt};
use super::lines::LONGEST_LINE_BYTES;

/// The formats that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Vcd,
    SigrokCsv,
    SaleaeCsv,
}

/// The whole file again, without a byte-order mark: what was looked at, then the rest. Nothing is
/// sought, so that a pipe does as well as a file.
pub(super) type Whole<R> = Chain<Cursor<Vec<u8>>, R>;

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Tells the format and gives the input back from its start.
pub(super) fn detect<R: BufRead>(mut reader: R) -> Result<(Format, Whole<R>), Located> {
    let mut head = Vec::new();
    let mut line = 0;
    let first = loop {
        let start = head.len();
        let mut limited = (&mut reader).take(LONGEST_LINE_BYTES as u64);
        if limited
            .read_until(b'\n', &mut head)
            .map_err(Problem::Unreadable)?
            == 0
        {
            return Err(Problem::Empty.into());
        }
        if start == 0 && head.starts_with(BYTE_ORDER_MARK) {
            head.drain(..BYTE_ORDER_MARK.len());
        }
        line += 1;
        let text = head[start..].trim_ascii();
        if !text.is_empty() {
            break text;
        }
    };
    let format = format_of(first).map_err(|problem| problem.at(line))?;
    Ok((format, Cursor::new(head).chain(reader)))
}

fn format_of(first: &[u8]) -> Result<Format, Problem> {
    refuse_containers(first)?;
    let text = str::from_utf8(first).map_err(|_| Problem::NotUtf8)?;
    if text.starts_with('$') {
        return Ok(Format::Vcd);
    }
    let cells: Vec<&str> = text.split(',').map(str::trim).collect();
    if is_time_label(cells[0]) {
        return Ok(Format::SaleaeCsv);
    }
    if text.starts_with(';') || cells.contains(&"logic") || is_sample(&cells) {
        return Ok(Format::SigrokCsv);
    }
    Err(Problem::UnknownFormat {
        found: excerpt(first),
    })
}

/// A row of one sample: nothing but levels.
pub(super) fn is_sample(cells: &[&str]) -> bool {
    cells.iter().all(|cell| matches!(*cell, "0" | "1"))
}

/// `Time`, `Time [s]`, `Time[s]`, `"Time [s]"`; the unit is the reader's to judge.
fn is_time_label(cell: &str) -> bool {
    let cell = cell.trim_matches('"').to_ascii_lowercase();
    let unit = cell.strip_prefix("time").map(str::trim_start);
    unit.is_some_and(|unit| unit.is_empty() || unit.starts_with(['[', '(']))
}

fn refuse_containers(first: &[u8]) -> Result<(), Problem> {
    if first.starts_with(b"PK\x03\x04") {
        return Err(Problem::NotExported {
            container: "a compressed session (sigrok .sr or Saleae .sal)",
            advice: "convert it with `sigrok-cli -i FILE -O vcd -o FILE.vcd`, or export it as CSV \
                     in Logic 2",
        });
    }
    if first.starts_with(b"<SALEAE>") {
        return Err(Problem::NotExported {
            container: "Saleae's binary export",
            advice: "choose CSV, not binary, when exporting raw data in Logic 2",
        });
    }
    Ok(())
}
