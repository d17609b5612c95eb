//! The setting of a whole workpiece: the rigid displacement that brings planned places nearest to those found.

use nalgebra::Vector3;

use super::adjustment::{Model, adjust};
use super::error::MetrologyError;
use super::fitted::{Fitted, Settings};
use super::touch::{Touch, vector3};
use crate::setting_vector::{Component, SettingVector};

/// Fits the displacement of a workpiece to touches of any of its faces. `free` says which of [`Component::ALL`] are sought; the others
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
) -> Result<Fitted<SettingVector>, MetrologyError> {
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
        value: model.vector(&adjusted.unknowns),
        sigma: adjusted.has_sigma().then(|| model.vector(&sigmas)),
        covariance: adjusted.covariance,
        quality: adjusted.quality,
    })
}

/// Unknowns: the free components.
struct Setting {
    free: Vec<usize>,
}

impl Setting {
    fn vector(&self, unknowns: &[f64]) -> SettingVector {
        let mut all = [0.0; 6];
        for (&index, unknown) in self.free.iter().zip(unknowns) {
            all[index] = *unknown;
        }
        SettingVector::new(all)
    }
}

impl Model for Setting {
    const WHAT: &'static str = "a setting of the workpiece";

    fn unknowns(&self) -> usize {
        self.free.len()
    }

    fn misfit(&self, touch: &Touch, unknowns: &[f64]) -> f64 {
        let setting = self.vector(unknowns);
        let normal = setting.to_isometry().rotation * vector3(touch.normal);
        let planned = setting.moved(touch.nominal);
        normal.dot(&(vector3(touch.measured) - vector3(planned)))
    }

    fn row(&self, touch: &Touch, unknowns: &[f64]) -> Vec<f64> {
        let setting = self.vector(unknowns);
        let normal: Vector3<f64> = setting.to_isometry().rotation * vector3(touch.normal);
        // A small rotation more moves the face by ω·(r × n), r the place found.
        let lever = vector3(touch.measured).cross(&normal);
        let whole = [normal.x, normal.y, normal.z, lever.x, lever.y, lever.z];
        self.free.iter().map(|&index| whole[index]).collect()
    }

    fn why_degenerate(&self, shares: &[f64]) -> String {
        let letters = Component::ALL.map(Component::letter);
        let names: Vec<&str> = self.free.iter().map(|&index| letters[index]).collect();
        let open = Self::named(&names, shares).join(", ");
        format!("they leave {open} open: free only what they see, or touch more faces")
    }
}
