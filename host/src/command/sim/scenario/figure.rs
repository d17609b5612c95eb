//! The picture of a scenario.

use std::path::Path;

use crate::command::file_name;
use crate::figures::{FOLLOWING_ERROR, VELOCITY, panel, points};
use crate::plot::{Colour, Figure, Panel, Series};
use crate::scenario_file::ScenarioFile;
use crate::scenario_run::{Event, Record, Tick, What};

/// Position, velocity, following error and command over time, with what happened.
pub(super) fn figure(
    path: &Path,
    file: &ScenarioFile,
    record: &Record,
    events: &[Event],
) -> Figure {
    let start = record.ticks.first().map_or(0.0, |tick| tick.shaft.position);
    let curve =
        |value: &dyn Fn(&Tick) -> f64| points(&record.ticks, record.tick_hz, |_| 0.0, value);
    let mm = |position: f64| (position - start) / record.counts_per_mm;
    let line =
        |name: &str, value: &dyn Fn(&Tick) -> f64, colour| Series::line(name, curve(value), colour);
    let dashed = |name: &str, value: &dyn Fn(&Tick) -> f64| {
        Series::dashed(name, curve(value), Colour::Black)
    };
    let mut panels = vec![
        panel(
            "position, mm",
            vec![
                line("shaft", &|tick| mm(tick.shaft.position), Colour::Blue),
                dashed("setpoint", &|tick| {
                    mm(tick.outputs.setpoint.position.to_num())
                }),
            ],
        ),
        panel(
            VELOCITY,
            vec![
                line("shaft", &|tick| tick.shaft.velocity, Colour::Blue),
                dashed("setpoint", &|tick| tick.outputs.setpoint.velocity.to_num()),
            ],
        ),
        panel(
            FOLLOWING_ERROR,
            vec![line(
                "following error",
                &|tick| tick.outputs.following_error.to_num(),
                Colour::BluishGreen,
            )],
        ),
        panel(
            "command, of full",
            vec![line(
                "command",
                &|tick| tick.outputs.command.to_num(),
                Colour::ReddishPurple,
            )],
        ),
    ];
    for panel in &mut panels {
        let marks = marks(panel, file, record, events);
        // Beneath the curves.
        panel.series.splice(0..0, marks);
    }
    let title = if file.description.is_empty() {
        file_name(path).into_owned()
    } else {
        format!("{}: {}", file_name(path), file.description)
    };
    let mut figure = Figure::new(title, panels);
    figure.height = 1000;
    figure
}

/// Vertical lines at the actions, the troubles and the faults.
fn marks(panel: &Panel, file: &ScenarioFile, record: &Record, events: &[Event]) -> Vec<Series> {
    let values = || {
        panel
            .series
            .iter()
            .flat_map(|series| &series.points)
            .map(|point| point.1)
    };
    let low = values().fold(f64::INFINITY, f64::min);
    let high = values().fold(f64::NEG_INFINITY, f64::max);
    let lines = |wanted: &dyn Fn(&What) -> bool| -> Vec<(f64, f64)> {
        let found = events.iter().filter(|event| wanted(&event.what));
        found
            .flat_map(|event| {
                let time = event.tick as f64 / record.tick_hz;
                // What is not finite parts the lines.
                [(time, low), (time, high), (time, f64::NAN)]
            })
            .collect()
    };
    let is_trouble = |index: &usize| file.is_trouble(*index);
    let kinds = [
        (
            "action",
            (Colour::Grey, 1.5),
            lines(&|what| matches!(what, What::Action(index, _) if !is_trouble(index))),
        ),
        (
            "trouble",
            // A fault in the same tick is seen on it.
            (Colour::Orange, 4.5),
            lines(&|what| matches!(what, What::Action(index, _) if is_trouble(index))),
        ),
        (
            "fault",
            (Colour::Vermillion, 1.5),
            lines(&|what| matches!(what, What::Fault(_))),
        ),
    ];
    kinds
        .into_iter()
        .filter(|(_, _, points)| !points.is_empty())
        .map(|(name, (colour, width), points)| Series::line(name, points, colour).with_width(width))
        .collect()
}
