//! What was identified, creep, carriage and threads.

use super::cells::{beside, digits, lines, yes_or_no};
use crate::report::text_table;
use crate::tracking::figures::{CarriageRow, CreepRow, IdentifiedFigure, IdentifiedRow, Threads};

/// Largest differences of what was identified from what the machines have.
pub(super) fn identified(rows: &[IdentifiedRow]) -> String {
    let Some(first) = rows.first() else {
        return String::new();
    };
    let name = |figure: &IdentifiedFigure| format!("{} {}", figure.figure, figure.unit);
    let names = first.figures.iter().map(name);
    let header: Vec<String> = std::iter::once("machine".to_owned()).chain(names).collect();
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    let mut table = text_table(&header);
    for row in rows {
        let cell = |figure: &IdentifiedFigure| figure.worst.map_or("-".to_owned(), small);
        let cells = row.figures.iter().map(cell);
        table.add_row(std::iter::once(row.machine.to_owned()).chain(cells));
    }
    lines(&table)
}

/// Two significant digits of what is below 10, at most four decimals.
fn small(value: f64) -> String {
    let decimals = match value {
        size if size < 0.00995 => 4,
        size if size < 0.0995 => 3,
        size if size < 0.995 => 2,
        _ => 1,
    };
    format!("{value:.decimals$}")
}

pub(super) fn creep(rows: &[CreepRow]) -> String {
    let header = ["machine", "mm/min", "peak", "rms", "first second"];
    let mut table = text_table(&header);
    for row in rows {
        table.add_row([
            row.machine.to_owned(),
            format!("{:.0}", row.feed_mm_per_min),
            beside(row.peak.value, Some(row.peak)),
            digits(row.rms),
            digits(row.start_peak),
        ]);
    }
    lines(&table)
}

pub(super) fn carriage(rows: &[CarriageRow]) -> String {
    let header = [
        "drive",
        "position before",
        "after",
        "reversal before",
        "after",
        "backlash",
        "standing",
    ];
    let mut table = text_table(&header);
    for row in rows {
        table.add_row([
            row.machine.to_owned(),
            digits(row.positioning_before),
            beside(row.positioning.value, Some(row.positioning)),
            digits(row.reversal_before),
            beside(row.reversal.value, Some(row.reversal)),
            digits(row.mean_reversal_of_backlash),
            digits(row.standing),
        ]);
    }
    let refusals = rows.iter().filter_map(|row| {
        let why = row.refused.as_ref()?;
        Some(format!("{}: no table: {why}\n", row.machine))
    });
    lines(&table) + &refusals.collect::<String>()
}

pub(super) fn threads(all: &[Threads]) -> String {
    let header = [
        "machine",
        "rpm",
        "pass",
        "phase deg",
        "pitch error d",
        "error d",
        "following d",
        "spread deg",
    ];
    let mut table = text_table(&header);
    for threads in all {
        for (index, pass) in threads.passes.iter().enumerate() {
            let spread = threads.phase_spread_deg;
            table.add_row([
                threads.machine.to_owned(),
                format!("{:.0}", pass.rpm),
                pass.pass.to_string(),
                format!("{:.3}", pass.phase_deg),
                beside(pass.pitch_error.value, Some(pass.pitch_error)),
                digits(pass.instantaneous_d),
                digits(pass.following_d),
                if index == 0 {
                    format!(
                        "{:.3} {} {}",
                        spread.value,
                        yes_or_no(spread.reached),
                        spread.limit
                    )
                } else {
                    String::new()
                },
            ]);
        }
    }
    lines(&table)
}
