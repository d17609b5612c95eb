//! Weighted least squares on touches: the one way in which every feature is fitted.

use nalgebra::DMatrix;

use super::error::MetrologyError;
use super::fitted::{Quality, Residual, Settings, SigmaFrom};
use super::outliers;
use super::solve::{Solution, solve};
use super::touch::Touch;

/// Unknowns that share this part of a direction nothing determines are named.
const NAMED_PART: f64 = 0.3;

/// A feature as equations of its touches.
pub(crate) trait Model {
    /// What messages call it.
    const WHAT: &'static str;

    /// Number of unknowns, which start at 0.
    fn unknowns(&self) -> usize;

    /// Measured less modelled, mm, of one touch.
    fn misfit(&self, touch: &Touch, unknowns: &[f64]) -> f64;

    /// How the modelled value grows with each unknown.
    fn row(&self, touch: &Touch, unknowns: &[f64]) -> Vec<f64>;

    /// Why the touches may not determine the unknowns, by the shares of these in the worst direction.
    fn why_degenerate(&self, shares: &[f64]) -> String;

    /// The unknowns with a large share in a direction.
    fn named<'a>(names: &[&'a str], shares: &[f64]) -> Vec<&'a str> {
        let large = |(name, share): (&&'a str, &f64)| (share.abs() >= NAMED_PART).then_some(*name);
        names.iter().zip(shares).filter_map(large).collect()
    }
}

/// The unknowns as found.
pub(crate) struct Adjusted {
    pub unknowns: Vec<f64>,
    /// Empty without any 1σ.
    pub covariance: DMatrix<f64>,
    pub quality: Quality,
}

impl Adjusted {
    /// 1σ of unknown `index`.
    pub fn sigma(&self, index: usize) -> Option<f64> {
        let variance = self.covariance.get((index, index))?;
        Some(variance.sqrt())
    }

    /// Whether there is any 1σ.
    pub fn has_sigma(&self) -> bool {
        self.quality.sigma_from.is_some()
    }
}

/// Fits a model to touches.
pub(crate) fn adjust<M: Model>(
    model: &M,
    touches: &[Touch],
    settings: &Settings,
) -> Result<Adjusted, MetrologyError> {
    let stated = check::<M>(model, touches, settings)?;
    let all = vec![true; touches.len()];
    let whole = solve(model, touches, &all)?;
    let solve_some = |kept: &[bool]| solve(model, touches, kept);
    let kept = outliers::search(&whole, stated, settings.level, solve_some);
    let left_out = settings.without_outliers && kept.contains(&false);
    let solution = if left_out {
        solve(model, touches, &kept)?
    } else {
        whole
    };
    let scale = scale(&solution, stated, settings.level);
    let quality = quality(&solution, &kept, left_out, stated, scale);
    Ok(Adjusted {
        covariance: match scale {
            (variance_factor, Some(_)) => solution.cofactor * variance_factor,
            (_, None) => DMatrix::zeros(0, 0),
        },
        unknowns: solution.unknowns,
        quality,
    })
}

/// Whether a 1σ is stated.
fn check<M: Model>(
    model: &M,
    touches: &[Touch],
    settings: &Settings,
) -> Result<bool, MetrologyError> {
    if let Some(index) = touches.iter().position(|touch| !touch.is_usable()) {
        return Err(MetrologyError::Misplaced {
            what: M::WHAT,
            touch: index + 1,
            reason: "its numbers must be finite, its 1σ greater than 0".to_owned(),
        });
    }
    if touches.len() < model.unknowns() {
        return Err(MetrologyError::TooFew {
            what: M::WHAT,
            needed: model.unknowns(),
            found: touches.len(),
        });
    }
    if !(settings.level > 0.0 && settings.level < 1.0) {
        return Err(MetrologyError::Range {
            name: "level",
            value: settings.level,
            unit: "",
            allowed: "more than 0, less than 1".to_owned(),
        });
    }
    let with = touches
        .iter()
        .filter(|touch| touch.sigma_mm.is_some())
        .count();
    if with != 0 && with != touches.len() {
        return Err(MetrologyError::MixedSigma {
            what: M::WHAT,
            with,
            all: touches.len(),
        });
    }
    Ok(with != 0)
}

/// The factor of the covariance, and where 1σ comes from.
fn scale(solution: &Solution, stated: bool, level: f64) -> (f64, Option<SigmaFrom>) {
    let Solution {
        freedom,
        square_sum,
        ..
    } = *solution;
    let from_residuals = square_sum / freedom.max(1) as f64;
    match (stated, freedom) {
        (true, 0) => (1.0, Some(SigmaFrom::Stated)),
        (true, _) if outliers::fits_stated(square_sum, freedom, level) => {
            (1.0, Some(SigmaFrom::Stated))
        }
        (false, 0) => (1.0, None),
        _ => (from_residuals, Some(SigmaFrom::Residuals)),
    }
}

fn quality(
    solution: &Solution,
    kept: &[bool],
    left_out: bool,
    stated: bool,
    (variance_factor, sigma_from): (f64, Option<SigmaFrom>),
) -> Quality {
    let is_redundant = solution.freedom > 0;
    let unit = variance_factor.sqrt();
    let residual = |((&mm, &standardised), &kept): ((&f64, &f64), &bool)| Residual {
        mm,
        standardised: (is_redundant && unit > 0.0).then(|| standardised / unit),
        is_outlier: !kept,
    };
    let touches = solution.misfits.iter().zip(&solution.standardised);
    Quality {
        residuals: touches.zip(kept).map(residual).collect(),
        freedom: solution.freedom,
        sigma_from,
        over_stated: (stated && is_redundant)
            .then(|| (solution.square_sum / solution.freedom as f64).sqrt()),
        left_out,
    }
}
