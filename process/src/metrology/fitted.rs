//! What a fit gives: values, their 1σ, and what the touches say about it.

use nalgebra::DMatrix;
use serde::Serialize;

/// How to fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Probability to flag any touch of a feature though none is wrong: 0 to 1, not included.
    pub level: f64,
    /// Whether flagged touches are left out of the result. They stay among the residuals.
    pub without_outliers: bool,
    /// Whether round features are taken to first order in the deviations, as P4 does, which drops (transverse
    /// deviation)² / diameter; otherwise exactly.
    pub first_order: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            level: 0.01,
            without_outliers: false,
            first_order: false,
        }
    }
}

/// Where a 1σ comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum SigmaFrom {
    /// The stated 1σ of the touches, which the residuals do not contradict.
    Stated,
    /// The residuals: no 1σ is stated, or they are larger than it explains.
    Residuals,
}

impl SigmaFrom {
    /// `stated` or `residuals`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stated => "stated",
            Self::Residuals => "residuals",
        }
    }
}

/// What is left of a touch.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Residual {
    /// Measured less fitted, mm: positive along the axis at flat features, away from the axis at round ones.
    pub mm: f64,
    /// The residual over its own 1σ; none where nothing is redundant.
    pub standardised: Option<f64>,
    /// Whether it does not fit the others at the stated level.
    pub is_outlier: bool,
}

/// What the touches say about a fit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quality {
    /// Of every touch, in the order given.
    pub residuals: Vec<Residual>,
    /// Touches less unknowns.
    pub freedom: usize,
    /// Where the 1σ comes from; none if there is neither a stated one nor redundancy.
    pub sigma_from: Option<SigmaFrom>,
    /// Rms of the residuals over what is stated, about 1 if all is well; none without both.
    pub over_stated: Option<f64>,
    /// Whether flagged touches were left out.
    pub left_out: bool,
}

impl Quality {
    /// Indices of the touches that are flagged.
    #[must_use]
    pub fn outliers(&self) -> Vec<usize> {
        let flagged = |(index, residual): (usize, &Residual)| residual.is_outlier.then_some(index);
        self.residuals
            .iter()
            .enumerate()
            .filter_map(flagged)
            .collect()
    }

    /// Greatest less least residual of the touches that count, mm.
    #[must_use]
    pub fn peak_to_valley_mm(&self) -> f64 {
        let counts = |residual: &&Residual| !(self.left_out && residual.is_outlier);
        let counted = || self.residuals.iter().filter(counts).map(|one| one.mm);
        let (least, greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        let range = counted().fold(greatest, f64::max) - counted().fold(least, f64::min);
        range.max(0.0)
    }
}

/// A feature as fitted.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted<T> {
    /// The values.
    pub value: T,
    /// 1σ of each value; none if there is neither a stated 1σ nor redundancy.
    pub sigma: Option<T>,
    /// Covariance of the unknowns in the order that the feature states; empty where there is no 1σ.
    pub covariance: DMatrix<f64>,
    /// Residuals and what follows from them.
    pub quality: Quality,
}
