//! Text made fit to draw: measured, shortened, cleaned.

use kuva::plot::legend::{LegendEntry, LegendShape};
use kuva::render::color::Color;
use kuva::render::layout::Layout;
use kuva::render::render::{Primitive, TextAnchor};

/// Sizes of text, pixels.
pub(super) const TITLE_SIZE: u32 = 20;
pub(super) const LABEL_SIZE: u32 = 14;
pub(super) const TICK_SIZE: u32 = 12;
pub(super) const LEGEND_SIZE: u32 = 13;

/// Width of a line of text, pixels.
pub(super) fn width(text: &str, size: u32) -> f64 {
    // kuva keeps its font metrics to itself but reserves the width of a legend by them;
    // the empty entry takes the frame off again.
    let legend = |label: &str| {
        let entry = LegendEntry {
            label: label.to_owned(),
            color: String::new(),
            shape: LegendShape::Line,
            dasharray: None,
        };
        Layout::new((0.0, 1.0), (0.0, 1.0))
            .with_body_size(size)
            .with_legend_entries(vec![entry])
            .legend_width
    };
    legend(text) - legend("")
}

/// The text, its end replaced by `…` where it is wider than `room` pixels.
pub(super) fn fit(text: &str, size: u32, room: f64) -> String {
    if width(text, size) <= room {
        return text.to_owned();
    }
    let mut kept: String = text.to_owned();
    while kept.pop().is_some() {
        let shortened = format!("{}…", kept.trim_end());
        if width(&shortened, size) <= room {
            return shortened;
        }
    }
    String::new()
}

/// The text as kuva draws it literally: dollar signs would start a formula, and
/// control characters have no place in an SVG document.
pub(super) fn literal(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect::<String>()
        .replace('$', r"\$")
}

/// A line of black text with its baseline at `y`.
pub(super) fn line(text: &str, x: f64, y: f64, size: u32, anchor: TextAnchor) -> Primitive {
    Primitive::Text {
        x,
        y,
        content: literal(text),
        size,
        anchor,
        rotate: None,
        bold: false,
        color: Some(Color::Rgb(0, 0, 0)),
    }
}
