//! `leadscrew counters`: what tick and link counted.

use leadscrew_client::{Axis, LastReset, Losses};
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
    resets: u32,
    last_reset: Option<String>,
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
    let reset = axis.last_reset()?;
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
        resets: reset.resets,
        last_reset: cause(&reset),
        dropped_by_axis: Side::of(link.axis),
        dropped_here: Side::of(link.here),
    };
    if args.json {
        print_json(&report)
    } else {
        print(&report.to_text())
    }
}

/// What made the firmware start anew; nothing if it was not made to.
fn cause(reset: &LastReset) -> Option<String> {
    let LastReset {
        reason,
        place,
        origin,
        status: [cfsr, hfsr, address],
        file,
        ..
    } = reset;
    Some(match reason {
        0 => return None,
        1 => format!("panic in …{file} line {place}"),
        2 => format!(
            "hard fault at {place:#010x}, called from {origin:#010x} (CFSR {cfsr:#010x}, HFSR {hfsr:#010x}, address \
             {address:#010x})"
        ),
        3 => "watchdog: a tick hung, or none came".into(),
        4 => format!("watchdog: ticks ended too late from tick {place} on"),
        5 => "the stack reached its end: tell its maker what was done".into(),
        other => format!("reason {other}, of a later version"),
    })
}

impl Report {
    fn to_text(&self) -> String {
        format!(
            "ticks            {} since it was switched on\n\
             late             {} that did not run or whose inputs came late, {} that took too long\n\
             worst tick       start {}, end {} clocks of its timer after it was due\n\
             lost records     {}\n\
             indexes          {}, the last at count {}, {} d from the one before it\n\
             started anew     {} times since the power came{}\n\
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
            self.resets,
            (self.last_reset.as_ref()).map_or(String::new(), |cause| format!(", last: {cause}")),
            self.dropped_by_axis.to_text(),
            self.dropped_here.to_text(),
        )
    }
}
