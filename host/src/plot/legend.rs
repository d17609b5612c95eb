//! The key to a panel's curves, in the margin right of it.

use kuva::render::render::{Scene, TextAnchor};

use super::draw::{Ink, Target};
use super::series::{Series, Stroke};
use super::stroke::Pixel;
use super::text::{self, LEGEND_SIZE};

/// Between the panel and its key, pixels.
const GAP: f64 = 16.0;
/// Length of the drawn sample, pixels.
const SAMPLE: f64 = 28.0;
/// Between sample and name, pixels.
const SAMPLE_GAP: f64 = 8.0;
/// Right of the longest name, pixels.
const EDGE: f64 = 14.0;
/// Height of an entry, pixels.
const ROW: f64 = 21.0;
/// Greatest part of the figure's width that names may take.
const LARGEST_SHARE: f64 = 0.3;
/// Margin without a key: room for half of the last tick's label, pixels.
const BARE_MARGIN: f64 = 36.0;

/// Width of the margin that holds every panel's key, pixels.
pub(super) fn margin<'a>(series: impl Iterator<Item = &'a Series>, figure_width: f64) -> f64 {
    let widest = series
        .filter(|series| !series.name.is_empty())
        .map(|series| text::width(&series.name, LEGEND_SIZE))
        .reduce(f64::max);
    let frame = GAP + SAMPLE + SAMPLE_GAP + EDGE;
    match widest {
        Some(width) => frame + width.min(figure_width * LARGEST_SHARE - frame),
        None => BARE_MARGIN,
    }
}

/// Draws the key of one panel: `margin` wide, from (`left`, `top`) down to `bottom`.
pub(super) fn draw(
    scene: &mut Scene,
    target: Target,
    series: &[Series],
    (left, top): Pixel,
    bottom: f64,
    margin: f64,
) {
    let named: Vec<&Series> = series.iter().filter(|one| !one.name.is_empty()).collect();
    let rows = ((bottom - top) / ROW).max(1.0) as usize;
    let shown = if named.len() > rows {
        rows.saturating_sub(1)
    } else {
        named.len()
    };
    let start = left + GAP;
    let text_start = start + SAMPLE + SAMPLE_GAP;
    let room = margin - (text_start - left) - EDGE / 2.0;
    let write = |scene: &mut Scene, row: usize, name: &str| {
        let baseline = middle(top, row) + f64::from(LEGEND_SIZE) * 0.36;
        let name = text::fit(name, LEGEND_SIZE, room);
        scene.add(text::line(
            &name,
            text_start,
            baseline,
            LEGEND_SIZE,
            TextAnchor::Start,
        ));
    };
    for (row, series) in named.iter().take(shown).enumerate() {
        sample(scene, target, series, (start, middle(top, row)));
        write(scene, row, &series.name);
    }
    if shown < named.len() {
        write(scene, shown, &format!("+ {} more", named.len() - shown));
    }
}

fn middle(top: f64, row: usize) -> f64 {
    top + ROW * (row as f64 + 0.5)
}

fn sample(scene: &mut Scene, target: Target, series: &Series, (x, y): Pixel) {
    let mut ink = Ink::of(series);
    let points = match series.stroke {
        // Single pixels do not show a colour: the sample's dots are larger than the curve's.
        Stroke::Dots => {
            ink.width = ink.width.max(4.0);
            [0.15, 0.5, 0.85]
                .map(|part| (x + SAMPLE * part, y))
                .to_vec()
        }
        Stroke::Solid | Stroke::Dashed => vec![(x, y), (x + SAMPLE, y)],
    };
    ink.draw(scene, target, vec![points]);
}
