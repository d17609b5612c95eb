//! Figures of the part's features from touches, true ones or probed ones.

use nalgebra::{DMatrix, RowDVector, Vector3};

use super::ProveOutError;
use super::gauge::planned;
use super::part::{BORE_MM, Feature};
use crate::metrology::{Axis, Nominal, Settings, Touch, circle, plane, shoulder};
use crate::setting_vector::{Component, SettingVector};

/// What a figure is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// The feature.
    pub feature: Feature,
    /// What of it.
    pub what: &'static str,
    /// True for an angle: the value is in rad, else in mm.
    pub is_angle: bool,
    /// Measured less planned.
    pub value: f64,
    /// 1σ by the 1σ of the touches.
    pub sigma: f64,
}

/// The figures of the features that the program cuts, from their touches in the coordinates of the part.
///
/// # Errors
/// Touches that do not determine a figure.
pub fn figures(touches: &[(Feature, Touch)]) -> Result<Vec<Figure>, ProveOutError> {
    let mut figures = Vec::new();
    for feature in Feature::CUT {
        let own = touches.iter().filter(|(one, _)| *one == feature);
        let own: Vec<Touch> = own.map(|(_, touch)| *touch).collect();
        let mut add = |what, is_angle, value, sigma: Option<f64>| {
            figures.push(Figure {
                feature,
                what,
                is_angle,
                value,
                sigma: sigma.unwrap_or_default(),
            });
        };
        let settings = Settings::default();
        match feature {
            Feature::Bore(number) => {
                let found = circle::fit(&nominal_bore(number), &own, &settings)?;
                let sigma = |i: usize| found.sigma.as_ref().map(|sigma| sigma.centre_mm[i]);
                add("x", false, found.value.centre_mm[0], sigma(0));
                add("y", false, found.value.centre_mm[1], sigma(1));
            }
            Feature::Shoulder => {
                let found = shoulder::fit(&own, Axis::Y, &settings)?;
                let sigma = found.sigma.as_ref();
                add(
                    "x",
                    false,
                    found.value.offset_mm,
                    sigma.map(|s| s.offset_mm),
                );
                add("γ", true, found.value.turn, sigma.map(|s| s.turn));
            }
            _ => {
                let found = plane::fit(&own, &settings)?;
                let sigma = found.sigma.as_ref();
                add(
                    "z",
                    false,
                    found.value.offset_mm,
                    sigma.map(|s| s.offset_mm),
                );
                for (index, what) in ["λ", "β"].into_iter().enumerate() {
                    let turn = sigma.map(|s| s.rotation[index]);
                    add(what, true, found.value.rotation[index], turn);
                }
            }
        }
    }
    Ok(figures)
}

/// A bore as it is planned.
#[must_use]
pub fn nominal_bore(number: usize) -> Nominal {
    let [x, y] = Feature::bore_centre(number);
    Nominal::straight(Axis::Z, [x, y, -15.0], 2.0 * BORE_MM)
}

/// How much each figure changes with (a, b, c, λ, β, γ) of all its touches: one row for each figure.
///
/// # Errors
/// As [`figures`].
pub fn sensitivity() -> Result<DMatrix<f64>, ProveOutError> {
    // Small enough for circles to be linear, large enough for rounding.
    const STEP: f64 = 1e-5;
    let displaced = |setting: &SettingVector| {
        let touch = |(feature, place, normal): (Feature, [f64; 3], [f64; 3])| {
            let moved = Vector3::from(setting.displacement_of(place));
            let out = moved.dot(&Vector3::from(normal));
            (feature, Touch::off_by(place, normal, out).with_sigma(1.0))
        };
        let touches: Vec<_> = planned(&Feature::CUT, false).map(touch).collect();
        figures(&touches)
    };
    let none = displaced(&SettingVector::ZERO)?;
    let mut rows = vec![RowDVector::zeros(6); none.len()];
    for component in Component::ALL {
        let with = displaced(&SettingVector::ZERO.with(component, STEP))?;
        for (row, (one, zero)) in rows.iter_mut().zip(with.iter().zip(&none)) {
            row[component.index()] = (one.value - zero.value) / STEP;
        }
    }
    Ok(DMatrix::from_rows(&rows))
}
