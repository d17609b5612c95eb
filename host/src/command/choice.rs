//! An estimator as a command line chooses it: a name, and the parameters that it has.

use leadscrew::estimator::observer::{self, ObserverParams};
use leadscrew::estimator::polynomial::Answer;
use leadscrew::estimator::{EstimatorConfig, polynomial, simple};
use leadscrew::units::{AxisScale, RangeError};

use super::estimator;
use crate::error::CommandError;

/// Window of those that have one, unless stated; the paper's optimum.
const WINDOW: u32 = 15;

/// The estimator `name` with the parameters that are given for it.
///
/// # Errors
/// A name that is none, a parameter that the estimator does not have or that is out of range.
pub(super) fn chosen(
    name: &str,
    window: Option<u32>,
    answer: Option<&str>,
) -> Result<EstimatorConfig, CommandError> {
    let built_in = estimator(name)?;
    if answer.is_some() && name != "polynomial" {
        return Err(CommandError::Usage(format!(
            "--answer: {name} has no choice of the instant it answers for; leave it out or choose \
             --estimator polynomial"
        )));
    }
    if window.is_none() && answer.is_none() {
        return Ok(built_in);
    }
    let ticks = window.unwrap_or(WINDOW);
    let config = match name {
        "simple" => simple::Config::new(ticks).map(EstimatorConfig::Simple),
        "polynomial" => {
            let answer = match answer {
                Some("centre") => Answer::Centre,
                _ => Answer::Newest,
            };
            polynomial::Config::new(ticks, answer).map(EstimatorConfig::Polynomial)
        }
        _ => {
            return Err(CommandError::Usage(format!(
                "--window {ticks}: {name} is not set by a window; leave it out or choose --estimator simple or \
                 polynomial"
            )));
        }
    };
    config.map_err(|RangeError { min, max, .. }| {
        CommandError::Usage(format!(
            "--window {ticks} is out of range: {name} takes {min} to {max} ticks"
        ))
    })
}

/// The estimator at a control rate: an observer's noise of motion is physical, so it is another one at another rate.
///
/// # Errors
/// A rate at which it cannot be tuned.
pub(super) fn at_rate(
    config: EstimatorConfig,
    tick_hz: f64,
) -> Result<EstimatorConfig, CommandError> {
    if !matches!(config, EstimatorConfig::Observer(_)) {
        return Ok(config);
    }
    let tuned = AxisScale::new(REFERENCE_COUNTS_PER_MM, tick_hz)
        .and_then(|scale| observer::Config::new(&ObserverParams::default(), scale));
    tuned
        .map(EstimatorConfig::Observer)
        .map_err(|error| CommandError::Usage(format!("--tick-hz {tick_hz}: the observer: {error}")))
}

/// Counts per millimetre of the reference machine, whose motion the observer expects.
const REFERENCE_COUNTS_PER_MM: f64 = 1000.0;
