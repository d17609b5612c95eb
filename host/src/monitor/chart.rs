//! The rolling chart.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use ratatui::symbols::Marker;
use ratatui::widgets::{Axis, Block, Chart, Dataset, GraphType};

use super::state::{CHART_S, State};

/// Least height of the vertical axis, in its unit, by which noise of the last bit does not fill the chart.
const LEAST: f64 = 1e-3;

pub(super) fn draw(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let signal = state.signal();
    let unit = state.scale.of(signal).unit;
    let newest = state.samples.back().map_or(0.0, |sample| sample.time_s);
    let points: Vec<(f64, f64)> = state
        .samples
        .iter()
        .map(|sample| (sample.time_s - newest, sample.values[state.charted]))
        .collect();
    let (low, high) = range(&points);
    let data = Dataset::default()
        .marker(Marker::Braille)
        .graph_type(GraphType::Line)
        .style(Style::new().fg(Color::Cyan))
        .data(&points);
    let title = format!(" {}, {unit} (t: another) ", signal.name().replace('_', " "));
    let time = Axis::default()
        .bounds([-CHART_S, 0.0])
        .labels([format!("-{CHART_S} s"), "now".to_owned()]);
    let value = Axis::default().bounds([low, high]).labels([
        label(low, high - low),
        label(f64::midpoint(low, high), high - low),
        label(high, high - low),
    ]);
    let chart = Chart::new(vec![data])
        .block(Block::bordered().title(title))
        .x_axis(time)
        .y_axis(value);
    frame.render_widget(chart, area);
}

/// Ends of the vertical axis: zero is within, and a tenth is free above and below.
fn range(points: &[(f64, f64)]) -> (f64, f64) {
    let values = points.iter().map(|(_, value)| *value);
    let (low, high) = values.fold((0.0_f64, 0.0_f64), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    let room = 0.1 * (high - low).max(LEAST);
    (low - room, high + room)
}

/// A value with as many decimals as the span needs, always as wide.
fn label(value: f64, span: f64) -> String {
    let decimals = (2.0 - span.log10()).clamp(0.0, 5.0) as usize;
    format!("{value:>9.decimals$}")
}
