//! The drives that a loop has to bear, and how it does on them: margins, and moves on trial.

use super::SPREAD;
use super::report::AutotuneError;
use crate::controller::params::FrictionParams;
use crate::params::{AxisParams, ParamError};
use crate::tuning::check::{Trial, trial};
use crate::tuning::margins::{Loop, Margins};
use crate::tuning::model::DriveModel;
use crate::units::RangeError;

/// Way of a trial: long enough for the acceleration limit, mm.
const TRIAL_MM: f64 = 20.0;
/// Share of the feed at which corners are tried, as a lower gain costs speed.
const CORNER_FEED: f64 = 0.6;
/// Swing at the end of a rest from which on a trial has not come to rest, d.
const MOST_UNREST_D: f64 = 5.0;

/// The drives that the loop has to bear: the model, and its corners.
fn corners(model: &DriveModel) -> impl Iterator<Item = DriveModel> {
    let signs = [
        (0.0, 0.0),
        (-1.0, -1.0),
        (-1.0, 1.0),
        (1.0, -1.0),
        (1.0, 1.0),
    ];
    signs.into_iter().map(|(gain, period)| DriveModel {
        full_command_feed_mm_per_min: model.full_command_feed_mm_per_min * (1.0 + SPREAD * gain),
        natural_period_s: model.natural_period_s * (1.0 + SPREAD * period),
        ..*model
    })
}

/// Margins on the model, and the least over corners and densities.
///
/// # Errors
/// A parameter out of range.
pub fn margins(
    model: &DriveModel,
    params: &AxisParams,
    octaves: &[i32],
) -> Result<(Margins, Margins), ParamError> {
    let mut result: Option<(Margins, Margins)> = None;
    for octave in octaves {
        let judged = Loop::new(params, *octave)?;
        let own = judged.margins(model)?;
        let mut worst = own;
        for corner in corners(model).skip(1) {
            worst = worst.and(&judged.margins(&corner)?);
        }
        result = Some(match result {
            Some((nominal, least)) => (nominal.and(&own), least.and(&worst)),
            None => (own, worst),
        });
    }
    result.ok_or(ParamError::Range(RangeError {
        name: "densities of edges to judge at",
        value: 0.0,
        min: 1.0,
        max: 18.0,
    }))
}

/// Moves on the model and on its corners.
pub fn trials(model: &DriveModel, params: &AxisParams) -> Result<(Trial, Trial), AutotuneError> {
    let own = trial(params, model, TRIAL_MM)?;
    let mut worst = own;
    let mut slow = *params;
    slow.motion.max_feed_mm_per_min *= CORNER_FEED;
    for corner in corners(model).skip(1) {
        let smooth = DriveModel {
            delay_s: corner.delay_s,
            offset: corner.offset,
            resolution: corner.resolution,
            full_command_feed_mm_per_min: corner.full_command_feed_mm_per_min,
            max_acceleration_m_s2: corner.max_acceleration_m_s2,
            ..DriveModel::second_order(corner.natural_period_s, corner.damping)
        };
        slow.friction = FrictionParams::default();
        let seen = trial(&slow, &smooth, TRIAL_MM)?;
        worst = worst.or(&seen);
    }
    let supervisor = &params.supervisor;
    let warned_from_mm = supervisor.following_error_mm * supervisor.following_warning_share;
    let warned_from_d = warned_from_mm * params.motion.counts_per_mm;
    let is_behind = worst.peak_d > warned_from_d;
    let is_weak = params.motion.max_acceleration_m_s2 > model.max_acceleration_m_s2;
    let does_not_stand = worst.swing_d > MOST_UNREST_D || worst.fault.is_some();
    if does_not_stand && !(is_behind && is_weak) {
        return Err(AutotuneError::Trial(worst));
    }
    if is_behind {
        return Err(AutotuneError::Behind {
            peak_d: worst.peak_d,
            warned_from_d,
            drive_m_s2: model.max_acceleration_m_s2,
        });
    }
    Ok((own, worst))
}
