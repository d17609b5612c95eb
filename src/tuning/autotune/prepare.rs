//! What follows from the model without a search: estimator, feedforward, friction, prediction and the calm gains.

use super::EstimatorChoice;
use super::report::AutotuneError;
use crate::controller::filter::MAX_TAPS;
use crate::controller::params::{CalmParams, ControllerParams, FilterParams, FrictionParams};
use crate::estimator::observer::{self, ObserverParams};
use crate::estimator::paths::{Paths, PositionFeedback};
use crate::estimator::{EstimatorConfig, Lags};
use crate::params::{AxisParams, MotionParams};
use crate::tuning::model::DriveModel;
use crate::units::{AxisScale, Lag};

/// Feed below which the calm gains count, as edges a tick.
const CALM_EDGES: f64 = 1.0;
/// Band at rest, d: within a discrete the encoder shows nothing, and a push moves the axis by about one. Of 0.55 to 1 this left least.
const REST_BAND_D: f64 = 0.85;
/// What friction, ripple and steps of command leave of a command unexplained, 1σ, of full command.
const LEARNING_NOISE: f64 = 1e-3;

/// What is left of the disturbance that an observer has to expect where friction and offset are fed forward: of 0.1 to 3 this
/// crept best on the 16K20F3.
const LEFT_DISTURBANCE: f64 = 0.2;

/// `base` with estimator, feedforward, friction and prediction for `model`; the feedback is still to come.
///
/// # Errors
/// A parameter or a figure of the model out of range.
pub fn prepared(
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
            // Faster pushes throw the axis farther, slower ones come late.
            lift_s: model.natural_period_s,
            ..base.friction
        },
        calm: CalmParams::default(),
        ..*base
    })
}
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

/// Slow gains for rest and creep.
pub fn calm_params(
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
