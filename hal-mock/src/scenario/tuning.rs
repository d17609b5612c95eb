//! An axis tuned on what is known of a machine.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer::{self, ObserverParams};
use leadscrew::params::{AxisParams, MotionParams, ParamError};
use leadscrew::tuning::DriveModel;
use leadscrew::tuning::autotune::{AutotuneError, EstimatorChoice, autotune};
use leadscrew::units::AxisScale;

use crate::machine::MachineParams;

/// Bandwidth of the loop with an estimator that lags by some five ticks of 1 ms, rad/s.
pub const BANDWIDTH_RAD_PER_S: f64 = 35.0;

/// The estimator for `machine` at a control rate of `tick_hz`: an observer with the machine's nominal figures and what
/// its encoder does, with or without a map (`mapped`), in place of any other observer; all others as they are.
///
/// # Errors
/// The drive or the encoder has no figures that an observer could be tuned on.
pub fn tuned_estimator(
    machine: &MachineParams,
    tick_hz: f64,
    estimator: EstimatorConfig,
    mapped: bool,
) -> Result<EstimatorConfig, ParamError> {
    if !matches!(estimator, EstimatorConfig::Observer(_)) {
        return Ok(estimator);
    }
    let scale = AxisScale::new(machine.mount.counts_per_mm, tick_hz)?;
    let config = observer::Config::new(&observer_params(machine, mapped), scale)?;
    Ok(EstimatorConfig::Observer(config))
}

/// An axis tuned on the nominal figures of the drive of `machine`, for moves at `max_feed_mm_per_min` at most, with the
/// poles of its loop at `bandwidth_rad_per_s`.
///
/// # Errors
/// The drive has no figures that a loop could be tuned on.
pub fn tuned_axis(
    machine: &MachineParams,
    tick_hz: f64,
    max_feed_mm_per_min: f64,
    bandwidth_rad_per_s: f64,
    estimator: EstimatorConfig,
) -> Result<AxisParams, ParamError> {
    let drive = DriveModel::second_order(machine.drive.natural_period_s, machine.drive.damping);
    Ok(AxisParams {
        controller: drive.place_poles(bandwidth_rad_per_s)?,
        ..axis_on(machine, tick_hz, max_feed_mm_per_min, estimator)
    })
}

/// The axis of `machine` as [`autotune`] tunes it, for moves at `max_feed_mm_per_min` at most: it is given the drive's
/// figures as a perfect identification would find them. An observer among estimators is tuned with it, for an encoder
/// with or without a map (`mapped`).
///
/// # Errors
/// Nothing that autotune could offer.
pub fn autotuned_axis(
    machine: &MachineParams,
    tick_hz: f64,
    max_feed_mm_per_min: f64,
    estimator: EstimatorConfig,
    mapped: bool,
) -> Result<AxisParams, AutotuneError> {
    let base = axis_on(machine, tick_hz, max_feed_mm_per_min, estimator);
    let choice = match estimator {
        EstimatorConfig::Observer(_) => EstimatorChoice::Observer(observer_params(machine, mapped)),
        other => EstimatorChoice::AsIs(other),
    };
    autotune(&model_of(machine), &base, &choice).map(|(axis, _)| axis)
}

/// The figures of a machine's drive, as a perfect identification would find them.
#[must_use]
pub fn model_of(machine: &MachineParams) -> DriveModel {
    let drive = &machine.drive;
    let breakaway = drive.friction_mm_per_min * drive.stiction_ratio;
    DriveModel {
        full_command_feed_mm_per_min: drive.full_command_feed_mm_per_min,
        natural_period_s: drive.natural_period_s,
        damping: drive.damping,
        delay_s: drive.delay_s,
        offset: drive.offset,
        friction_forward_mm_per_min: drive.friction_mm_per_min,
        friction_backward_mm_per_min: drive.friction_mm_per_min,
        breakaway_forward_mm_per_min: breakaway,
        breakaway_backward_mm_per_min: breakaway,
        stribeck_mm_per_min: drive.stribeck_mm_per_min,
        dead_time_s: drive.dead_time_s,
        resolution: drive.resolution,
        max_acceleration_m_s2: drive.max_acceleration_m_s2,
    }
}

/// An axis of `machine` that is not tuned.
fn axis_on(
    machine: &MachineParams,
    tick_hz: f64,
    max_feed_mm_per_min: f64,
    estimator: EstimatorConfig,
) -> AxisParams {
    AxisParams {
        tick_hz,
        timer_hz: machine.encoder.encoder.timer_hz,
        motion: MotionParams {
            counts_per_mm: machine.mount.counts_per_mm,
            full_command_feed_mm_per_min: machine.drive.full_command_feed_mm_per_min,
            max_feed_mm_per_min,
            counts_per_revolution: machine.encoder.disc.edges_per_revolution,
            ..MotionParams::default()
        },
        ..AxisParams::new(estimator)
    }
}

/// What an observer is to count on, on `machine`; with a map of its encoder (`mapped`), what such a map leaves.
#[must_use]
pub fn observer_params(machine: &MachineParams, mapped: bool) -> ObserverParams {
    let (drive, disc, encoder) = (
        &machine.drive,
        &machine.encoder.disc,
        &machine.encoder.encoder,
    );
    let params = ObserverParams {
        full_command_feed_mm_per_min: drive.full_command_feed_mm_per_min,
        natural_period_s: drive.natural_period_s,
        damping: drive.damping,
        delay_s: drive.delay_s,
        offset: drive.offset,
        ..ObserverParams::default()
    };
    if mapped {
        return params;
    }
    let edge_variance = encoder.noise_d * encoder.noise_d
        + disc.line_sigma_d * disc.line_sigma_d
        + disc.edge_sigma_d * disc.edge_sigma_d
        + disc.phase_offset_d * disc.phase_offset_d / 3.0;
    // Slopes add up as squares; that of the second harmonic is twice as steep.
    let second = 2.0 * disc.second_harmonic_d;
    let waves = disc.eccentricity_d * disc.eccentricity_d + second * second;
    ObserverParams {
        edge_noise_d: libm::sqrt(edge_variance).max(LEAST_EDGE_NOISE_D),
        time_noise_s: encoder.noise_s,
        map_residual_d: libm::sqrt(waves / 2.0),
        map_wave_mm: disc.edges_per_revolution / machine.mount.counts_per_mm,
        ..params
    }
}

/// Edge noise that even an ideal encoder is given: what the timer's clock leaves at 150 d/tick.
const LEAST_EDGE_NOISE_D: f64 = 0.002;
