//! The effective radius of a stylus and its pre-travel by direction, on a ring or a sphere of known size.
//!
//! The axis latches where the middle of the stylus was at the trigger, P. Between the contact and the trigger it went on by the pre-travel,
//! which differs by direction: a kinematic probe sits on three supports and so has three lobes. With C the centre of the
//! reference, R its radius and t the direction in which the stylus went,
//!
//! |P − C| = R − r(t) within a ring, t = (P − C)/|P − C|;   |P − C| = R + r(t) on a boss or a sphere, t the other way;
//!
//! r(t) = r₀ + Σₖ sinᵏθ·(aₖ cos kφ + bₖ sin kφ) + c·(cos²θ − ⅓), k = 2, 3, …
//!
//! φ is the direction in the plane of x and y, θ the angle to the axis of the stylus, z; the part in c is there on a sphere alone. r(t) is the
//! radius of the stylus less its pre-travel: what is to be taken off, or added, when a surface is touched in that direction. A part
//! with k = 1 cannot be told from a centre elsewhere, and is none for whoever sets the probe by the same reference.

mod model;

use leadscrew_nc::source::Complaint;
use nalgebra::Vector3;
use serde::Serialize;

use super::{RANGE, Value};
use crate::metrology::MetrologyError;
use crate::metrology::adjustment::{Adjusted, adjust};
use crate::metrology::fitted::{Quality, Settings};
use crate::metrology::touch::Touch;
use leadscrew_nc::csv_text::{CsvText, Row};
use model::{Probed, wave, zone};

/// Largest order of the lobes.
pub const MOST_ORDER: u32 = 12;

/// What is touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Artefact {
    /// The inside of a ring, in the plane of x and y.
    Ring,
    /// The outside of a boss, in that plane.
    Boss,
    /// The outside of a sphere.
    Sphere,
}

impl Artefact {
    const fn is_inside(self) -> bool {
        matches!(self, Self::Ring)
    }

    const fn dimensions(self) -> usize {
        match self {
            Self::Ring | Self::Boss => 2,
            Self::Sphere => 3,
        }
    }
}

/// What is known beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// What is touched.
    pub artefact: Artefact,
    /// Its diameter, mm.
    pub diameter_mm: f64,
    /// Highest order of the lobes that is sought, 2 to [`MOST_ORDER`]; below 2 none.
    pub orders: u32,
}

/// A lobe.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Lobe {
    /// How often it comes in a turn.
    pub order: u32,
    /// Part with the cosine, mm.
    pub cosine_mm: Value,
    /// Part with the sine, mm.
    pub sine_mm: Value,
    /// Both together, mm.
    pub amplitude_mm: f64,
}

/// A stylus as calibrated.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stylus {
    /// r₀, mm.
    pub radius_mm: Value,
    /// Lobes, from order 2 on.
    pub lobes: Vec<Lobe>,
    /// c, mm; on a sphere whose touches tell it.
    pub polar_mm: Option<Value>,
    /// Where the centre of the reference is, mm.
    pub centre_mm: Vec<Value>,
    /// Greatest less least effective radius round the plane of x and y, mm.
    pub lobing_mm: f64,
    /// Residuals and flags.
    pub quality: Quality,
}

impl Stylus {
    /// The effective radius for a surface that is touched going in the direction `towards`, mm.
    #[must_use]
    pub fn radius_towards(&self, towards: [f64; 3]) -> f64 {
        let direction = Vector3::from(towards).normalize();
        let lobes: f64 = self
            .lobes
            .iter()
            .map(|lobe| {
                let [cosine, sine] = wave(lobe.order, &direction);
                lobe.cosine_mm.value * cosine + lobe.sine_mm.value * sine
            })
            .sum();
        let polar = self
            .polar_mm
            .map_or(0.0, |polar| polar.value * zone(&direction));
        self.radius_mm.value + lobes + polar
    }
}

/// Reads a table with the columns `x_mm`, `y_mm` and, for a sphere, `z_mm`: the middle of the stylus at each trigger.
///
/// # Errors
/// Where the table is none.
pub fn read(text: &str, artefact: Artefact) -> Result<Vec<[f64; 3]>, Complaint> {
    let (needed, others) = COLUMNS.split_at(artefact.dimensions());
    let csv = CsvText::read(text, needed, others)?;
    let place = |row: Row<'_>| {
        let mut place = [0.0; 3];
        for (axis, column) in needed.iter().enumerate() {
            place[axis] = row.number(column, RANGE)?;
        }
        Ok(place)
    };
    csv.rows().map(place).collect()
}

const COLUMNS: [&str; 3] = ["x_mm", "y_mm", "z_mm"];

/// Calibrates a stylus by the places of its middle at the triggers.
///
/// # Errors
/// A reference that is none, touches that do not determine the unknowns.
pub fn calibrate(
    reference: &Reference,
    triggers: &[[f64; 3]],
    settings: &Settings,
) -> Result<Stylus, MetrologyError> {
    check(reference)?;
    let sum = triggers
        .iter()
        .map(|place| Vector3::from(*place))
        .sum::<Vector3<f64>>();
    let mut start = sum / triggers.len().max(1) as f64;
    if reference.artefact != Artefact::Sphere {
        start.z = 0.0;
    }
    let touch = |place: &[f64; 3]| {
        let mut measured = *place;
        if reference.artefact != Artefact::Sphere {
            measured[2] = 0.0;
        }
        Touch {
            nominal: measured,
            normal: [1.0, 0.0, 0.0],
            measured,
            sigma_mm: None,
        }
    };
    let touches: Vec<Touch> = triggers.iter().map(touch).collect();
    let model = Probed {
        reference: *reference,
        start,
    };
    let adjusted = adjust(&model, &touches, settings)?;
    Ok(stylus(&model, adjusted))
}

fn check(reference: &Reference) -> Result<(), MetrologyError> {
    let Reference {
        diameter_mm,
        orders,
        ..
    } = *reference;
    if !(diameter_mm > 0.0 && diameter_mm.is_finite()) {
        return Err(MetrologyError::Range {
            name: "diameter",
            value: diameter_mm,
            unit: "mm",
            allowed: "more than 0".to_owned(),
        });
    }
    if orders > MOST_ORDER {
        return Err(MetrologyError::Range {
            name: "orders",
            value: f64::from(orders),
            unit: "",
            allowed: format!("0 to {MOST_ORDER}"),
        });
    }
    Ok(())
}

fn stylus(model: &Probed, adjusted: Adjusted) -> Stylus {
    let first = model.dimensions();
    let at = |index: usize| Value::of(&adjusted, index, 0.0);
    let lobes: Vec<Lobe> = model
        .orders()
        .zip((first + 1..).step_by(2))
        .map(|(order, index)| Lobe {
            order,
            cosine_mm: at(index),
            sine_mm: at(index + 1),
            amplitude_mm: at(index).value.hypot(at(index + 1).value),
        })
        .collect();
    let last = adjusted.unknowns.len() - 1;
    let is_sphere = model.reference.artefact == Artefact::Sphere;
    let mut stylus = Stylus {
        radius_mm: at(first),
        lobes,
        polar_mm: is_sphere.then(|| at(last)),
        centre_mm: (0..first)
            .map(|axis| Value::of(&adjusted, axis, model.start[axis]))
            .collect(),
        lobing_mm: 0.0,
        quality: adjusted.quality,
    };
    let round = || {
        (0..360).map(|degree| {
            let (y, x) = f64::from(degree).to_radians().sin_cos();
            stylus.radius_towards([x, y, 0.0])
        })
    };
    stylus.lobing_mm = round().fold(f64::MIN, f64::max) - round().fold(f64::MAX, f64::min);
    stylus
}
