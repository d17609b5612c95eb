//! What plane and shoulder share: heights over a flat face, linear in the place.

use nalgebra::Vector3;

use super::adjustment::{Adjusted, Model, adjust};
use super::error::MetrologyError;
use super::fitted::Settings;
use super::touch::{Touch, vector3};

/// Cosine of the largest angle between the normals of touches of one face.
const SAME_NORMAL: f64 = 1.0 - 1e-9;

/// Unknowns: height at the origin, mm, then its slope along each direction. `WIDE`: along two, otherwise along one.
pub(super) struct Flat<const WIDE: bool> {
    /// Along the normal, with its largest coordinate positive: heights are deviations of coordinates.
    pub up: Vector3<f64>,
    pub directions: Vec<Vector3<f64>>,
    first_order: bool,
}

impl<const WIDE: bool> Flat<WIDE> {
    pub fn fit(
        touches: &[Touch],
        directions: impl FnOnce(Vector3<f64>) -> Vec<Vector3<f64>>,
        settings: &Settings,
    ) -> Result<(Self, Adjusted), MetrologyError> {
        let up = Self::common_normal(touches)?;
        let model = Self {
            up,
            directions: directions(up),
            first_order: settings.first_order,
        };
        let adjusted = adjust(&model, touches, settings)?;
        Ok((model, adjusted))
    }

    fn common_normal(touches: &[Touch]) -> Result<Vector3<f64>, MetrologyError> {
        let Some(first) = touches.first() else {
            return Err(MetrologyError::TooFew {
                what: Self::WHAT,
                needed: if WIDE { 3 } else { 2 },
                found: 0,
            });
        };
        let normal = vector3(first.normal);
        let looks_elsewhere = |touch: &Touch| {
            vector3(touch.normal).dot(&normal) < SAME_NORMAL * normal.norm_squared()
        };
        if let Some(index) = touches.iter().position(looks_elsewhere) {
            return Err(MetrologyError::Misplaced {
                what: Self::WHAT,
                touch: index + 1,
                reason: "its face looks another way than that of the first touch".to_owned(),
            });
        }
        let largest = normal[normal.iamax()];
        Ok(normal * largest.signum())
    }

    fn place(&self, touch: &Touch) -> Vector3<f64> {
        vector3(if self.first_order {
            touch.nominal
        } else {
            touch.measured
        })
    }

    /// The slope as a vector along the face.
    pub fn slope(&self, unknowns: &[f64]) -> Vector3<f64> {
        let along = |(direction, slope): (&Vector3<f64>, &f64)| direction * *slope;
        self.directions.iter().zip(&unknowns[1..]).map(along).sum()
    }
}

impl<const WIDE: bool> Model for Flat<WIDE> {
    const WHAT: &'static str = if WIDE { "a plane" } else { "a shoulder" };

    fn unknowns(&self) -> usize {
        1 + self.directions.len()
    }

    fn misfit(&self, touch: &Touch, unknowns: &[f64]) -> f64 {
        let height = (vector3(touch.measured) - vector3(touch.nominal)).dot(&self.up);
        let modelled: f64 = self
            .row(touch, unknowns)
            .iter()
            .zip(unknowns)
            .map(|(slope, unknown)| slope * unknown)
            .sum();
        height - modelled
    }

    fn row(&self, touch: &Touch, _: &[f64]) -> Vec<f64> {
        let place = self.place(touch);
        let along = self.directions.iter().map(|direction| place.dot(direction));
        std::iter::once(1.0).chain(along).collect()
    }

    fn why_degenerate(&self, _: &[f64]) -> String {
        if WIDE {
            "they lie on one line".to_owned()
        } else {
            "they lie at one place along the shoulder".to_owned()
        }
    }
}
