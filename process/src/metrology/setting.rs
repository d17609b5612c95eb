//! The setting of a whole workpiece: the rigid displacement that brings planned places nearest to those found.

use nalgebra::{Rotation3, Vector3};

use super::adjustment::{Model, adjust};
use super::error::MetrologyError;
use super::fitted::{Fitted, Settings};
use super::touch::{Touch, vector3};

/// The components of a setting vector, in order.
pub const COMPONENTS: [&str; 6] = ["a", "b", "c", "λ", "β", "γ"];

/// A rigid displacement, the setting vector ω of P4: first turned about the origin, then moved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Displacement {
    /// a, b, c: how far the origin is moved, mm.
    pub shift_mm: [f64; 3],
    /// λ, β, γ: rotation vector, rad. Its direction is the axis, its length the angle.
    pub rotation: [f64; 3],
}

impl Displacement {
    /// Where a place comes to lie, exactly.
    #[must_use]
    pub fn moved(&self, place: [f64; 3]) -> [f64; 3] {
        (self.turn() * vector3(place) + vector3(self.shift_mm)).into()
    }

    /// How far a place is moved, mm. A tool that is to follow a workpiece set like this is moved by as much; where instead a
    /// machine has cut a workpiece like this, its correction is the negative, K = −Δ.
    #[must_use]
    pub fn at(&self, place: [f64; 3]) -> [f64; 3] {
        (vector3(self.moved(place)) - vector3(place)).into()
    }

    fn turn(&self) -> Rotation3<f64> {
        Rotation3::new(vector3(self.rotation))
    }
}

/// Fits the displacement of a workpiece to touches of any of its faces. `free` says which of [`COMPONENTS`] are sought; the others
/// are 0. The covariance is that of the free ones, in order.
///
/// A touch stands for the tangent plane at its planned place: at holes that drops (deviation across)² / diameter.
///
/// # Errors
/// Touches that do not determine what is free: the message names it.
pub fn fit(
    touches: &[Touch],
    free: [bool; 6],
    settings: &Settings,
) -> Result<Fitted<Displacement>, MetrologyError> {
    let model = Setting {
        free: (0..6).filter(|&index| free[index]).collect(),
    };
    if model.free.is_empty() {
        return Err(MetrologyError::TooFew {
            what: Setting::WHAT,
            needed: 1,
            found: 0,
        });
    }
    let adjusted = adjust(&model, touches, settings)?;
    let sigmas: Vec<f64> = (0..model.free.len())
        .map(|index| adjusted.sigma(index).unwrap_or_default())
        .collect();
    Ok(Fitted {
        value: model.displacement(&adjusted.unknowns),
        sigma: adjusted.has_sigma().then(|| model.displacement(&sigmas)),
        covariance: adjusted.covariance,
        quality: adjusted.quality,
    })
}

/// Unknowns: the free components.
struct Setting {
    free: Vec<usize>,
}

impl Setting {
    fn displacement(&self, unknowns: &[f64]) -> Displacement {
        let mut all = [0.0; 6];
        for (&index, unknown) in self.free.iter().zip(unknowns) {
            all[index] = *unknown;
        }
        let [a, b, c, lambda, beta, gamma] = all;
        Displacement {
            shift_mm: [a, b, c],
            rotation: [lambda, beta, gamma],
        }
    }
}

impl Model for Setting {
    const WHAT: &'static str = "a setting of the workpiece";

    fn unknowns(&self) -> usize {
        self.free.len()
    }

    fn misfit(&self, touch: &Touch, unknowns: &[f64]) -> f64 {
        let displacement = self.displacement(unknowns);
        let normal = displacement.turn() * vector3(touch.normal);
        let planned = displacement.moved(touch.nominal);
        normal.dot(&(vector3(touch.measured) - vector3(planned)))
    }

    fn row(&self, touch: &Touch, unknowns: &[f64]) -> Vec<f64> {
        let displacement = self.displacement(unknowns);
        let normal: Vector3<f64> = displacement.turn() * vector3(touch.normal);
        // A small rotation more moves the face by ω·(r × n), r the place found.
        let lever = vector3(touch.measured).cross(&normal);
        let whole = [normal.x, normal.y, normal.z, lever.x, lever.y, lever.z];
        self.free.iter().map(|&index| whole[index]).collect()
    }

    fn why_degenerate(&self, shares: &[f64]) -> String {
        let names: Vec<&str> = self.free.iter().map(|&index| COMPONENTS[index]).collect();
        let open = Self::named(&names, shares).join(", ");
        format!("they leave {open} open: free only what they see, or touch more faces")
    }
}
