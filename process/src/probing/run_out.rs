//! Where the middle of the stylus stands beside the axis of the spindle, from touches before and after the spindle is turned.
//!
//! With the spindle at the angle φ the stylus stands at R(φ)·e beside its axis, so a surface at s is found at
//!
//! x = s − (R(φ)·e)ₓ,   and after half a turn at s + (R(φ)·e)ₓ: e is half the difference, s the mean.
//!
//! Touches of one surface along x tell e in x, along y in y; touches at a quarter turn tell both from one surface.

use std::collections::BTreeSet;

use leadscrew_nc::source::Complaint;
use serde::Serialize;

use super::{RANGE, Value};
use crate::metrology::MetrologyError;
use crate::metrology::adjustment::{Model, adjust};
use crate::metrology::fitted::{Quality, Settings};
use crate::metrology::touch::Touch;
use leadscrew_nc::csv_text::{CsvText, Row};

/// Angles of the spindle, degrees.
const ANGLES: (f64, f64) = (-36_000.0, 36_000.0);

/// The axis along which a surface is touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Along {
    /// x.
    X,
    /// y.
    Y,
}

/// A touch.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TurnedTouch {
    /// Name of the surface.
    pub surface: String,
    /// Along which axis it is touched.
    pub along: Along,
    /// Angle of the spindle, rad, right-handed from x to y.
    pub angle: f64,
    /// Where the axis of the spindle was at the contact, mm along the axis of the touch.
    pub position_mm: f64,
}

impl TurnedTouch {
    /// Reads a table with the columns `along` (x or y), `angle_deg`, `position_mm` and, where one axis has several
    /// surfaces, `surface`.
    ///
    /// # Errors
    /// Where the table is none.
    pub fn read(text: &str) -> Result<Vec<Self>, Complaint> {
        let csv = CsvText::read(text, &["along", "angle_deg", "position_mm"], &["surface"])?;
        let touch = |row: Row<'_>| {
            let along = match row.text("along") {
                "x" => Along::X,
                "y" => Along::Y,
                other => {
                    let message = format!("along = \"{other}\": expected x or y");
                    return Err(row.complain("along", message));
                }
            };
            Ok(Self {
                surface: row.text("surface").to_owned(),
                along,
                angle: row.number("angle_deg", ANGLES)?.to_radians(),
                position_mm: row.number("position_mm", RANGE)?,
            })
        };
        csv.rows().map(touch).collect()
    }

    /// How the position found falls with e in x and in y.
    fn lever(&self) -> [f64; 2] {
        let (sine, cosine) = self.angle.sin_cos();
        match self.along {
            Along::X => [cosine, -sine],
            Along::Y => [sine, cosine],
        }
    }
}

/// A surface as found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Surface {
    /// Its name.
    pub name: String,
    /// Along which axis it is touched.
    pub along: Along,
    /// Where the axis of the spindle is when a stylus without run-out touches, mm.
    pub position_mm: Value,
}

/// Run-out of a stylus.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunOut {
    /// e in x at the angle 0, mm; none where no touch tells it.
    pub x_mm: Option<Value>,
    /// The same in y.
    pub y_mm: Option<Value>,
    /// How far the stylus stands beside the axis, mm; none unless both are known.
    pub radius_mm: Option<f64>,
    /// The surfaces.
    pub surfaces: Vec<Surface>,
    /// Residuals and flags.
    pub quality: Quality,
}

/// e, as far as it can be seen, then the surfaces.
struct Turned {
    /// Whether e is sought in x, in y.
    sought: [bool; 2],
    starts: Vec<f64>,
}

impl Turned {
    fn offsets(&self) -> usize {
        self.sought.iter().filter(|sought| **sought).count()
    }
}

impl Model for Turned {
    const WHAT: &'static str = "the run-out of a stylus";

    fn unknowns(&self) -> usize {
        self.offsets() + self.starts.len()
    }

    fn misfit(&self, touch: &Touch, unknowns: &[f64]) -> f64 {
        let row = self.row(touch, unknowns);
        let modelled: f64 = row
            .iter()
            .zip(unknowns)
            .map(|(slope, unknown)| slope * unknown)
            .sum();
        touch.measured[0] - self.starts[touch.nominal[2] as usize] - modelled
    }

    fn row(&self, touch: &Touch, _: &[f64]) -> Vec<f64> {
        let levers = touch.nominal.iter().zip(self.sought);
        let mut row: Vec<f64> = levers
            .filter_map(|(lever, sought)| sought.then_some(-lever))
            .collect();
        let surface = touch.nominal[2] as usize;
        row.extend((0..self.starts.len()).map(|index| f64::from(u8::from(index == surface))));
        row
    }

    fn why_degenerate(&self, _: &[f64]) -> String {
        "the spindle stood at too few angles: turn it by 180° between touches of the same surface"
            .to_owned()
    }
}

/// Sine of an angle that does not count as turned.
const NOT_TURNED: f64 = 1e-3;

/// Finds the run-out.
///
/// # Errors
/// No surface that was touched at two angles, or touches that do not tell what they have to.
pub fn find(touches: &[TurnedTouch], settings: &Settings) -> Result<RunOut, MetrologyError> {
    let names: BTreeSet<(Along, &str)> = touches
        .iter()
        .map(|touch| (touch.along, touch.surface.as_str()))
        .collect();
    let names: Vec<_> = names.into_iter().collect();
    let of = |touch: &TurnedTouch| {
        let name = (touch.along, touch.surface.as_str());
        names
            .iter()
            .position(|other| *other == name)
            .unwrap_or_default()
    };
    let sought = [0, 1].map(|component| {
        names.iter().any(|name| {
            let mine = touches
                .iter()
                .filter(|touch| (touch.along, touch.surface.as_str()) == *name);
            let levers = mine.map(|touch| touch.lever()[component]);
            let (low, high) = levers.fold((f64::MAX, f64::MIN), |(low, high), lever| {
                (low.min(lever), high.max(lever))
            });
            high - low > NOT_TURNED
        })
    });
    if sought == [false, false] {
        return Err(MetrologyError::Impossible {
            what: Turned::WHAT,
            reason: "no surface was touched at two angles of the spindle: turn it by 180° and touch again".to_owned(),
        });
    }
    let starts = names.iter().enumerate().map(|(surface, _)| {
        let first = touches.iter().find(|touch| of(touch) == surface);
        first.map_or(0.0, |touch| touch.position_mm)
    });
    let model = Turned {
        sought,
        starts: starts.collect(),
    };
    // The lever and the surface take the place of what is planned.
    let as_touch = |touch: &TurnedTouch| {
        let [x, y] = touch.lever();
        Touch {
            nominal: [x, y, of(touch) as f64],
            normal: [1.0, 0.0, 0.0],
            measured: [touch.position_mm, 0.0, 0.0],
            sigma_mm: None,
        }
    };
    let as_touches: Vec<Touch> = touches.iter().map(as_touch).collect();
    let adjusted = adjust(&model, &as_touches, settings)?;
    let x_mm = sought[0].then(|| Value::of(&adjusted, 0, 0.0));
    let y_mm = sought[1].then(|| Value::of(&adjusted, usize::from(sought[0]), 0.0));
    let surfaces = names
        .iter()
        .enumerate()
        .map(|(index, (along, name))| Surface {
            name: (*name).to_owned(),
            along: *along,
            position_mm: Value::of(&adjusted, model.offsets() + index, model.starts[index]),
        });
    Ok(RunOut {
        x_mm,
        y_mm,
        radius_mm: x_mm.zip(y_mm).map(|(x, y)| x.value.hypot(y.value)),
        surfaces: surfaces.collect(),
        quality: adjusted.quality,
    })
}
