//! `leadscrew replay` of a recording of an axis.

use std::fmt::Write as _;
use std::path::Path;

use leadscrew::scope::Signal;
use serde::Serialize;

use crate::cli::ReplayArgs;
use crate::command::axis::recording::{Summary, figure};
use crate::command::{check_outputs, file_name, print, print_json};
use crate::desk::{Compared, Derived, Desk, Faults, Law, estimators, faults, law};
use crate::error::CommandError;
use crate::fault_names::fault_name;
use crate::plot::{Colour, Series};
use crate::recorded::{self, Recorded};
use crate::report::text_table;

/// What a replay shows.
#[derive(Serialize)]
struct Report {
    schema: &'static str,
    firmware: String,
    board: String,
    recording: Summary,
    estimators: Part<Vec<EstimatorRow>>,
    law: Part<LawReport>,
    faults: Part<FaultsReport>,
}

/// A part of a replay, or why there is none.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Part<T> {
    Done(T),
    Lacking(String),
}

impl<T> Part<T> {
    fn of<F>(found: &Result<F, String>, report: impl FnOnce(&F) -> T) -> Self {
        match found {
            Ok(found) => Self::Done(report(found)),
            Err(lacking) => Self::Lacking(lacking.clone()),
        }
    }
}

#[derive(Serialize)]
struct EstimatorRow {
    estimator: &'static str,
    of_the_axis: bool,
    lacks_edge_times: bool,
    /// Velocity less that of the axis, mm/min; null where that was not recorded.
    rms_mm_per_min: Option<f64>,
    peak_mm_per_min: Option<f64>,
}

#[derive(Serialize)]
struct LawReport {
    ticks_in_loop: u64,
    begins_in_loop: bool,
    rms_percent: f64,
    peak_percent: f64,
}

#[derive(Serialize)]
struct FaultsReport {
    recorded: Option<FaultRow>,
    derived: Option<FaultRow>,
    agree: bool,
    can_be_derived: bool,
}

#[derive(Serialize)]
struct FaultRow {
    fault: &'static str,
    tick: u32,
    value: Option<f64>,
    limit: Option<f64>,
}

/// Runs the command on a recording of an axis.
///
/// # Errors
/// A file that cannot be read or written, parameters that make no axis, options of captures.
pub fn run(args: &ReplayArgs) -> Result<(), CommandError> {
    check_outputs(&args.output, Some(&args.file))?;
    if args.output.csv.is_some() || args.map.is_some() || args.estimator.is_some() {
        return Err(CommandError::Usage(
            "--csv, --map and --estimator are for captures of an encoder: a recording of an axis is CSV itself, and its \
             parameters say the estimator"
                .to_owned(),
        ));
    }
    let recorded = recorded::read(&args.file)?;
    let desk = Desk::new(&recorded).map_err(CommandError::Data)?;
    let (estimators, law, faults) = (estimators(&desk), law(&desk), faults(&desk));
    if let Some(path) = &args.output.plot {
        let title = file_name(&args.file);
        drawn(
            &title,
            &recorded,
            estimators.as_ref().ok(),
            law.as_ref().ok(),
        )
        .save(path)?;
    }
    let report = Report {
        schema: "leadscrew/replay-axis/1",
        firmware: recorded.header.firmware.clone(),
        board: recorded.header.board.clone(),
        recording: Summary::of(&recorded.recording),
        estimators: Part::of(&estimators, |found| rows(&recorded, found)),
        law: Part::of(&law, law_report),
        faults: Part::of(&faults, faults_report),
    };
    if args.output.json {
        print_json(&report)
    } else {
        print(&report.to_text(&args.file))
    }
}

/// The recorded signals, with what the core says again behind them.
fn drawn(
    title: &str,
    recorded: &Recorded,
    estimators: Option<&Vec<Compared>>,
    law: Option<&Law>,
) -> crate::plot::Figure {
    let recording = &recorded.recording;
    let mut figure = figure(title, recording);
    let mut behind = |signal: Signal, name: &str, bits: Vec<i64>| {
        let physical = recording.physical(signal);
        let values = bits.into_iter().map(|bits| physical.value(bits));
        let points = recording.times().into_iter().zip(values).collect();
        let recorded = signal.name().replace('_', " ");
        let mut panels = figure.panels.iter_mut();
        let panel = panels.find(|panel| panel.series.iter().any(|one| one.name == recorded));
        if let Some(panel) = panel {
            let again = Series::dashed(name, points, Colour::Black).with_width(1.0);
            panel.series.push(again);
        }
    };
    if let Some(own) = estimators.and_then(|all| all.first()) {
        let bits = own.estimates.iter();
        let bits = bits.map(|one| i64::from(one.velocity.to_bits())).collect();
        behind(Signal::Velocity, "velocity, replayed", bits);
    }
    if let Some(law) = law {
        behind(Signal::Command, "command, replayed", law.commands.clone());
    }
    figure
}

fn rows(recorded: &Recorded, found: &[Compared]) -> Vec<EstimatorRow> {
    let bit = recorded.recording.physical(Signal::Velocity).bit;
    let row = |compared: &Compared| EstimatorRow {
        estimator: compared.config.name(),
        of_the_axis: compared.is_the_axis_s,
        lacks_edge_times: compared.lacks_edges,
        rms_mm_per_min: compared.difference.map(|spread| spread.rms() * bit),
        peak_mm_per_min: compared.difference.map(|spread| spread.peak() * bit),
    };
    found.iter().map(row).collect()
}

fn law_report(law: &Law) -> LawReport {
    let percent = 100.0 / f64::from(1 << 30);
    LawReport {
        ticks_in_loop: law.difference.count(),
        begins_in_loop: law.begins_in_loop,
        rms_percent: law.difference.rms() * percent,
        peak_percent: law.difference.peak() * percent,
    }
}

fn faults_report(faults: &Faults) -> FaultsReport {
    let row = |found: Derived| FaultRow {
        fault: fault_name(found.fault),
        tick: found.tick,
        value: found.figures.map(|(value, _)| value),
        limit: found.figures.map(|(_, limit)| limit),
    };
    FaultsReport {
        recorded: faults.recorded.map(row),
        derived: faults.derived.map(row),
        agree: faults.agree(),
        can_be_derived: faults
            .recorded
            .is_none_or(|found| Faults::can_be_derived(found.fault)),
    }
}

impl FaultRow {
    fn text(&self) -> String {
        let figures = self.value.zip(self.limit);
        let figures = figures.map_or_else(String::new, |(value, limit)| {
            format!(", {value:.3} where {limit:.3} is allowed")
        });
        format!("{} in tick {}{figures}", self.fault, self.tick)
    }
}

impl Report {
    fn to_text(&self, file: &Path) -> String {
        let mut text = format!(
            "{}: firmware {} on {}\n",
            file.display(),
            self.firmware,
            self.board
        );
        text.push_str(&self.recording.to_text());
        match &self.estimators {
            Part::Lacking(why) => {
                let _ = writeln!(text, "estimators: {why}");
            }
            Part::Done(rows) => text.push_str(&table(rows)),
        }
        let _ = match &self.law {
            Part::Lacking(why) => writeln!(text, "control law: {why}"),
            Part::Done(law) => writeln!(
                text,
                "control law: {} ticks again, command {:.6} % of full off rms, {:.6} % at most{}",
                law.ticks_in_loop,
                law.rms_percent,
                law.peak_percent,
                if law.begins_in_loop {
                    " (the recording begins in the loop: what its integral had by then is not in it)"
                } else {
                    ""
                }
            ),
        };
        let _ = match &self.faults {
            Part::Lacking(why) => writeln!(text, "faults: {why}"),
            Part::Done(faults) => writeln!(text, "{}", faults.text()),
        };
        text
    }
}

impl FaultsReport {
    fn text(&self) -> String {
        let told = |row: &Option<FaultRow>| {
            row.as_ref()
                .map_or_else(|| "none".to_owned(), FaultRow::text)
        };
        let verdict = match (self.agree, self.can_be_derived) {
            (true, _) => "the same",
            (false, true) => "NOT the same",
            (false, false) => "it comes from lines, edges or a source that are not recorded",
        };
        format!(
            "fault recorded: {}\nfault replayed: {} ({verdict})",
            told(&self.recorded),
            told(&self.derived)
        )
    }
}

fn table(rows: &[EstimatorRow]) -> String {
    let mut table = text_table(&["estimator on the counts", "rms", "peak", "unit", ""]);
    for row in rows {
        let figure =
            |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.3}"));
        let note = match (row.of_the_axis, row.lacks_edge_times) {
            (true, false) => "the axis's",
            (true, true) => "the axis's, without its edge times",
            (false, _) => "",
        };
        table.add_row([
            row.estimator.to_owned(),
            figure(row.rms_mm_per_min),
            figure(row.peak_mm_per_min),
            "mm/min".to_owned(),
            note.to_owned(),
        ]);
    }
    format!("velocity less the axis's own:\n{}\n", table.trim_fmt())
}
