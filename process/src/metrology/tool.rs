//! Tool setting and tool wear, measured by probe.

use super::adjustment::{Model, adjust};
use super::error::MetrologyError;
use super::fitted::{Fitted, Settings};
use super::relations::Uncertain;
use super::touch::{Axis, Touch};

/// Repeated touches of one place: their mean is the only unknown.
struct Mean(Axis);

impl Model for Mean {
    const WHAT: &'static str = "a tool setting";

    fn unknowns(&self) -> usize {
        1
    }

    fn misfit(&self, touch: &Touch, unknowns: &[f64]) -> f64 {
        touch.deviation_mm(self.0) - unknowns[0]
    }

    fn row(&self, _: &Touch, _: &[f64]) -> Vec<f64> {
        vec![1.0]
    }

    fn why_degenerate(&self, _: &[f64]) -> String {
        String::new()
    }
}

/// The tool's setting along an axis, mm: the coordinate of the tool's control point when its tip touches the setter, less the
/// setter's own. Its length where the axis is the spindle's and points away from the workpiece. Several touches give their
/// mean. The covariance has the one element, without the setter's own uncertainty.
///
/// # Errors
/// No touches, or numbers that are not finite.
pub fn setting(
    touched_mm: &[f64],
    setter_mm: f64,
    sigma_mm: Option<f64>,
    settings: &Settings,
) -> Result<Fitted<f64>, MetrologyError> {
    let touch = |&touched: &f64| Touch {
        sigma_mm,
        ..Touch::at([setter_mm, 0.0, 0.0], Axis::X.unit(), [touched, 0.0, 0.0])
    };
    let touches: Vec<Touch> = touched_mm.iter().map(touch).collect();
    let adjusted = adjust(&Mean(Axis::X), &touches, settings)?;
    Ok(Fitted {
        value: adjusted.unknowns[0],
        sigma: adjusted.sigma(0),
        covariance: adjusted.covariance,
        quality: adjusted.quality,
    })
}

/// Wear between two settings of one tool, mm: setting now less setting then, so that a tool grown shorter is negative.
#[must_use]
pub fn wear(now: Uncertain<f64>, then: Uncertain<f64>) -> Uncertain<f64> {
    Uncertain {
        value: now.value - then.value,
        sigma: now.sigma.zip(then.sigma).map(|(now, then)| now.hypot(then)),
    }
}

/// How far the tool's tip stands off its planned place along X, mm, by the diameter it has turned: half its deviation, outside
/// and inside alike. The correction is the negative.
#[must_use]
pub fn tip_by_diameter(diameter_deviation: Uncertain<f64>) -> Uncertain<f64> {
    Uncertain {
        value: diameter_deviation.value / 2.0,
        sigma: diameter_deviation.sigma.map(|sigma| sigma / 2.0),
    }
}
