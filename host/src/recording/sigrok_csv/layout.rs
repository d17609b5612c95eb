//! What the columns are, from the first row after the comments.

use std::io::BufRead;

use crate::recording::channels::Offer;
use crate::recording::detect::is_sample;
use crate::recording::error::Located;
use crate::recording::lines::Lines;

/// The columns of the file.
pub(super) struct Layout {
    /// How many there are.
    pub columns: usize,
    /// The first one is the time.
    pub time: bool,
    /// The first row is labels and not a sample.
    pub labelled: bool,
    /// The channels, by column.
    pub offers: Vec<Offer<usize>>,
}

/// What libsigrok labels the time column, by the unit or with `label=channel`.
const TIME_LABELS: [&str; 8] = [
    "Time",
    "samples",
    "milliseconds",
    "microseconds",
    "nanoseconds",
    "picoseconds",
    "femtoseconds",
    "attoseconds",
];

/// What it labels logic channels with `label=units`.
const LOGIC_LABEL: &str = "logic";

impl Layout {
    /// Reads the current line; `names` are those of the `Channels` comment.
    ///
    /// With channels called `0` and `1` a row `0,1` may be labels or a sample. Where it is the
    /// names to the letter it is taken for labels: at worst the first of many samples is dropped,
    /// while the other way round a level that never was would be recorded.
    pub(super) fn of_first_row<R: BufRead>(
        lines: &Lines<R>,
        names: Option<&[String]>,
    ) -> Result<Layout, Located> {
        let cells: Vec<&str> = lines.text()?.split(',').map(str::trim).collect();
        let spare = names.map_or(usize::MAX, |names| cells.len().saturating_sub(names.len()));
        let time = spare > 0 && TIME_LABELS.contains(&cells[0]);
        let trigger = spare > usize::from(time) && cells.last() == Some(&"Trigger");
        let body = &cells[usize::from(time)..cells.len() - usize::from(trigger)];
        if let Some(names) = names.filter(|names| names.len() != body.len()) {
            let expected = format!("{} columns, as the `Channels` comment says", names.len());
            return Err(lines.broken(expected, EXPORT_PLAIN));
        }
        let units = body.contains(&LOGIC_LABEL);
        let labelled = units || names.is_some_and(|names| names == body);
        if !labelled && !is_sample(&cells) {
            return Err(lines.broken("a sample, or labels such as `logic,logic`", EXPORT_PLAIN));
        }
        let name = |index: usize| match names {
            Some(names) => names[index].clone(),
            None => index.to_string(),
        };
        let offers = body.iter().enumerate().map(|(index, label)| Offer {
            path: name(index),
            name: name(index),
            key: index + usize::from(time),
            obstacle: (units && *label != LOGIC_LABEL).then(|| "is analog".to_owned()),
        });
        Ok(Layout {
            columns: cells.len(),
            time,
            labelled,
            offers: offers.collect(),
        })
    }
}

const EXPORT_PLAIN: &str = "export the capture with `sigrok-cli -i FILE -O csv`";
