//! The trigger delay: what is latched lies beyond the contact by the way of the delay, x = x₀ + v·τ.
//!
//! Touches of one surface from one side at two speeds give τ = (x₂ − x₁)/(v₂ − v₁); with more, the straight line through them
//! all.

use leadscrew_nc::source::Complaint;
use serde::Serialize;

use super::{RANGE, Value};
use crate::metrology::MetrologyError;
use crate::metrology::adjustment::{Model, adjust};
use crate::metrology::fitted::{Quality, Settings};
use crate::metrology::touch::Touch;
use leadscrew_nc::csv_text::{CsvText, Row};

const S_PER_MIN: f64 = 60.0;
/// Columns that `leadscrew probe --csv` writes besides.
const OF_PROBE: [&str; 6] = [
    "touch",
    "sigma_mm",
    "overtravel_mm",
    "raw_d",
    "edges",
    "tick",
];

/// A touch of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpeedTouch {
    /// Velocity at the contact, mm/min, negative downwards.
    pub velocity_mm_per_min: f64,
    /// The place that was latched, mm.
    pub position_mm: f64,
}

impl SpeedTouch {
    /// Reads a table with the columns `velocity_mm_per_min` (negative downwards) and `position_mm`.
    ///
    /// # Errors
    /// Where the table is none.
    pub fn read(text: &str) -> Result<Vec<Self>, Complaint> {
        let needed = ["velocity_mm_per_min", "position_mm"];
        let csv = CsvText::read(text, &needed, &OF_PROBE)?;
        let touch = |row: Row<'_>| {
            Ok(Self {
                velocity_mm_per_min: row.number("velocity_mm_per_min", RANGE)?,
                position_mm: row.number("position_mm", RANGE)?,
            })
        };
        csv.rows().map(touch).collect()
    }

    /// The speed takes the place of what is planned, the latch that of what is found.
    const fn as_touch(&self) -> Touch {
        Touch {
            nominal: [self.velocity_mm_per_min / S_PER_MIN, 0.0, 0.0],
            normal: [1.0, 0.0, 0.0],
            measured: [self.position_mm, 0.0, 0.0],
            sigma_mm: None,
        }
    }
}

/// What was found at one speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AtSpeed {
    /// mm/min, negative downwards.
    pub velocity_mm_per_min: f64,
    /// Touches.
    pub touches: usize,
    /// Their mean, mm.
    pub mean_mm: f64,
    /// Twice their standard deviation, mm; none of one touch.
    pub two_sigma_mm: Option<f64>,
}

/// The trigger delay.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TriggerDelay {
    /// The delay, s: to be added to the one that is set on the axis.
    pub delay_s: Value,
    /// Where the contact is, mm.
    pub contact_mm: Value,
    /// Speed by speed, in the order in which they came.
    pub speeds: Vec<AtSpeed>,
    /// Residuals and flags.
    pub quality: Quality,
}

struct Line {
    /// First position and mean speed, so that the unknowns do not hang together more than they must.
    start_mm: f64,
}

impl Model for Line {
    const WHAT: &'static str = "a trigger delay";

    fn unknowns(&self) -> usize {
        2
    }

    fn misfit(&self, touch: &Touch, unknowns: &[f64]) -> f64 {
        touch.measured[0] - self.start_mm - unknowns[0] - touch.nominal[0] * unknowns[1]
    }

    fn row(&self, touch: &Touch, _: &[f64]) -> Vec<f64> {
        vec![1.0, touch.nominal[0]]
    }

    fn why_degenerate(&self, _: &[f64]) -> String {
        "all touches have the same speed, touch at half of it too".to_owned()
    }
}

/// Finds the delay.
///
/// # Errors
/// Fewer than two touches, or all of one speed, or of both directions: these meet two sides of something.
pub fn find(touches: &[SpeedTouch], settings: &Settings) -> Result<TriggerDelay, MetrologyError> {
    let up = touches
        .iter()
        .filter(|touch| touch.velocity_mm_per_min > 0.0)
        .count();
    if up != 0 && up != touches.len() {
        return Err(MetrologyError::Impossible {
            what: Line::WHAT,
            reason: format!(
                "{up} of {} touches go upwards, the others do not: touch one surface from one side",
                touches.len()
            ),
        });
    }
    let start_mm = touches.first().map_or(0.0, |touch| touch.position_mm);
    let as_touches: Vec<Touch> = touches.iter().map(SpeedTouch::as_touch).collect();
    let adjusted = adjust(&Line { start_mm }, &as_touches, settings)?;
    Ok(TriggerDelay {
        delay_s: Value::of(&adjusted, 1, 0.0),
        contact_mm: Value::of(&adjusted, 0, start_mm),
        speeds: by_speed(touches),
        quality: adjusted.quality,
    })
}

/// Speeds that differ by less than this part are one.
const SAME_SPEED: f64 = 0.02;

fn by_speed(touches: &[SpeedTouch]) -> Vec<AtSpeed> {
    let mut groups: Vec<(f64, Vec<f64>)> = Vec::new();
    for touch in touches {
        let speed = touch.velocity_mm_per_min;
        let same =
            |(other, _): &&mut (f64, Vec<f64>)| (*other - speed).abs() <= SAME_SPEED * speed.abs();
        match groups.iter_mut().find(same) {
            Some((_, places)) => places.push(touch.position_mm),
            None => groups.push((speed, vec![touch.position_mm])),
        }
    }
    let summary = |(velocity_mm_per_min, places): (f64, Vec<f64>)| {
        let count = places.len();
        let mean_mm = places.iter().sum::<f64>() / count as f64;
        let squares: f64 = places.iter().map(|place| (place - mean_mm).powi(2)).sum();
        AtSpeed {
            velocity_mm_per_min,
            touches: count,
            mean_mm,
            two_sigma_mm: (count > 1).then(|| 2.0 * (squares / (count - 1) as f64).sqrt()),
        }
    };
    groups.into_iter().map(summary).collect()
}
