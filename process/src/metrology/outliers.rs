//! Touches that do not fit the others: flagged, never dropped unasked.
//!
//! Rosner's generalised test (1983) on standardised residuals, so that two bad touches do not hide each other. A residual is
//! compared with the stated 1σ as long as the other touches fit that, else with what their residuals give (then by Student).

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

use super::error::MetrologyError;
use super::solve::Solution;

/// Most touches that one feature can have flagged.
const MOST: usize = 20;
/// Two residuals nearer to each other than this part tell that something is wrong, not which touch.
const TIE: f64 = 1e-6;

/// Which touches fit; `solve` solves over some of them.
pub(super) fn search(
    whole: &Solution,
    stated: bool,
    level: f64,
    solve: impl Fn(&[bool]) -> Result<Solution, MetrologyError>,
) -> Vec<bool> {
    let mut kept = vec![true; whole.misfits.len()];
    let mut fitting = kept.clone();
    let mut latest: Option<Solution> = None;
    // Half the redundancy stays to judge by.
    for _ in 0..MOST.min(whole.freedom / 2) {
        let solution = latest.as_ref().unwrap_or(whole);
        let Some(suspect) = suspect(&solution.standardised, &kept) else {
            break;
        };
        let chance = chance(solution, suspect, stated, level);
        let tested = kept.iter().filter(|&&kept| kept).count();
        kept[suspect] = false;
        if chance < level / tested as f64 {
            fitting.clone_from(&kept);
        }
        match solve(&kept) {
            Ok(without) => latest = Some(without),
            Err(_) => break,
        }
    }
    fitting
}

/// The touch with the largest residual; none if two share it.
fn suspect(standardised: &[f64], kept: &[bool]) -> Option<usize> {
    let sizes = || {
        let size =
            |(index, (value, kept)): (usize, (&f64, &bool))| kept.then_some((index, value.abs()));
        standardised.iter().zip(kept).enumerate().filter_map(size)
    };
    let (index, largest) = sizes().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let shared = sizes().any(|(other, size)| other != index && size >= largest * (1.0 - TIE));
    (largest > 0.0 && !shared).then_some(index)
}

/// How probable a residual so large is at a good touch.
fn chance(solution: &Solution, suspect: usize, stated: bool, level: f64) -> f64 {
    let size = solution.standardised[suspect].abs();
    let freedom = solution.freedom - 1;
    let square_sum = (solution.square_sum - size * size).max(0.0);
    if stated && fits_stated(square_sum, freedom, level) {
        return Normal::new(0.0, 1.0).map_or(1.0, |normal| 2.0 * normal.sf(size));
    }
    let unit = (square_sum / freedom as f64).sqrt();
    StudentsT::new(0.0, 1.0, freedom as f64).map_or(1.0, |student| 2.0 * student.sf(size / unit))
}

/// Whether residuals over their stated 1σ are not larger than that explains.
pub(super) fn fits_stated(square_sum: f64, freedom: usize, level: f64) -> bool {
    ChiSquared::new(freedom as f64).is_ok_and(|squares| squares.sf(square_sum) >= level)
}
