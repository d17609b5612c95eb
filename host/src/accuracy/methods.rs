//! The estimators that run on the same edges.

use leadscrew::estimator::polynomial::{self, Answer};
use leadscrew::estimator::{EstimatorConfig, difference, gaussian};
use leadscrew::units::RangeError;

use super::columns::Column;

/// The fits whose 1σ is looked at: those of the columns first.
pub const FITS: [(u32, Answer); 6] = [
    (15, Answer::Centre),
    (7, Answer::Centre),
    (6, Answer::Newest),
    (8, Answer::Centre),
    (8, Answer::Newest),
    (15, Answer::Newest),
];

/// The fits, then counting, then the Gaussian-weighted average.
///
/// # Errors
/// Never with the values built in.
pub fn estimators() -> Result<Vec<EstimatorConfig>, RangeError> {
    let mut all = Vec::new();
    for (window, answer) in FITS {
        all.push(EstimatorConfig::Polynomial(polynomial::Config::new(
            window, answer,
        )?));
    }
    all.push(EstimatorConfig::Difference(difference::Config));
    all.push(EstimatorConfig::Gaussian(gaussian::Config::new(6.0, 25)?));
    Ok(all)
}

/// Place of counting among the estimators.
pub const COUNTING: usize = FITS.len();
/// Place of the Gaussian-weighted average among them.
pub const GAUSSIAN: usize = FITS.len() + 1;

/// The place of a column's estimator among the fits.
pub fn fit_of(column: &Column) -> usize {
    let is_its = |fit: &(u32, Answer)| *fit == (column.window, column.answer);
    FITS.iter().position(is_its).unwrap_or(0)
}
