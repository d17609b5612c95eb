//! The layout: margins common to all panels, then panel by panel.

use kuva::render::axis::{add_axes_and_grid, add_labels_and_title};
use kuva::render::layout::{AxisLabelOverlap, ComputedLayout, Layout};
use kuva::render::render::{Primitive, Scene, TextAnchor};
use kuva::render::theme::Theme;

use super::axis::{Range, is_drawable};
use super::draw::{self, Frame, Target};
use super::text::{self, LABEL_SIZE, TICK_SIZE, TITLE_SIZE};
use super::{Figure, Panel, PlotError, legend};

/// Fonts of the SVG: the one kuva measures by first, then others of its width.
pub(super) const FONTS: &str = "DejaVu Sans, Verdana, Liberation Sans, Arial, sans-serif";
/// Space above the first panel, with a title and without, pixels.
const TITLE_BAND: f64 = 44.0;
const TOP_EDGE: f64 = 16.0;
/// Space between panels, pixels.
const PANEL_GAP: f64 = 22.0;
/// Space below the last panel: tick labels, and the axis label if there is one, pixels.
const TICK_BAND: f64 = 30.0;
const LABEL_BAND: f64 = 24.0;
/// Width of the left margin before it is known, near enough to count ticks by, pixels.
const TYPICAL_LEFT: f64 = 70.0;
/// Least distance between ticks, pixels.
const X_TICK_SPACING: f64 = 85.0;
const Y_TICK_SPACING: f64 = 42.0;

/// The figure as a scene for kuva's backends.
pub(super) fn compose(figure: &Figure, target: Target) -> Result<Scene, PlotError> {
    figure.validate()?;
    let plan = Plan::of(figure);
    let mut scene = Scene::new(plan.width, plan.height);
    scene.font_family = Some(FONTS.to_owned());
    if !figure.title.is_empty() {
        title(&mut scene, &figure.title, &plan);
    }
    for index in 0..figure.panels.len() {
        panel(&mut scene, target, figure, &plan, index);
    }
    Ok(scene)
}

/// Measures shared by all panels, pixels.
struct Plan {
    width: f64,
    height: f64,
    left: f64,
    right: f64,
    top: f64,
    panel_height: f64,
    x_range: Range,
    x_step: f64,
    x_label: Option<String>,
}

impl Plan {
    fn of(figure: &Figure) -> Self {
        let (width, height) = (f64::from(figure.width), f64::from(figure.height));
        let top = if figure.title.is_empty() {
            TOP_EDGE
        } else {
            TITLE_BAND
        };
        let labels = figure.panels.iter().rev().map(|panel| &panel.x_label);
        let x_label = labels.into_iter().find(|label| !label.is_empty()).cloned();
        let bottom = TICK_BAND + if x_label.is_some() { LABEL_BAND } else { 0.0 };
        let count = figure.panels.len() as f64;
        let series = || figure.panels.iter().flat_map(|panel| &panel.series);
        let x_range = Range::of(
            series()
                .flat_map(|series| &series.points)
                .filter(|point| is_drawable(point.1))
                .map(|point| point.0),
        );
        let right = legend::margin(series(), width);
        let x_step = x_range.tick_step(width - right - TYPICAL_LEFT, X_TICK_SPACING);
        let room = height - top - bottom - PANEL_GAP * (count - 1.0);
        let mut plan = Self {
            width,
            height,
            left: 0.0,
            // Frames on the middle of pixels are sharp.
            right: right.round() + 0.5,
            top: top + 0.5,
            panel_height: (room / count).floor(),
            x_range: x_range.reaching_ticks(x_step).with_end_ticks(x_step),
            x_step,
            x_label,
        };
        // kuva knows how wide the tick labels of one panel are; the widest sets all.
        let left = (0..figure.panels.len())
            .map(|index| ComputedLayout::from_layout(&plan.layout(figure, index)).margin_left)
            .fold(0.0, f64::max);
        plan.left = left.round() + 0.5;
        plan
    }

    /// kuva's layout of one panel on the whole canvas, without common side margins.
    fn layout(&self, figure: &Figure, index: usize) -> Layout {
        let panel = &figure.panels[index];
        let last = index + 1 == figure.panels.len();
        let (y_range, y_step) = y_axis(panel, self.panel_height);
        let top = self.top + index as f64 * (self.panel_height + PANEL_GAP);
        let bottom = self.height - top - self.panel_height;
        let mut layout = Layout::new(self.x_range.ends(), y_range.ends())
            .with_width(self.width)
            .with_height(self.height)
            .with_force_margins_y(top, bottom)
            .with_x_axis_min(self.x_range.low)
            .with_x_axis_max(self.x_range.high)
            .with_y_axis_min(y_range.low)
            .with_y_axis_max(y_range.high)
            .with_x_tick_step(self.x_step)
            .with_y_tick_step(y_step)
            .with_x_tick_format(self.x_range.tick_format(self.x_step))
            .with_y_tick_format(y_range.tick_format(y_step))
            .with_x_label_overlap(AxisLabelOverlap::Thin)
            .with_label_size(LABEL_SIZE)
            .with_tick_size(TICK_SIZE)
            .with_y_label(text::literal(&panel.y_label))
            .with_y_label_wrap((self.panel_height / (f64::from(LABEL_SIZE) * 0.6)) as usize)
            .with_grid_line_width(1.0)
            .with_theme(theme())
            .with_box_axes();
        layout.suppress_x_ticks = !last;
        match &self.x_label {
            Some(label) if last => layout.with_x_label(text::literal(label)),
            _ => layout,
        }
    }
}

/// Ends and distance between ticks of a panel's vertical axis, `length` pixels long.
fn y_axis(panel: &Panel, length: f64) -> (Range, f64) {
    let step_of = |range: Range| range.tick_step(length, Y_TICK_SPACING);
    if let Some((low, high)) = panel.y_limits {
        let range = Range { low, high };
        return (range.with_end_ticks(step_of(range)), step_of(range));
    }
    let points = panel.series.iter().flat_map(|series| &series.points);
    let drawn = points.filter(|point| is_drawable(point.0));
    let range = Range::of(drawn.map(|point| point.1)).padded();
    (range, step_of(range))
}

pub(super) fn theme() -> Theme {
    Theme {
        axis_color: "#444444".into(),
        tick_color: "#444444".into(),
        grid_color: "#e2e2e2".into(),
        ..Theme::light()
    }
}

fn title(scene: &mut Scene, title: &str, plan: &Plan) {
    let title = text::fit(title, TITLE_SIZE, plan.width - 2.0 * TOP_EDGE);
    // Centred over the panels where it fits there, else over the figure.
    let half = text::width(&title, TITLE_SIZE) / 2.0;
    let over_panels = (plan.left + plan.width - plan.right) / 2.0;
    let fits = half + TOP_EDGE <= over_panels;
    let x = if fits { over_panels } else { plan.width / 2.0 };
    let y = TITLE_BAND - 16.0;
    scene.add(text::line(
        title.as_str(),
        x,
        y,
        TITLE_SIZE,
        TextAnchor::Middle,
    ));
}

fn panel(scene: &mut Scene, target: Target, figure: &Figure, plan: &Plan, index: usize) {
    let layout = plan
        .layout(figure, index)
        .with_force_margins(plan.left, plan.right);
    let computed = ComputedLayout::from_layout(&layout);
    let frame = Frame {
        left: computed.margin_left,
        right: computed.width - computed.margin_right,
        top: computed.margin_top,
        bottom: computed.height - computed.margin_bottom,
        map: |(x, y)| (computed.map_x(x), computed.map_y(y)),
    };
    add_axes_and_grid(scene, &computed, &layout);
    add_labels_and_title(scene, &computed, &layout);
    scene.add(Primitive::GroupStart {
        transform: None,
        title: None,
        // Mitred corners would give noise spikes it does not have.
        extra_attrs: Some(r#"stroke-linejoin="round" stroke-linecap="round""#.to_owned()),
    });
    let series = &figure.panels[index].series;
    for one in series {
        draw::series(scene, target, &frame, one);
    }
    let corner = (frame.right, frame.top);
    legend::draw(scene, target, series, corner, frame.bottom, plan.right);
    scene.add(Primitive::GroupEnd);
}
