//! The estimators that are tried, each with a range of its parameter.

use leadscrew::estimator::polynomial::Answer;
use leadscrew::estimator::{EstimatorConfig, exponential, gaussian, polynomial, simple};
use leadscrew::units::RangeError;

/// An estimator with one value of its parameter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) config: EstimatorConfig,
    /// Symbol of the parameter and its value; `None` for an estimator that is tried as it is built in.
    pub(super) parameter: Option<(&'static str, f64)>,
}

impl Candidate {
    const fn new(config: EstimatorConfig, symbol: &'static str, value: f64) -> Self {
        Self {
            config,
            parameter: Some((symbol, value)),
        }
    }
}

/// Windows, ticks: each one where it matters, wider apart where the lag is beyond use.
const WINDOWS: [u32; 20] = [
    2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 20, 24, 32, 48, 64,
];

/// Hundredths of α; below the last one a filter takes longer to settle than most captures last.
const ALPHAS: [u8; 18] = [
    60, 50, 40, 36, 32, 28, 26, 24, 22, 20, 18, 17, 16, 15, 14, 12, 9, 6,
];

/// All candidates, estimator by estimator, each in order of a growing lag.
///
/// # Errors
/// A parameter out of range (not with the values built in).
pub(super) fn candidates() -> Result<Vec<Candidate>, RangeError> {
    let mut all = Vec::new();
    for name in EstimatorConfig::NAMES {
        match *name {
            "exponential" => {
                for hundredths in ALPHAS {
                    let alpha = f64::from(hundredths) / 100.0;
                    let config = EstimatorConfig::Exponential(exponential::Config::new(alpha)?);
                    all.push(Candidate::new(config, "α", alpha));
                }
            }
            "simple" => {
                for window in WINDOWS {
                    let config = EstimatorConfig::Simple(simple::Config::new(window)?);
                    all.push(Candidate::new(config, "N", f64::from(window)));
                }
            }
            "gaussian" => {
                for halves in 1..=24 {
                    let sigma = f64::from(halves) / 2.0;
                    // As long as the paper's: 25 samples for σ = 6.
                    let window = (4.0 * sigma) as u32 + 1;
                    let config = EstimatorConfig::Gaussian(gaussian::Config::new(sigma, window)?);
                    all.push(Candidate::new(config, "σ", sigma));
                }
            }
            "polynomial" => {
                // The acceleration is the same whatever the instant of the other two.
                for window in WINDOWS.into_iter().filter(|window| *window >= 4) {
                    let config = polynomial::Config::new(window, Answer::Newest)?;
                    let config = EstimatorConfig::Polynomial(config);
                    all.push(Candidate::new(config, "W", f64::from(window)));
                }
            }
            other => {
                let built_in = EstimatorConfig::by_name(other)?;
                all.extend(built_in.map(|config| Candidate {
                    config,
                    parameter: None,
                }));
            }
        }
    }
    Ok(all)
}
