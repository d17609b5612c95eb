//! `leadscrew counters`: what tick and link counted.

use leadscrew_client::{Axis, Losses};
use serde::Serialize;

use crate::cli::JsonArgs;
use crate::command::{print, print_json};
use crate::error::CommandError;

/// What was counted.
#[derive(Debug, Serialize)]
struct Report {
    ticks: u32,
    late_ticks: u32,
    overlong_ticks: u32,
    lost_records: u32,
    worst_start_clocks: u32,
    worst_end_clocks: u32,
    indexes: u32,
    index_count: i64,
    index_distance: i64,
    dropped_by_axis: Side,
    dropped_here: Side,
}

/// What a side of the link dropped.
#[derive(Debug, Serialize)]
struct Side {
    torn: u32,
    too_long: u32,
    too_short: u32,
    checksum: u32,
    unknown: u32,
    late: u32,
    records_lost: u32,
}

impl Side {
    const fn of(losses: Losses) -> Self {
        let Losses {
            torn,
            too_long,
            too_short,
            checksum,
            unknown,
            late,
            records_lost,
        } = losses;
        Self {
            torn,
            too_long,
            too_short,
            checksum,
            unknown,
            late,
            records_lost,
        }
    }

    fn to_text(&self) -> String {
        let Self {
            torn,
            too_long,
            too_short,
            checksum,
            unknown,
            late,
            records_lost,
        } = self;
        format!(
            "{torn} torn, {too_long} too long, {too_short} too short, {checksum} of a wrong checksum, {unknown} unknown, \
             {late} late, {records_lost} records lost"
        )
    }
}

/// Runs the command.
///
/// # Errors
/// The axis is lost.
pub fn run(axis: &mut Axis, args: &JsonArgs) -> Result<(), CommandError> {
    let counted = axis.tick_counters()?;
    let link = axis.link_statistics()?;
    let report = Report {
        ticks: counted.ticks,
        late_ticks: counted.late,
        overlong_ticks: counted.overlong,
        lost_records: counted.lost_records,
        worst_start_clocks: counted.worst_start,
        worst_end_clocks: counted.worst_end,
        indexes: counted.indexes,
        index_count: counted.index_count,
        index_distance: counted.index_distance,
        dropped_by_axis: Side::of(link.axis),
        dropped_here: Side::of(link.here),
    };
    if args.json {
        print_json(&report)
    } else {
        print(&report.to_text())
    }
}

impl Report {
    fn to_text(&self) -> String {
        format!(
            "ticks            {} since it was switched on\n\
             late             {} whose inputs came late, {} that took too long\n\
             worst tick       start {}, end {} clocks of its timer after it was due\n\
             lost records     {}\n\
             indexes          {}, the last at count {}, {} d from the one before it\n\
             link, the axis   dropped {}\n\
             link, this tool  dropped {}\n",
            self.ticks,
            self.late_ticks,
            self.overlong_ticks,
            self.worst_start_clocks,
            self.worst_end_clocks,
            self.lost_records,
            self.indexes,
            self.index_count,
            self.index_distance,
            self.dropped_by_axis.to_text(),
            self.dropped_here.to_text(),
        )
    }
}
