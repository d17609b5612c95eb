//! Cells of the tables.

use crate::tracking::figures::Judged;

pub(super) const fn yes_or_no(reached: bool) -> &'static str {
    if reached { "ok" } else { "NO" }
}

/// A figure, with its limit where there is one.
pub(super) fn beside(value: f64, judged: Option<Judged>) -> String {
    judged.map_or_else(
        || digits(value),
        |judged| {
            format!(
                "{} {} {}",
                digits(value),
                yes_or_no(judged.reached),
                judged.limit
            )
        },
    )
}

/// Three significant digits, at most two decimals.
pub(super) fn digits(value: f64) -> String {
    let decimals = match value.abs() {
        size if size < 9.995 => 2,
        size if size < 99.95 => 1,
        _ => 0,
    };
    format!("{value:.decimals$}")
}

/// A table without blanks at the ends of its lines.
pub(super) fn lines(table: &comfy_table::Table) -> String {
    table
        .lines()
        .map(|line| format!("{}\n", line.trim_end()))
        .collect()
}
