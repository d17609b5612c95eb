//! Drawings in planes of a machine: one scale in both directions, lines that go anywhere.

use std::path::Path;

use kuva::backend::svg::SvgBackend;
use kuva::render::axis::{add_axes_and_grid, add_labels_and_title};
use kuva::render::layout::{ComputedLayout, Layout};
use kuva::render::render::{Primitive, Scene, TextAnchor};

use super::axis::{Range, is_drawable};
use super::draw::{Ink, Target};
use super::scene::{FONTS, theme};
use super::stroke::{self, Pixel};
use super::text::{self, LABEL_SIZE, TICK_SIZE, TITLE_SIZE};
use super::{PlotError, Series, Stroke, legend, raster, save_as};

/// Space around the panels, pixels.
const TITLE_BAND: f64 = 44.0;
const LEFT: f64 = 76.0;
const BETWEEN: f64 = 84.0;
const BELOW: f64 = 58.0;
/// From a panel's foot to the baseline of its label, pixels.
const X_LABEL_BELOW: f64 = 42.0;
/// Side that the largest panel is drawn to at most, pixels.
const LARGEST_PANEL: f64 = 520.0;
/// Least width that a panel is given, for its labels, pixels.
const LEAST_PANEL: f64 = 90.0;
/// Least distance between ticks, pixels.
const TICK_SPACING: f64 = 62.0;

/// A plane with its curves: points are joined in their order, both axes have the same scale.
#[derive(Debug, Clone, Default)]
pub struct Plane {
    /// Name and unit of the horizontal axis.
    pub x_label: String,
    /// Name and unit of the vertical axis.
    pub y_label: String,
    /// Curves in drawing order; a point that is not finite leaves a gap.
    pub series: Vec<Series>,
}

/// Planes side by side in one scale, with one key: that of the first.
#[derive(Debug, Clone)]
pub struct PlaneFigure {
    /// Line above; empty for none.
    pub title: String,
    /// From the left; at least one.
    pub planes: Vec<Plane>,
}

struct Placed {
    x: Range,
    y: Range,
    left: f64,
    width: f64,
    height: f64,
}

impl PlaneFigure {
    /// Writes the figure as [`Figure::save`](super::Figure::save) does.
    ///
    /// # Errors
    /// As there.
    pub fn save(&self, path: &Path) -> Result<(), PlotError> {
        save_as(path, || self.to_svg(), || self.to_png())
    }

    /// The figure as an SVG document.
    ///
    /// # Errors
    /// A figure without planes.
    pub fn to_svg(&self) -> Result<String, PlotError> {
        let (scene, width, height) = self.compose(Target::Svg)?;
        let document = SvgBackend::new().render_scene(&scene);
        let view_box = format!(r#"<svg viewBox="0 0 {width} {height}" "#);
        Ok(document.replacen("<svg ", &view_box, 1))
    }

    /// The figure as a PNG file.
    ///
    /// # Errors
    /// A figure without planes.
    pub fn to_png(&self) -> Result<Vec<u8>, PlotError> {
        let (scene, width, height) = self.compose(Target::Png)?;
        raster::render(&scene, width, height).map_err(PlotError::Encode)
    }

    fn compose(&self, target: Target) -> Result<(Scene, u32, u32), PlotError> {
        let first = self.planes.first().ok_or(PlotError::NoPanels)?;
        let placed = self.placed();
        let right = legend::margin(first.series.iter(), 1200.0);
        let panels_right = placed.last().map_or(LEFT, |one| one.left + one.width);
        let tallest = placed.iter().map(|one| one.height).fold(0.0, f64::max);
        let title_width = text::width(&self.title, TITLE_SIZE) + 32.0;
        let width = (panels_right + right).max(title_width).ceil();
        let height = (TITLE_BAND + tallest + BELOW).ceil();
        let mut scene = Scene::new(width, height);
        scene.font_family = Some(FONTS.to_owned());
        scene.add(text::line(
            &self.title,
            width / 2.0,
            TITLE_BAND - 16.0,
            TITLE_SIZE,
            TextAnchor::Middle,
        ));
        for (plane, one) in self.planes.iter().zip(&placed) {
            draw(&mut scene, target, plane, one, (width, height));
        }
        let corner = (panels_right, TITLE_BAND);
        let below = TITLE_BAND + tallest;
        legend::draw(&mut scene, target, &first.series, corner, below, right);
        Ok((scene, width as u32, height as u32))
    }

    /// Ranges and places of the planes in the one scale that lets the largest fit.
    fn placed(&self) -> Vec<Placed> {
        let ranges: Vec<(Range, Range)> = self.planes.iter().map(ranges).collect();
        let sides = ranges.iter().flat_map(|(x, y)| [x, y]);
        let longest = sides.map(|one| one.high - one.low).fold(0.0, f64::max);
        let scale = LARGEST_PANEL / longest;
        let mut left = LEFT + 0.5;
        let place = |(x, y): (Range, Range)| {
            let side = |range: &Range| ((range.high - range.low) * scale).max(LEAST_PANEL).round();
            let (width, height) = (side(&x), side(&y));
            let placed = Placed {
                x: widened(x, width / scale),
                y: widened(y, height / scale),
                left,
                width,
                height,
            };
            left += width + BETWEEN;
            placed
        };
        ranges.into_iter().map(place).collect()
    }
}

fn ranges(plane: &Plane) -> (Range, Range) {
    let points = || {
        let points = plane.series.iter().flat_map(|series| &series.points);
        points.filter(|point| is_drawable(point.0) && is_drawable(point.1))
    };
    (
        Range::of(points().map(|point| point.0)).padded(),
        Range::of(points().map(|point| point.1)).padded(),
    )
}

/// The range about its middle, of this length.
fn widened(range: Range, length: f64) -> Range {
    let middle = 0.5 * (range.low + range.high);
    Range {
        low: middle - 0.5 * length,
        high: middle + 0.5 * length,
    }
}

fn draw(scene: &mut Scene, target: Target, plane: &Plane, at: &Placed, (w, h): (f64, f64)) {
    let top = TITLE_BAND + 0.5;
    let (x_step, y_step) = (
        at.x.tick_step(at.width, TICK_SPACING),
        at.y.tick_step(at.height, TICK_SPACING),
    );
    let layout = Layout::new(at.x.ends(), at.y.ends())
        .with_width(w)
        .with_height(h)
        .with_force_margins(at.left, w - at.left - at.width)
        .with_force_margins_y(top, h - top - at.height)
        .with_x_axis_min(at.x.low)
        .with_x_axis_max(at.x.high)
        .with_y_axis_min(at.y.low)
        .with_y_axis_max(at.y.high)
        .with_x_tick_step(x_step)
        .with_y_tick_step(y_step)
        .with_x_tick_format(at.x.tick_format(x_step))
        .with_y_tick_format(at.y.tick_format(y_step))
        .with_label_size(LABEL_SIZE)
        .with_tick_size(TICK_SIZE)
        .with_y_label(text::literal(&plane.y_label))
        .with_grid_line_width(1.0)
        .with_theme(theme())
        .with_box_axes();
    let computed = ComputedLayout::from_layout(&layout);
    add_axes_and_grid(scene, &computed, &layout);
    add_labels_and_title(scene, &computed, &layout);
    // kuva's own would stand at the foot of the canvas, which is not that of every panel.
    let middle = at.left + 0.5 * at.width;
    let foot = top + at.height + X_LABEL_BELOW;
    let label = text::line(&plane.x_label, middle, foot, LABEL_SIZE, TextAnchor::Middle);
    scene.add(label);
    scene.add(Primitive::GroupStart {
        transform: None,
        title: None,
        extra_attrs: Some(r#"stroke-linejoin="round" stroke-linecap="round""#.to_owned()),
    });
    let map = |point: &(f64, f64)| (computed.map_x(point.0), computed.map_y(point.1));
    for series in &plane.series {
        let lines = lines(series, map);
        Ink::of(series).draw(scene, target, lines);
    }
    scene.add(Primitive::GroupEnd);
}

/// The series in pixels: dots together, lines cut at their gaps.
fn lines(series: &Series, map: impl Fn(&(f64, f64)) -> Pixel) -> Vec<Vec<Pixel>> {
    let drawable = |point: &(f64, f64)| is_drawable(point.0) && is_drawable(point.1);
    if series.stroke == Stroke::Dots {
        let dots = series.points.iter().filter(|point| drawable(point));
        return vec![stroke::distinct(dots.map(map), 1.0)];
    }
    series
        .points
        .split(|point| !drawable(point))
        .filter(|line| line.len() > 1)
        .map(|line| line.iter().map(&map).collect())
        .collect()
}
