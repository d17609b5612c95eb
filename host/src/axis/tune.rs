//! From an identified drive to the parameters of the loop on an axis, tried and taken back if they are worse.

use std::f64::consts::TAU;

use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer::{Config, ObserverParams};
use leadscrew::params::{AxisParams, MotionParams};
use leadscrew::settings::Settings;
use leadscrew::tuning::DriveModel;
use leadscrew::tuning::autotune::{EstimatorChoice, Report, autotune, observer_on};
use leadscrew_client::Axis;

use super::calm::switched_off;
use super::settings::{Change, Setting};
use super::{Follows, ProcedureError, TestMove, apply, differences, follow};
use crate::commissioning::feed_within;

/// What is offered.
#[derive(Clone, Debug)]
pub struct Tuning {
    /// The drive that it is for.
    pub model: DriveModel,
    /// All settings as they are to be.
    pub settings: Settings,
    /// What of them changes.
    pub changes: Vec<Change>,
    /// What the loop is worth on the model.
    pub report: Report,
}

/// What the observer counts on: with a map, what a learned map leaves; without one, the errors of the encoder as its
/// section states them.
#[must_use]
pub fn counts_on(settings: &Settings, has_map: bool) -> ObserverParams {
    let default = ObserverParams::default();
    let AxisParams {
        encoder, motion, ..
    } = &settings.axis;
    if has_map {
        return default;
    }
    let turn_d = if motion.counts_per_revolution > 0.0 {
        motion.counts_per_revolution
    } else {
        // Without an index: no wave longer than the window of the experiments is known of.
        10.0 * motion.counts_per_mm
    };
    ObserverParams {
        edge_noise_d: encoder.edge_noise_d.hypot(encoder.placement_d).max(0.002),
        time_noise_s: encoder.time_noise_s.min(1e-5),
        map_residual_d: (encoder.slope * turn_d / TAU).min(10.0),
        map_wave_mm: turn_d / motion.counts_per_mm,
        ..default
    }
}

/// What is to be set on an axis with `settings` for the drive `model`; takes some seconds, in which the lease is kept.
///
/// # Errors
/// [`ProcedureError::NotTuned`]
pub fn tune(
    axis: &mut Axis,
    settings: &Settings,
    model: &DriveModel,
    max_feed: f64,
    has_map: bool,
) -> Result<Tuning, ProcedureError> {
    let counts_on = counts_on(settings, has_map);
    let base = AxisParams {
        motion: MotionParams {
            max_feed_mm_per_min: feed_within(model, max_feed),
            ..settings.axis.motion
        },
        estimator: EstimatorConfig::Observer(Config::of_16k20f3()?),
        ..settings.axis
    };
    let choice = EstimatorChoice::Observer(counts_on);
    let tuned = axis.keep_alive_while(|| autotune(model, &base, &choice))?;
    let (axis, report) = tuned.map_err(ProcedureError::NotTuned)?;
    let mut offered = Settings {
        axis,
        observer: observer_on(&counts_on, model),
    };
    offered.validate()?;
    Ok(Tuning {
        model: *model,
        changes: differences(settings, &offered),
        settings: offered,
        report,
    })
}

impl Tuning {
    /// Sets what is offered and tries it by a test move. Where the axis does not get through it, or follows worse than
    /// `before`, all is set as it was. The drive is off afterwards.
    ///
    /// # Errors
    /// [`ProcedureError::Fails`], [`ProcedureError::Worse`], those of the axis.
    pub fn try_on(
        &self,
        axis: &mut Axis,
        test: &TestMove,
        before: Option<&Follows>,
    ) -> Result<Follows, ProcedureError> {
        apply(axis, &self.changes)?;
        let tried = tried(axis, &self.settings, test);
        let outcome = match (tried, before) {
            (Err(ProcedureError::Axis(cause)), _) if !cause.is_lost() => {
                Err(ProcedureError::Fails { cause })
            }
            (Ok(after), Some(before)) if after.peak_d > before.peak_d.max(WORTH_D) => {
                Err(ProcedureError::Worse {
                    before_d: before.peak_d,
                    after_d: after.peak_d,
                })
            }
            (tried, _) => tried,
        };
        if outcome.is_err() {
            self.take_back(axis)?;
        }
        outcome
    }

    /// Sets all as it was before.
    ///
    /// # Errors
    /// Those of the axis.
    pub fn take_back(&self, axis: &mut Axis) -> Result<(), ProcedureError> {
        let swapped = |change: &Change| Change {
            before: change.after,
            after: change.before,
            ..change.clone()
        };
        let back: Vec<_> = self.changes.iter().map(swapped).collect();
        Ok(apply(axis, &back)?)
    }
}

/// Following errors below this are not worse than others below it, d.
const WORTH_D: f64 = 5.0;

/// Enables the axis, makes the move, and switches it off.
pub(super) fn tried(
    axis: &mut Axis,
    settings: &Settings,
    test: &TestMove,
) -> Result<Follows, ProcedureError> {
    super::calm::made_ready(axis)?;
    let followed = follow(axis, settings, test).map_err(ProcedureError::from);
    let off = switched_off(axis, followed);
    if off.is_err() && axis.status()?.fault_number != 0 {
        axis.clear_fault()?;
    }
    off
}

/// True of an axis whose loop holds it.
pub(super) fn has_loop(settings: &Settings) -> bool {
    settings.axis.controller.position_gain_per_s > 0.0
}

/// How the axis follows now; none where it has no loop.
///
/// # Errors
/// Those of the axis.
pub fn followed_now(
    axis: &mut Axis,
    settings: &Settings,
    test: &TestMove,
) -> Result<Option<Follows>, ProcedureError> {
    if has_loop(settings) {
        tried(axis, settings, test).map(Some)
    } else {
        Ok(None)
    }
}

/// A change of one number.
pub(super) fn number_change(
    name: &str,
    unit: &'static str,
    before: f64,
    after: f64,
) -> Option<Change> {
    (before != after).then(|| Change {
        name: name.to_owned(),
        unit,
        before: Setting::Number(before),
        after: Setting::Number(after),
    })
}
