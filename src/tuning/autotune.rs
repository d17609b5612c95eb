//! From a model of the drive to the parameters of the loop.
//!
//! **Feedforward** is the inverse of the model, ahead by its delay and half a tick of hold, with its offset, friction and
//! dead time. **Feedback** puts two equal pairs of poles at a radius r with a damping; the radius is the largest, by bisection for each
//! of a few dampings, at which every drive within ± 20 % of gain and of period keeps the margins, at every density of
//! edges from 2 in a tick on; of the dampings that is taken whose corners follow best on trial. The drive's delay is
//! predicted over. **Calm gains**, for rest and creep, are as slow as leaves the drive its own stiffness.
//! What was found is [tried](super::check) on the model, and on the corners without friction, before it is offered.

use core::fmt;

use super::check::{Trial, trial};
use super::margins::{Loop, Margins};
use super::model::DriveModel;
use crate::controller::filter::MAX_TAPS;
use crate::controller::params::{CalmParams, ControllerParams, FilterParams, FrictionParams};
use crate::estimator::observer::{self, ObserverParams};
use crate::estimator::paths::{Paths, PositionFeedback};
use crate::estimator::{EstimatorConfig, Lags};
use crate::parameter_table::ParameterTable;
use crate::params::{AxisParams, MotionParams, ParamError};
use crate::units::{AxisScale, Lag, RangeError};

/// Least gain margin at every corner, dB.
pub const LEAST_GAIN_DB: f64 = 6.0;
/// Least phase margin at every corner, degrees.
pub const LEAST_PHASE_DEG: f64 = 30.0;
/// Share by which gain and period may be off, in any combination.
pub const SPREAD: f64 = 0.2;

/// The estimator that is to be in the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "one at a time, outside the tick")]
pub enum EstimatorChoice {
    /// An observer; what the drive is like comes from the model.
    Observer(ObserverParams),
    /// Any other as it is.
    AsIs(EstimatorConfig),
}

/// Why nothing can be offered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AutotuneError {
    /// A parameter, a figure of the model, or a feed too near to the full-command speed.
    Param(ParamError),
    /// No bandwidth keeps the margins; those of the slowest loop.
    NoMargin(Margins),
    /// The trial on the model does not come to rest or oscillates.
    Trial(Trial),
}

impl<E: Into<ParamError>> From<E> for AutotuneError {
    fn from(error: E) -> Self {
        Self::Param(error.into())
    }
}

impl fmt::Display for AutotuneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Param(error) => error.fmt(f),
            Self::NoMargin(margins) => write!(
                f,
                "no loop keeps {LEAST_GAIN_DB} dB and {LEAST_PHASE_DEG}° with this estimator and delay: the slowest one has \
                 {:.1} dB and {:.0}°; shorten the delay or choose an estimator with less lag",
                margins.gain_db, margins.phase_deg
            ),
            Self::Trial(trial) => write!(
                f,
                "the loop does not settle on the model: {:.1} d at rest, swinging by {:.1} d; identify the drive again",
                trial.standing_d, trial.swing_d
            ),
        }
    }
}

impl core::error::Error for AutotuneError {}

/// What was found, and how good it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// Radius of the poles, rad/s.
    pub bandwidth_rad_per_s: f64,
    /// Their damping.
    pub damping: f64,
    /// Radius of the poles at rest and creep, rad/s.
    pub calm_rad_per_s: f64,
    /// Margins on the model.
    pub nominal: Margins,
    /// Least margins over all corners and densities.
    pub worst: Margins,
    /// A move on the model with all its imperfections.
    pub trial: Trial,
    /// The worst of moves on the corners.
    pub corner_trial: Trial,
}

/// Octaves of edges a tick at which the loop in motion is judged.
const OCTAVES: [i32; 3] = [1, 4, 7];
/// Dampings of the pole pairs that are tried.
const DAMPINGS: [f64; 4] = [1.0, 0.85, 0.7, 0.6];
/// Slowest and fastest radius that is looked at, of the drive's natural frequency.
const RADII: (f64, f64) = (0.3, 8.0);
/// Step of the search.
const STEP: f64 = 1.15;
/// Halvings of the last step.
const HALVINGS: u32 = 4;
/// Feed below which the calm gains count, as edges a tick.
const CALM_EDGES: f64 = 1.0;
/// Radius of the calm poles, of the drive's natural frequency. They are slow, but with a velocity link that is not negative
/// (from 1/√6 on): it would take stiffness from the drive, which friction that falls with speed needs. Of 0.43 to 0.66 this
/// crept best on the 16K20F3.
const CALM_SHARE: f64 = 0.49;
/// Band at rest, d: within a discrete the encoder shows nothing, and to overcome static friction takes a way of that size.
const REST_BAND_D: f64 = 1.0;

/// `base` with everything of the loop replaced by what suits `model`.
///
/// # Errors
/// [`AutotuneError`]; nothing is changed then.
pub fn autotune(
    model: &DriveModel,
    base: &AxisParams,
    estimator: &EstimatorChoice,
) -> Result<(AxisParams, Report), AutotuneError> {
    model.check()?;
    let params = prepared(model, base, estimator)?;
    // Refuses a feed that leaves no room before anything is searched for.
    params.validate()?;
    let Chosen {
        params,
        bandwidth,
        damping,
        calm,
        trial,
        corner_trial,
    } = best(model, params)?;
    let (nominal, worst) = margins(model, &params, &OCTAVES)?;
    Ok((
        params,
        Report {
            bandwidth_rad_per_s: bandwidth,
            damping,
            calm_rad_per_s: calm,
            nominal,
            worst,
            trial,
            corner_trial,
        },
    ))
}

/// Estimator, feedforward, friction and prediction; the feedback is still to come.
fn prepared(
    model: &DriveModel,
    base: &AxisParams,
    estimator: &EstimatorChoice,
) -> Result<AxisParams, AutotuneError> {
    let scale = AxisScale::new(base.motion.counts_per_mm, base.tick_hz)?;
    let estimator = match estimator {
        EstimatorChoice::AsIs(config) => *config,
        EstimatorChoice::Observer(params) => {
            EstimatorConfig::Observer(observer::Config::new(&observer_on(params, model), scale)?)
        }
    };
    let Lags { position, .. } = estimator.lags();
    let position = if position == Lag::ZERO {
        PositionFeedback::Estimate
    } else {
        PositionFeedback::Count
    };
    // Learning needs estimates of now.
    let learning_noise = match estimator {
        EstimatorConfig::Observer(_) => LEARNING_NOISE,
        _ => 0.0,
    };
    let delay_ticks = libm::round(model.delay_s * base.tick_hz).min(MAX_TAPS as f64);
    let inverse = model.place_poles(1.0 / model.natural_period_s)?;
    let excess = |breakaway: f64, kinetic: f64| (breakaway - kinetic).max(0.0);
    Ok(AxisParams {
        motion: MotionParams {
            full_command_feed_mm_per_min: model.full_command_feed_mm_per_min,
            ..base.motion
        },
        estimator,
        paths: Paths {
            position,
            ..base.paths
        },
        controller: ControllerParams {
            bias: -model.offset,
            feedforward_lead_s: model.delay_s + 0.5 / base.tick_hz,
            rest_band_mm: scale.mm_from_counts(REST_BAND_D),
            learning_noise,
            ..inverse
        },
        filter: FilterParams {
            predicted_delay_s: delay_ticks / base.tick_hz,
            predicted_period_s: model.natural_period_s,
            predicted_damping: model.damping,
            ..base.filter
        },
        friction: FrictionParams {
            forward_mm_per_min: model.friction_forward_mm_per_min,
            backward_mm_per_min: model.friction_backward_mm_per_min,
            excess_forward_mm_per_min: excess(
                model.breakaway_forward_mm_per_min,
                model.friction_forward_mm_per_min,
            ),
            excess_backward_mm_per_min: excess(
                model.breakaway_backward_mm_per_min,
                model.friction_backward_mm_per_min,
            ),
            stribeck_mm_per_min: model.stribeck_mm_per_min.max(0.02),
            dead_time_s: model.dead_time_s,
            least_command: model.resolution / 2.0,
            lift_s: model.natural_period_s / 1.5,
            ..base.friction
        },
        calm: CalmParams::default(),
        ..*base
    })
}

/// What friction, ripple and steps of command leave of a command unexplained, 1σ, of full command.
const LEARNING_NOISE: f64 = 1e-3;

/// What is left of the disturbance that an observer has to expect where friction and offset are fed forward: of 0.1 to 3 this
/// crept best on the 16K20F3.
const LEFT_DISTURBANCE: f64 = 0.2;

/// The observer of the drive.
#[must_use]
pub fn observer_on(params: &ObserverParams, model: &DriveModel) -> ObserverParams {
    ObserverParams {
        full_command_feed_mm_per_min: model.full_command_feed_mm_per_min,
        natural_period_s: model.natural_period_s,
        damping: model.damping,
        delay_s: model.delay_s,
        offset: model.offset,
        disturbance_noise_m_s2: params.disturbance_noise_m_s2 * LEFT_DISTURBANCE,
        ..*params
    }
}

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

/// A loop that may be offered.
struct Chosen {
    params: AxisParams,
    bandwidth: f64,
    damping: f64,
    calm: f64,
    trial: Trial,
    corner_trial: Trial,
}

/// Of the fastest loops by their dampings, that which follows best on the corners.
fn best(model: &DriveModel, mut params: AxisParams) -> Result<Chosen, AutotuneError> {
    let feedforward = params.controller;
    let mut chosen: Option<Chosen> = None;
    let mut refused = None;
    for damping in DAMPINGS {
        let mut slowest = None;
        let mut keeps = |radius: f64| -> Result<bool, AutotuneError> {
            params.controller =
                with_feedback(&feedforward, model.place_pole_pairs(radius, damping)?);
            let (_, worst) = margins(model, &params, &OCTAVES)?;
            slowest = Some(worst);
            Ok(suffice(&worst, LEAST_GAIN_DB, LEAST_PHASE_DEG))
        };
        let Some(bandwidth) = largest(model, &mut keeps)? else {
            refused = refused.or(slowest.map(AutotuneError::NoMargin));
            continue;
        };
        params.controller =
            with_feedback(&feedforward, model.place_pole_pairs(bandwidth, damping)?);
        let calm = (CALM_SHARE * core::f64::consts::TAU / model.natural_period_s).min(bandwidth);
        params.calm = calm_params(model, &params, calm)?;
        match trials(model, &params) {
            Ok((trial, corner_trial)) => {
                let cost = |trial: &Trial| trial.peak_d + trial.standing_d;
                let is_better = |other: &Chosen| cost(&corner_trial) < cost(&other.corner_trial);
                if chosen.as_ref().is_none_or(is_better) {
                    chosen = Some(Chosen {
                        params,
                        bandwidth,
                        damping,
                        calm,
                        trial,
                        corner_trial,
                    });
                }
            }
            Err(error @ AutotuneError::Trial(_)) => refused = Some(error),
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

/// The largest radius that `keeps` what is asked for, if there is one: from the fastest down by steps, then by halving the
/// last of them. A slow loop need not keep it either: with links below zero it lives on what the drive has to give.
fn largest(
    model: &DriveModel,
    keeps: &mut dyn FnMut(f64) -> Result<bool, AutotuneError>,
) -> Result<Option<f64>, AutotuneError> {
    let omega = core::f64::consts::TAU / model.natural_period_s;
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

fn calm_params(
    model: &DriveModel,
    params: &AxisParams,
    radius: f64,
) -> Result<CalmParams, AutotuneError> {
    let scale = AxisScale::new(params.motion.counts_per_mm, params.tick_hz)?;
    let gains = model.place_poles(radius)?;
    Ok(CalmParams {
        below_mm_per_min: scale.feed_from_velocity(CALM_EDGES),
        position_gain_per_s: gains.position_gain_per_s,
        integral_gain_per_s2: gains.integral_gain_per_s2,
        velocity_gain: gains.velocity_gain,
        acceleration_gain_s: gains.acceleration_gain_s,
        ..CalmParams::default()
    })
}

/// Way of a trial: long enough for the acceleration limit, mm.
const TRIAL_MM: f64 = 20.0;
/// Share of the feed at which corners are tried, as a lower gain costs speed.
const CORNER_FEED: f64 = 0.6;
/// Swing at the end of a rest from which on a trial has not come to rest, d.
const MOST_UNREST_D: f64 = 5.0;

/// Moves on the model and on its corners.
fn trials(model: &DriveModel, params: &AxisParams) -> Result<(Trial, Trial), AutotuneError> {
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
        worst = Trial {
            peak_d: worst.peak_d.max(seen.peak_d),
            standing_d: worst.standing_d.max(seen.standing_d),
            swing_d: worst.swing_d.max(seen.swing_d),
        };
    }
    if worst.swing_d > MOST_UNREST_D {
        return Err(AutotuneError::Trial(worst));
    }
    Ok((own, worst))
}
