//! What is known of a part: values for tables, JSON and pictures.

use serde::Serialize;

use crate::metrology::SigmaFrom;
use crate::metrology::fitted::Quality;

/// All features, in order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// A feature each.
    pub features: Vec<FeatureReport>,
}

/// A feature.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FeatureReport {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: &'static str,
    /// What was found.
    pub values: Vec<Value>,
    /// Of every touch; empty where it is computed from other features.
    pub touches: Vec<TouchReport>,
    /// Touches less unknowns.
    pub freedom: Option<usize>,
    /// Where its 1σ come from.
    pub sigma_from: Option<SigmaFrom>,
    /// Rms of the residuals over the stated 1σ.
    pub over_stated: Option<f64>,
    /// What a reader must know.
    pub notes: Vec<String>,
}

/// A value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Value {
    /// What it is.
    pub quantity: String,
    /// Its unit: mm, rad, mm/mm or none.
    pub unit: &'static str,
    /// The value.
    pub value: f64,
    /// Its 1σ.
    pub sigma: Option<f64>,
}

/// A touch of a feature.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TouchReport {
    /// Its point.
    pub point: String,
    /// Measured less planned along the normal, mm, positive out of the material.
    pub deviation_mm: f64,
    /// Measured less fitted, mm.
    pub residual_mm: f64,
    /// Over its own 1σ.
    pub standardised: Option<f64>,
    /// Whether it does not fit the others.
    pub is_outlier: bool,
    /// Whether it was left out for that.
    pub is_left_out: bool,
}

impl FeatureReport {
    /// A feature without touches.
    pub(super) fn new(name: &str, kind: &'static str) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            values: Vec::new(),
            touches: Vec::new(),
            freedom: None,
            sigma_from: None,
            over_stated: None,
            notes: Vec::new(),
        }
    }

    pub(super) fn push(
        &mut self,
        quantity: impl Into<String>,
        unit: &'static str,
        value: f64,
        sigma: Option<f64>,
    ) {
        self.values.push(Value {
            quantity: quantity.into(),
            unit,
            // A zero has no sign.
            value: value + 0.0,
            sigma,
        });
    }

    /// What a fit says of its touches, by points and deviations.
    pub(super) fn describe(
        &mut self,
        quality: &Quality,
        touches: impl Iterator<Item = (String, f64)>,
    ) {
        self.freedom = Some(quality.freedom);
        self.sigma_from = quality.sigma_from;
        self.over_stated = quality.over_stated;
        for ((point, deviation_mm), residual) in touches.zip(&quality.residuals) {
            self.touches.push(TouchReport {
                point,
                deviation_mm,
                residual_mm: residual.mm,
                standardised: residual.standardised,
                is_outlier: residual.is_outlier,
                is_left_out: residual.is_outlier && quality.left_out,
            });
        }
        if quality.sigma_from == Some(SigmaFrom::Residuals) && quality.over_stated.is_some() {
            self.notes.push("the residuals are larger than the stated 1σ explains: a bad touch, or an error of form".to_owned());
        }
        if quality.freedom == 0 {
            self.notes
                .push("no more touches than unknowns: nothing checks them".to_owned());
        }
    }
}
