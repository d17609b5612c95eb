//! The screen of a state.

use leadscrew::scope::Signal;
use leadscrew::supervisor;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph, Wrap};

use super::chart;
use super::state::State;
use crate::fault_names::fault_name;

/// Smallest terminal that it has room in.
const LEAST: (u16, u16) = (60, 20);
const KEYS: &str =
    "←/→ jog  ↑/↓ feed  space stop  h hold  e enable  d disable  c clear  t chart  q quit";

/// Draws the screen.
pub fn draw(frame: &mut Frame<'_>, state: &State) {
    let area = frame.area();
    if area.width < LEAST.0 || area.height < LEAST.1 {
        let (width, height) = LEAST;
        let text = format!("The terminal is too small: {width} × {height} at least. q quits.");
        frame.render_widget(Paragraph::new(text).wrap(Wrap { trim: true }), area);
        return;
    }
    let rows = [
        Constraint::Length(1),
        Constraint::Length(8),
        Constraint::Min(8),
        Constraint::Length(1),
        Constraint::Length(if area.width < 84 { 2 } else { 1 }),
    ];
    let [title, figures, plot, message, keys] = Layout::vertical(rows).areas(area);
    draw_title(frame, title, state);
    let [left, right] =
        Layout::horizontal([Constraint::Percentage(55), Constraint::Min(0)]).areas(figures);
    draw_motion(frame, left, state);
    draw_standing(frame, right, state);
    chart::draw(frame, plot, state);
    let said = Style::new().fg(Color::Yellow);
    frame.render_widget(Paragraph::new(state.message.as_str()).style(said), message);
    frame.render_widget(Paragraph::new(KEYS).wrap(Wrap { trim: true }), keys);
}

fn draw_title(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let style = Style::new().add_modifier(Modifier::REVERSED);
    let lost = match state.lost {
        0 => String::new(),
        lost => format!("  {lost} samples lost"),
    };
    let text = format!(" leadscrew monitor  {}{lost}", state.title);
    frame.render_widget(Paragraph::new(text).style(style), area);
}

fn draw_motion(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let status = &state.status;
    let figure = |name: &'static str, value: Option<f64>, decimals: usize, unit: &'static str| {
        let value = value.map_or_else(|| "-".to_owned(), |value| format!("{value:.decimals$}"));
        Line::from(vec![
            Span::raw(format!("{name:<17}")),
            Span::styled(
                format!("{value:>12}"),
                Style::new().add_modifier(Modifier::BOLD),
            ),
            Span::raw(format!(" {unit}")),
        ])
    };
    let lines = vec![
        figure("position", Some(status.position_mm), 4, "mm"),
        figure("setpoint", Some(status.setpoint_mm), 4, "mm"),
        figure("following error", Some(status.following_error_mm), 4, "mm"),
        figure("velocity", Some(status.velocity_mm_per_min), 1, "mm/min"),
        figure(
            "acceleration",
            state.newest(Signal::Acceleration),
            3,
            "m/s²",
        ),
        figure("output", state.newest(Signal::Command), 2, "%"),
    ];
    let block = Block::bordered().title(" motion ");
    frame.render_widget(Paragraph::new(lines).block(block), area);
}

fn draw_standing(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let status = &state.status;
    let colour = match status.state() {
        Some(supervisor::State::Fault) => Color::Red,
        Some(supervisor::State::Ready | supervisor::State::Moving) => Color::Green,
        _ => Color::Yellow,
    };
    let strong = |text: String, colour| {
        Span::styled(text, Style::new().fg(colour).add_modifier(Modifier::BOLD))
    };
    let fault = match (status.fault_number, status.fault()) {
        (0, _) => strong("none".to_owned(), Color::Green),
        (_, Some(fault)) => strong(fault_name(fault).to_owned(), Color::Red),
        (number, None) => strong(format!("number {number}"), Color::Red),
    };
    let warnings: Vec<_> = status.warnings().map(fault_name).collect();
    let warnings = match warnings.is_empty() {
        true => Span::raw("none"),
        false => strong(warnings.join(", "), Color::Yellow),
    };
    let held = if status.is_held { ", feed hold" } else { "" };
    let homed = if status.is_homed { "yes" } else { "no" };
    let line = |name: &'static str, value: Span<'static>| {
        Line::from(vec![Span::raw(format!("{name:<10}")), value])
    };
    let lines = vec![
        line("state", strong(status.state_text().to_owned(), colour)),
        line("fault", fault),
        line("warnings", warnings),
        line("homed", Span::raw(homed)),
        line(
            "override",
            Span::raw(format!("{} %{held}", status.override_percent)),
        ),
        line("jog feed", Span::raw(format!("{} mm/min", state.feed))),
    ];
    let block = Block::bordered().title(" axis ");
    frame.render_widget(Paragraph::new(lines).block(block), area);
}
