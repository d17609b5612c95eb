//! The residuals of every touch.

use leadscrew_process::metrology::part::report::{FeatureReport, Report};

use crate::plot::{Colour, Figure, Panel, Series};

/// Diameter of the dot of a touch, pixels.
const DOT: f64 = 8.0;
/// Diameter around a flagged touch, pixels.
const FLAG: f64 = 14.0;
/// Residuals below this fill no panel, µm.
const LEAST_UM: f64 = 0.5;
/// Most panels: more features share the last ones no more than a page shows.
const MOST_PANELS: usize = 20;

/// A panel a touched feature, its touches in order; flagged ones are marked.
pub fn figure(report: &Report) -> Figure {
    let touched = report
        .features
        .iter()
        .filter(|feature| !feature.touches.is_empty());
    let mut panels: Vec<Panel> = touched.take(MOST_PANELS).map(panel).collect();
    if panels.is_empty() {
        panels.push(Panel::new("touch", "residual, µm", Vec::new()));
    }
    let mut figure = Figure::new("Residuals of the touches, measured less fitted", panels);
    let count = u32::try_from(figure.panels.len()).unwrap_or(u32::MAX);
    figure.height = count.saturating_mul(200).saturating_add(120);
    figure
}

fn panel(feature: &FeatureReport) -> Panel {
    let points = |flagged: bool| -> Vec<(f64, f64)> {
        let numbered = (1..).map(f64::from as fn(u32) -> f64).zip(&feature.touches);
        let wanted = numbered.filter(|(_, touch)| !flagged || touch.is_outlier);
        wanted
            .map(|(number, touch)| (number, 1000.0 * touch.residual_mm))
            .collect()
    };
    let last = feature.touches.len() as f64;
    let mut series =
        vec![Series::line("", vec![(1.0, 0.0), (last, 0.0)], Colour::Grey).with_width(1.0)];
    let flagged = points(true);
    if !flagged.is_empty() {
        series.push(Series::dots("flagged", flagged, Colour::Vermillion).with_width(FLAG));
    }
    series.push(Series::dots(feature.name.clone(), points(false), Colour::Blue).with_width(DOT));
    let largest = points(false)
        .iter()
        .fold(LEAST_UM, |largest, point| point.1.abs().max(largest));
    Panel::new("touch", "residual, µm", series).with_y_limits(-1.2 * largest, 1.2 * largest)
}
