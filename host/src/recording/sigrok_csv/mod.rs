//! CSV of libsigrok's `csv` output module: comments, perhaps a row of labels, then a row a sample.
//!
//! Its options change what is there. Read: any `label`, `header=false` (then the rate comes from the
//! caller), `time=true`, `dedup=true`, `trigger=true`. Its time column is not a time: it is the
//! sample's number times a period that was cut to whole units (41 ns at 24 MHz), so it is turned
//! back into the number.

use std::io::BufRead;

use super::Recording;
use super::channels::{ChannelSelection, Chosen, choose};
use super::error::{Located, Problem};
use super::lines::Lines;
use super::timeline::Timeline;

mod layout;
mod preamble;

use layout::Layout;
use preamble::Preamble;

pub(super) fn read(
    input: impl BufRead,
    selection: &ChannelSelection,
    samplerate_hz: Option<u64>,
) -> Result<Recording, Located> {
    let mut lines = Lines::new(input);
    let preamble = Preamble::read(&mut lines)?;
    let layout = Layout::of_first_row(&lines, preamble.channels.as_deref())?;
    let chosen = choose(selection, &layout.offers)?;
    let rate_hz = preamble.rate(samplerate_hz)?;
    let mut samples = Samples {
        chosen: &chosen,
        columns: layout.columns,
        numbering: match layout.time {
            true => Numbering::ByTime {
                period: time_period(rate_hz),
                first: None,
            },
            false => Numbering::ByRow,
        },
        count: 0,
        timeline: Timeline::new(),
    };
    if layout.labelled && !lines.advance()? {
        return Err(Problem::NoSamples.into());
    }
    samples.read_all(&mut lines)?;
    // The last sample stands for a whole period, as in libsigrok's VCD of the same capture.
    Ok(samples
        .timeline
        .finish(rate_hz, samples.count, chosen.roles())?)
}

/// The period as libsigrok computes it: in the unit, out of 1 s, 1 ms, 1 us…, that first reaches
/// the rate, and cut to a whole number of units.
fn time_period(rate_hz: u64) -> u64 {
    let mut units_per_second = 1_u64;
    while units_per_second < rate_hz {
        units_per_second = units_per_second.saturating_mul(1_000);
    }
    units_per_second / rate_hz
}

/// Where a row's sample number comes from.
enum Numbering {
    ByRow,
    ByTime { period: u64, first: Option<u64> },
}

struct Samples<'a> {
    chosen: &'a Chosen<usize>,
    columns: usize,
    numbering: Numbering,
    /// Samples so far: one more than the number of the last.
    count: u64,
    timeline: Timeline,
}

const DAMAGED: &str = "the file is damaged or cut short; export the capture again";

impl Samples<'_> {
    /// Reads from the current line to the end.
    fn read_all<R: BufRead>(&mut self, lines: &mut Lines<R>) -> Result<(), Located> {
        let mut previous: Vec<u8> = Vec::new();
        loop {
            let row = lines.bytes();
            // At rest thousands of rows are alike, and there may be a hundred million.
            let alike = matches!(self.numbering, Numbering::ByRow) && row == previous;
            if alike {
                self.count += 1;
            } else {
                self.read_row(lines)?;
                previous.clear();
                previous.extend_from_slice(row);
            }
            if !lines.advance()? {
                return Ok(());
            }
        }
    }

    fn read_row<R: BufRead>(&mut self, lines: &Lines<R>) -> Result<(), Located> {
        let row = lines.bytes();
        if row.split(|byte| *byte == b',').count() != self.columns {
            return Err(lines.broken(format!("{} columns", self.columns), DAMAGED));
        }
        let mut cells = row
            .split(|byte| *byte == b',')
            .map(<[u8]>::trim_ascii)
            .enumerate();
        let number = match self.numbering {
            Numbering::ByRow => self.count,
            Numbering::ByTime { period, first } => {
                let (_, time) = cells.next().unwrap_or_default();
                let time = whole_number(time)
                    .ok_or_else(|| lines.broken("a time as a whole number", DAMAGED))?;
                let first = first.unwrap_or(time);
                self.numbering = Numbering::ByTime {
                    period,
                    first: Some(first),
                };
                self.number_at(time, first, period, lines)?
            }
        };
        self.timeline.advance(number);
        self.count = number.checked_add(1).ok_or(Problem::TooLong)?;
        for (column, cell) in cells {
            let Some(role) = self.chosen.role_of(column) else {
                continue;
            };
            let level = match cell {
                b"0" => false,
                b"1" => true,
                _ => {
                    let expected = format!("0 or 1 for {role} in column {}", column + 1);
                    return Err(lines.broken(expected, DAMAGED));
                }
            };
            self.timeline.set(role, Some(level), lines.number())?;
        }
        Ok(())
    }

    /// The sample's number from its time.
    fn number_at<R: BufRead>(
        &self,
        time: u64,
        first: u64,
        period: u64,
        lines: &Lines<R>,
    ) -> Result<u64, Located> {
        let since = time.checked_sub(first).filter(|since| since % period == 0);
        let number = since
            .map(|since| since / period)
            .filter(|number| *number >= self.count);
        number.ok_or_else(|| {
            lines.broken(
                format!("a time that increases by multiples of {period}, the sample period"),
                "check the sample rate; sigrok that does not know it writes no usable times, \
                 export without time=true",
            )
        })
    }
}

fn whole_number(cell: &[u8]) -> Option<u64> {
    str::from_utf8(cell).ok()?.parse().ok()
}
