//! The search: of each damping the fastest loop that keeps its margins, and of these the one that follows best.

use super::corners::{margins, trials};
use super::prepare::calm_params;
use super::report::AutotuneError;
use super::{LEAST_GAIN_DB, LEAST_PHASE_DEG};
use crate::controller::params::ControllerParams;
use crate::params::{AxisParams, ParamError};
use crate::tuning::check::Trial;
use crate::tuning::margins::Margins;
use crate::tuning::model::DriveModel;
use crate::units::RangeError;

/// Octaves of edges a tick at which the loop in motion is judged.
pub const OCTAVES: [i32; 3] = [1, 4, 7];
/// Dampings of the pole pairs that are tried.
const DAMPINGS: [f64; 4] = [1.0, 0.85, 0.7, 0.6];
/// Slowest and fastest radius that is looked at, of the drive's natural frequency.
const RADII: (f64, f64) = (0.3, 8.0);
/// Step of the search.
const STEP: f64 = 1.15;
/// Halvings of the last step.
const HALVINGS: u32 = 4;
/// Radius of the calm poles, of the drive's natural frequency. They are slow, but with a velocity link that is not negative
/// (from 1/√6 on): it would take stiffness from the drive, which friction that falls with speed needs. Of 0.43 to 0.66 this
/// crept best on the 16K20F3.
const CALM_SHARE: f64 = 0.49;

/// `feedforward` with the gains of `feedback`.
fn with_feedback(feedforward: &ControllerParams, feedback: ControllerParams) -> ControllerParams {
    ControllerParams {
        position_gain_per_s: feedback.position_gain_per_s,
        integral_gain_per_s2: feedback.integral_gain_per_s2,
        derivative_gain: 0.0,
        velocity_gain: feedback.velocity_gain,
        acceleration_gain_s: feedback.acceleration_gain_s,
        ..*feedforward
    }
}

/// A loop that may be offered.
pub struct Chosen {
    pub params: AxisParams,
    pub bandwidth: f64,
    pub damping: f64,
    pub calm: f64,
    pub trial: Trial,
    pub corner_trial: Trial,
}

/// Of the fastest loops by their dampings, that which follows best on the corners.
pub fn best(model: &DriveModel, prepared: &AxisParams) -> Result<Chosen, AutotuneError> {
    let mut chosen: Option<Chosen> = None;
    let mut refused = None;
    for damping in DAMPINGS {
        match candidate(model, prepared, damping) {
            Ok(candidate) => {
                let cost = |one: &Chosen| one.corner_trial.peak_d + one.corner_trial.standing_d;
                let is_better = |other: &Chosen| cost(&candidate) < cost(other);
                if chosen.as_ref().is_none_or(is_better) {
                    chosen = Some(candidate);
                }
            }
            // What a trial says is of more use than that another damping has no margin.
            Err(error @ (AutotuneError::Trial(_) | AutotuneError::Behind { .. })) => {
                refused = Some(error);
            }
            Err(error @ AutotuneError::NoMargin(_)) => refused = refused.or(Some(error)),
            Err(error) => return Err(error),
        }
    }
    chosen.ok_or_else(|| {
        refused.unwrap_or(AutotuneError::Param(ParamError::Range(RangeError {
            name: "dampings to try",
            value: 0.0,
            min: 1.0,
            max: 4.0,
        })))
    })
}

/// The fastest loop with that damping, which keeps its margins and came to rest on trial.
fn candidate(
    model: &DriveModel,
    prepared: &AxisParams,
    damping: f64,
) -> Result<Chosen, AutotuneError> {
    let bandwidth = fastest(model, prepared, damping)?;
    let params = placed(model, prepared, bandwidth, damping)?;
    let (trial, corner_trial) = trials(model, &params)?;
    Ok(Chosen {
        params,
        bandwidth,
        damping,
        calm: calm_radius(model, bandwidth),
        trial,
        corner_trial,
    })
}

/// `prepared` with two equal pairs of poles at `radius` rad/s with `damping`, and the calm gains. Neither its margins nor
/// how it comes to rest is looked at.
///
/// # Errors
/// A figure out of range.
pub fn placed(
    model: &DriveModel,
    prepared: &AxisParams,
    radius: f64,
    damping: f64,
) -> Result<AxisParams, AutotuneError> {
    let feedback = model.place_pole_pairs(radius, damping)?;
    let mut params = *prepared;
    params.controller = with_feedback(&prepared.controller, feedback);
    params.calm = calm_params(model, prepared, calm_radius(model, radius))?;
    Ok(params)
}

fn calm_radius(model: &DriveModel, bandwidth: f64) -> f64 {
    (CALM_SHARE * natural_frequency(model)).min(bandwidth)
}

fn natural_frequency(model: &DriveModel) -> f64 {
    core::f64::consts::TAU / model.natural_period_s
}

/// The largest radius at which the loop with that damping keeps its margins, rad/s.
fn fastest(model: &DriveModel, prepared: &AxisParams, damping: f64) -> Result<f64, AutotuneError> {
    let mut params = *prepared;
    let mut slowest = Margins::WIDEST;
    let mut keeps = |radius: f64| -> Result<bool, AutotuneError> {
        let feedback = model.place_pole_pairs(radius, damping)?;
        params.controller = with_feedback(&prepared.controller, feedback);
        let (_, worst) = margins(model, &params, &OCTAVES)?;
        slowest = worst;
        Ok(suffice(&worst, LEAST_GAIN_DB, LEAST_PHASE_DEG))
    };
    let found = largest(natural_frequency(model), &mut keeps)?;
    found.ok_or(AutotuneError::NoMargin(slowest))
}

/// The largest radius, within [`RADII`] of `omega`, that `keeps` what is asked for, if there is one: from the fastest down by steps, then by halving the
/// last of them. A slow loop need not keep it either: with links below zero it lives on what the drive has to give.
fn largest(
    omega: f64,
    keeps: &mut dyn FnMut(f64) -> Result<bool, AutotuneError>,
) -> Result<Option<f64>, AutotuneError> {
    let mut high = RADII.1 * omega;
    let mut low = high;
    while !keeps(low)? {
        (high, low) = (low, low / STEP);
        if low < RADII.0 * omega {
            return Ok(None);
        }
    }
    for _ in 0..HALVINGS {
        let middle = libm::sqrt(low * high);
        if keeps(middle)? {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(Some(low))
}

fn suffice(margins: &Margins, gain_db: f64, phase_deg: f64) -> bool {
    margins.gain_db >= gain_db && margins.reserve_db >= gain_db && margins.phase_deg >= phase_deg
}
