//! Raw-data CSV of Saleae Logic 2: `Time [s]` and a column a channel, a row a change, first and
//! last row at the capture's ends.

use std::io::BufRead;

use super::Recording;
use super::channels::{ChannelSelection, Chosen, Offer, choose};
use super::decimal::Decimal;
use super::error::{Located, Problem};
use super::lines::Lines;
use super::timeline::Timeline;

/// Logic 2 writes nanoseconds. Older versions pad the fraction with zeros to 15 places, which make
/// the clock no finer.
const USUAL_DIGITS: u32 = 9;

/// Femtoseconds: finer than that is the noise of a floating-point number, not a time.
const FINEST_DIGITS: u32 = 15;

pub(super) fn read(
    input: impl BufRead,
    selection: &ChannelSelection,
) -> Result<Recording, Located> {
    let mut lines = Lines::new(input);
    if !lines.advance()? {
        return Err(Problem::Empty.into());
    }
    let columns = read_header(&lines)?;
    let offers: Vec<Offer<usize>> = columns.iter().enumerate().skip(1).map(offer).collect();
    let chosen = choose(selection, &offers)?;
    read_rows(&mut lines, columns.len(), &chosen)
}

fn offer((column, name): (usize, &String)) -> Offer<usize> {
    Offer {
        path: name.clone(),
        name: name.clone(),
        key: column,
        obstacle: None,
    }
}

/// The names of all columns, time included.
fn read_header<R: BufRead>(lines: &Lines<R>) -> Result<Vec<String>, Located> {
    let expected = "a header `Time [s],` and the names of the channels";
    let mut record = csv::StringRecord::new();
    let text = lines.text()?;
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    if !reader.read_record(&mut record).is_ok_and(|found| found) {
        return Err(lines.broken(expected, "export the capture again"));
    }
    let unit: String = record
        .get(0)
        .unwrap_or_default()
        .split_whitespace()
        .collect();
    if !unit.eq_ignore_ascii_case("time[s]") {
        return Err(lines.broken(
            expected,
            "times are read in seconds only; export raw data as CSV from Logic 2 without ISO 8601 \
             timestamps, or from sigrok with its comment lines",
        ));
    }
    Ok(record.iter().map(str::to_owned).collect())
}

fn read_rows<R: BufRead>(
    lines: &mut Lines<R>,
    columns: usize,
    chosen: &Chosen<usize>,
) -> Result<Recording, Located> {
    let mut timeline = Timeline::new();
    let mut clock: Option<Clock> = None;
    while lines.advance()? {
        let line = lines.number();
        let text = lines.text()?;
        let count = text.split(',').count();
        if count != columns {
            return Err(broken_row(
                lines,
                format!("{columns} columns as in the header"),
            ));
        }
        let mut cells = text.split(',').map(str::trim).enumerate();
        let (_, time_text) = cells.next().unwrap_or_default();
        let time = seconds(time_text, lines)?;
        let clock = clock.get_or_insert(Clock::starting_at(time));
        clock
            .advance(time, time_text, &mut timeline)
            .map_err(|problem| problem.at(line))?;
        for (column, cell) in cells {
            if let Some(role) = chosen.role_of(column) {
                let level = level(cell).ok_or_else(|| {
                    broken_row(
                        lines,
                        format!("0, 1 or X for {role} in column {}", column + 1),
                    )
                })?;
                timeline.set(role, level, line)?;
            }
        }
    }
    let clock = clock.ok_or(Problem::NoSamples)?;
    let duration = timeline.now();
    Ok(timeline.finish(10_u64.pow(clock.digits), duration, chosen.roles())?)
}

fn broken_row<R: BufRead>(lines: &Lines<R>, expected: String) -> Located {
    lines.broken(
        expected,
        "the file is damaged or cut short; export the capture again",
    )
}

/// A level, or None inside where the analyser says that it has none.
fn level(cell: &str) -> Option<Option<bool>> {
    match cell {
        "0" => Some(Some(false)),
        "1" => Some(Some(true)),
        "X" | "x" => Some(None),
        _ => None,
    }
}

fn seconds<R: BufRead>(text: &str, lines: &Lines<R>) -> Result<Decimal, Located> {
    let Some(time) = Decimal::parse(text) else {
        return Err(lines.broken(
            "a time in seconds such as 0.000125",
            "export raw data as CSV from Logic 2 without ISO 8601 timestamps",
        ));
    };
    let time = time.trim_zeros(USUAL_DIGITS);
    if time.digits > FINEST_DIGITS {
        return Err(lines.broken(
            format!("a time with at most {FINEST_DIGITS} decimal places"),
            "write the times with a fixed number of places, nine for nanoseconds",
        ));
    }
    Ok(time)
}

/// Times in units of 10^−`digits` s, the finest place met so far.
struct Clock {
    digits: u32,
    first: i128,
    /// As in the file, for the message.
    now_text: String,
}

impl Clock {
    fn starting_at(time: Decimal) -> Clock {
        Clock {
            digits: time.digits,
            first: time.mantissa,
            now_text: String::new(),
        }
    }

    fn advance(
        &mut self,
        time: Decimal,
        text: &str,
        timeline: &mut Timeline,
    ) -> Result<(), Problem> {
        if time.digits > self.digits {
            self.refine(time.digits, timeline)?;
        }
        let ticks = time
            .in_units(self.digits)
            .and_then(|ticks| ticks.checked_sub(self.first));
        let ticks = ticks.ok_or(Problem::TooLong)?;
        if ticks < i128::from(timeline.now()) {
            let previous = std::mem::take(&mut self.now_text);
            return Err(Problem::Backwards {
                previous,
                found: text.to_owned(),
            });
        }
        timeline.advance(u64::try_from(ticks).map_err(|_| Problem::TooLong)?);
        text.clone_into(&mut self.now_text);
        Ok(())
    }

    fn refine(&mut self, digits: u32, timeline: &mut Timeline) -> Result<(), Problem> {
        let factor = 10_u64.pow(digits - self.digits);
        let first = self.first.checked_mul(i128::from(factor));
        self.first = first.ok_or(Problem::TooLong)?;
        self.digits = digits;
        timeline.refine(factor)
    }
}
