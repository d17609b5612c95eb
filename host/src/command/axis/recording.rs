//! What the commands have in common that record: summary, plot, file.

use std::fmt::Write as _;

use leadscrew::scope::Signal;
use leadscrew_client::Recording;
use serde::Serialize;

use crate::cli::RecordingArgs;
use crate::command::{check_outputs_of, print, print_json, write_file};
use crate::error::CommandError;
use crate::figures;
use crate::plot::{Colour, Figure, Panel, Series};
use crate::recorded::{self, Recorded};
use crate::report::text_table;
use crate::statistics::{Spread, mean};

/// A recording in figures.
#[derive(Debug, Serialize)]
pub struct Summary {
    schema: &'static str,
    samples: usize,
    missing: u64,
    every: u16,
    tick_hz: f64,
    seconds: f64,
    first_tick: i64,
    trigger_sample: Option<usize>,
    torn: bool,
    signals: Vec<Row>,
}

/// A signal in figures.
#[derive(Debug, Serialize)]
pub struct Row {
    signal: &'static str,
    unit: &'static str,
    min: f64,
    max: f64,
    mean: f64,
    rms: f64,
    /// Largest distance from zero.
    peak: f64,
}

impl Summary {
    /// The figures of a recording.
    #[must_use]
    pub fn of(recording: &Recording) -> Self {
        let first = recording.ticks.first().copied().unwrap_or(0);
        let last = recording.ticks.last().copied().unwrap_or(0);
        Self {
            schema: "leadscrew/recording/1",
            samples: recording.len(),
            missing: recording.missing(),
            every: recording.every,
            tick_hz: recording.scale.tick_hz,
            seconds: (last - first + i64::from(recording.every)) as f64 / recording.scale.tick_hz,
            first_tick: first,
            trigger_sample: recording.trigger,
            torn: recording.is_torn,
            signals: recording
                .signals
                .iter()
                .map(|&signal| Row::of(recording, signal))
                .collect(),
        }
    }

    /// The same for people.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = format!(
            "{} samples in every {}. tick at {} Hz: {:.3} s from tick {}\n",
            self.samples, self.every, self.tick_hz, self.seconds, self.first_tick
        );
        match self.trigger_sample {
            Some(sample) => {
                let _ = writeln!(text, "trigger at sample {sample}");
            }
            None => text.push_str("no trigger\n"),
        }
        if self.missing > 0 {
            let _ = writeln!(text, "{} samples are MISSING", self.missing);
        }
        if self.torn {
            text.push_str("torn: more interruptions than are kept, times are not to be trusted\n");
        }
        let mut table = text_table(&["signal", "min", "max", "mean", "rms", "peak", "unit"]);
        for row in &self.signals {
            let figures = [row.min, row.max, row.mean, row.rms, row.peak];
            let mut cells = vec![row.signal.to_owned()];
            cells.extend(figures.map(|figure| format!("{figure:.4}")));
            cells.push(row.unit.to_owned());
            table.add_row(cells);
        }
        let _ = writeln!(text, "{}", table.trim_fmt());
        text
    }
}

impl Row {
    fn of(recording: &Recording, signal: Signal) -> Self {
        let values = recording.values(signal).unwrap_or_default();
        let spread: Spread = values.iter().copied().collect();
        Self {
            signal: signal.name(),
            unit: recording.physical(signal).unit,
            min: values.iter().copied().fold(f64::INFINITY, f64::min),
            max: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            mean: mean(values.iter().copied()).unwrap_or_default(),
            rms: spread.rms(),
            peak: spread.peak(),
        }
    }
}

/// Signals over time: those of one unit in a panel, errors and bits apart.
#[must_use]
pub fn figure(title: &str, recording: &Recording) -> Figure {
    let times = recording.times();
    let mut panels: Vec<(String, Panel)> = Vec::new();
    let is_bits = |signal: Signal| matches!(signal, Signal::Tick | Signal::Flags);
    let are_all_bits = recording.signals.iter().all(|signal| is_bits(*signal));
    for &signal in &recording.signals {
        // Nobody reads bits from a curve.
        if is_bits(signal) && !are_all_bits {
            continue;
        }
        let unit = recording.physical(signal).unit;
        let key = match (signal, unit) {
            (Signal::FollowingError, _) => "following error, mm".to_owned(),
            (_, "") => signal.name().replace('_', " "),
            _ => format!("{}, {unit}", what(unit)),
        };
        let values = recording.values(signal).unwrap_or_default();
        let points = times.iter().copied().zip(values).collect();
        let place = panels.iter().position(|(known, _)| *known == key);
        let place = place.unwrap_or_else(|| {
            panels.push((key.clone(), figures::panel(&key, Vec::new())));
            panels.len() - 1
        });
        let series = &mut panels[place].1.series;
        let name = signal.name().replace('_', " ");
        let colour = Colour::cycle(series.len());
        series.push(Series::line(name, points, colour).with_width(1.5));
    }
    Figure::new(title, panels.into_iter().map(|(_, panel)| panel).collect())
}

/// What is measured in a unit.
fn what(unit: &str) -> &'static str {
    match unit {
        "mm" => "position",
        "d" => "count",
        "mm/min" => "velocity",
        "m/s²" => "acceleration",
        "m/s³" => "jerk",
        "%" => "command",
        _ => "value",
    }
}

/// Refuses output files before any work is done.
pub fn check(to: &RecordingArgs) -> Result<(), CommandError> {
    check_outputs_of(
        ("--out", to.out.as_deref()),
        ("--plot", to.plot.as_deref()),
        None,
    )
}

/// Writes, draws and tells what was recorded.
pub fn tell(recorded: &Recorded, title: &str, to: &RecordingArgs) -> Result<(), CommandError> {
    if let Some(path) = &to.out {
        write_file(path, |file| recorded::write(recorded, file))?;
    }
    if let Some(path) = &to.plot {
        figure(title, &recorded.recording).save(path)?;
    }
    let summary = Summary::of(&recorded.recording);
    if to.json {
        print_json(&summary)
    } else {
        print(&summary.to_text())
    }
}
