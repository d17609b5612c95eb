//! Parameters in physical units, and their validation into the quantised configuration of the tick.

use core::fmt;

use crate::compensation::CompensationParams;
use crate::controller::config::Gains;
use crate::edges::EdgeConfig;
use crate::estimator::{Delay, EstimatorConfig};
use crate::homing::HomingParams;
use crate::parameter_table;
use crate::parameter_table::ParameterTable;
use crate::setpoint::profile::Limits;
use crate::uncertainty::EdgeErrors;
use crate::units::{AxisScale, RangeError};
use crate::{compensation, controller, homing, output};

/// Largest share of the full-command speed that a maximum feed may use; the rest is for control.
pub const MAX_FEED_SHARE: f64 = 0.95;

/// Everything that is set on an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisParams {
    /// Control rate, Hz: 100 to 40 000.
    pub tick_hz: f64,
    /// Clock of the edge timer, Hz: 1e6 to 250e6.
    pub timer_hz: f64,
    /// Errors of the encoder, from which estimates state their uncertainty.
    pub encoder: EdgeErrors,
    /// What the axis is and how it may move.
    pub motion: MotionParams,
    /// Estimator; its parameters are in ticks.
    pub estimator: EstimatorConfig,
    /// Control law.
    pub controller: ControllerParams,
    /// Limits of the output.
    pub output: OutputParams,
    /// Compensation of the screw.
    pub compensation: CompensationParams,
    /// Homing.
    pub homing: HomingParams,
}

parameter_table! {
    /// What the axis is and how it may move.
    pub struct MotionParams {
        /// Encoder resolution
        counts_per_mm: 1000.0, "d/mm", 0.001..=1e7;
        /// Feed at full command (±10 V)
        full_command_feed_mm_per_min: 9600.0, "mm/min", 0.001..=1e6;
        /// Largest feed of a move; at most 95 % of the full-command feed
        max_feed_mm_per_min: 9000.0, "mm/min", 1e-6..=1e6;
        /// Largest acceleration of a move
        max_acceleration_m_s2: 0.9, "m/s²", 1e-6..=1e4;
        /// Largest jerk of a move
        max_jerk_m_s3: 10.0, "m/s³", 1e-6..=1e7;
    }
}

parameter_table! {
    /// The control law. Gains are normalised by the full-command speed: a velocity demand of 1 mm/s for
    /// each mm of following error is a position gain of 1 /s on any axis, at any tick rate. The
    /// default is velocity feedforward alone: an axis that moves without a loop.
    pub struct ControllerParams {
        /// kp
        position_gain_per_s: 0.0, "1/s", 0.0..=1e4;
        /// ki
        integral_gain_per_s2: 0.0, "1/s²", 0.0..=1e6;
        /// kd: velocity demand per rate of change of the following error
        derivative_gain: 0.0, "1", 0.0..=1e4;
        /// kv: velocity demand per velocity error
        velocity_gain: 0.0, "1", -1e4..=1e4;
        /// ka: velocity demand per acceleration error
        acceleration_gain_s: 0.0, "s", -10.0..=10.0;
        /// Velocity feedforward; 1 for a drive whose full-command feed is right
        velocity_feedforward: 1.0, "1", 0.0..=2.0;
        /// Acceleration feedforward
        acceleration_feedforward_s: 0.0, "s", 0.0..=10.0;
        /// Jerk feedforward
        jerk_feedforward_s2: 0.0, "s²", 0.0..=10.0;
        /// Following error that is ignored
        deadband_mm: 0.0, "mm", 0.0..=1.0;
        /// Constant output against the drive's offset
        bias: 0.0, "of full command", -1.0..=1.0;
        /// Time constant with which a jump of the law at enable or at a parameter change is let in
        transfer_time_s: 0.05, "s", 0.0..=10.0;
    }
}

parameter_table! {
    /// Limits of the output: full command, reached from zero within 2 ms.
    pub struct OutputParams {
        /// Largest output
        limit: 1.0, "of full command", 0.0001..=1.0;
        /// Fastest change of the output
        slew_per_s: 500.0, "of full command a second", 0.1..=1e6;
    }
}

/// Why parameters were refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamError {
    /// A parameter, or what it comes to in the units of the tick, is out of range.
    Range(RangeError),
    /// The maximum feed leaves the drive no room for control.
    FeedTooHigh {
        /// The feed asked for, mm/min.
        max_feed_mm_per_min: f64,
        /// The feed at full command, mm/min.
        full_command_feed_mm_per_min: f64,
    },
}

impl From<RangeError> for ParamError {
    fn from(error: RangeError) -> Self {
        Self::Range(error)
    }
}

impl fmt::Display for ParamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range(error) => error.fmt(f),
            Self::FeedTooHigh {
                max_feed_mm_per_min,
                full_command_feed_mm_per_min,
            } => write!(
                f,
                "max_feed_mm_per_min = {max_feed_mm_per_min} is out of range: allowed 0 to {} \
                 (95 % of the {full_command_feed_mm_per_min} mm/min at full command, the rest is for control)",
                full_command_feed_mm_per_min * MAX_FEED_SHARE
            ),
        }
    }
}

impl core::error::Error for ParamError {}

/// The quantised configuration of an axis, as validation makes it: the controller's weights count on
/// the lags of the estimator beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisConfig {
    /// Edge timer and noise of the edges.
    pub edges: EdgeConfig,
    /// Estimator.
    pub estimator: EstimatorConfig,
    /// Control law.
    pub controller: controller::Config,
    /// Limits of the output.
    pub output: output::Config,
    /// Limits of moves: those of the axis less what the compensation takes.
    pub limits: Limits,
    /// Compensation of the screw.
    pub compensation: compensation::Config,
    /// Homing.
    pub homing: homing::Config,
}

impl AxisParams {
    /// All defaults, with `estimator`, at a control rate of 1 kHz and an edge timer of 84 MHz.
    #[must_use]
    pub fn new(estimator: EstimatorConfig) -> Self {
        Self {
            tick_hz: 1000.0,
            timer_hz: 84e6,
            encoder: EdgeErrors::default(),
            motion: MotionParams::default(),
            estimator,
            controller: ControllerParams::default(),
            output: OutputParams::default(),
            compensation: CompensationParams::default(),
            homing: HomingParams::default(),
        }
    }

    /// Validates and quantises.
    ///
    /// # Errors
    /// [`ParamError`] naming the first parameter that is wrong, its value and the allowed range.
    pub fn validate(&self) -> Result<AxisConfig, ParamError> {
        let edges = EdgeConfig::new(self.tick_hz, self.timer_hz, &self.encoder)?;
        // Before anything is converted: conversions have their own, more general names.
        self.motion.check()?;
        let scale = AxisScale::new(self.motion.counts_per_mm, self.tick_hz)?;
        let full_velocity = scale.velocity_from_feed(self.motion.full_command_feed_mm_per_min)?;
        let limits = self.motion.limits(scale)?;
        let compensation = self.compensation.quantise(scale, &limits)?;
        let limits = compensation.setpoint_limits(&limits)?;
        Ok(AxisConfig {
            edges,
            estimator: self.estimator,
            limits,
            compensation,
            homing: self.homing.quantise(scale, &limits)?,
            controller: self
                .controller
                .quantise(scale, full_velocity, self.estimator.delay())?,
            output: self.output.quantise(scale)?,
        })
    }
}

impl MotionParams {
    /// Limits of motion; the table has been checked.
    fn limits(&self, scale: AxisScale) -> Result<Limits, ParamError> {
        let Self {
            max_feed_mm_per_min,
            full_command_feed_mm_per_min,
            ..
        } = *self;
        if max_feed_mm_per_min > full_command_feed_mm_per_min * MAX_FEED_SHARE {
            return Err(ParamError::FeedTooHigh {
                max_feed_mm_per_min,
                full_command_feed_mm_per_min,
            });
        }
        Ok(Limits::new(
            scale.velocity_from_feed(max_feed_mm_per_min)?,
            scale.acceleration_from_m_s2(self.max_acceleration_m_s2),
            scale.jerk_from_m_s3(self.max_jerk_m_s3),
        )?)
    }
}

impl ControllerParams {
    /// Gains per d and tick; `full_velocity` is the speed at full command, d/tick, `delay` is the estimator's.
    fn quantise(
        &self,
        scale: AxisScale,
        full_velocity: f64,
        delay: Delay,
    ) -> Result<controller::Config, ParamError> {
        self.check()?;
        let rate = scale.tick_hz();
        let gains = Gains {
            position: self.position_gain_per_s / (rate * full_velocity),
            integral: self.integral_gain_per_s2 / (rate * rate * full_velocity),
            derivative: self.derivative_gain / full_velocity,
            velocity: self.velocity_gain / full_velocity,
            acceleration: self.acceleration_gain_s * rate / full_velocity,
            velocity_feedforward: self.velocity_feedforward / full_velocity,
            acceleration_feedforward: self.acceleration_feedforward_s * rate / full_velocity,
            jerk_feedforward: self.jerk_feedforward_s2 * rate * rate / full_velocity,
        };
        let deadband_d = scale.counts_from_mm(self.deadband_mm);
        let transfer_ticks = (self.transfer_time_s * rate).max(1.0);
        Ok(controller::Config::new(
            &gains,
            delay,
            deadband_d,
            self.bias,
            transfer_ticks,
        )?)
    }
}

impl OutputParams {
    fn quantise(&self, scale: AxisScale) -> Result<output::Config, ParamError> {
        self.check()?;
        Ok(output::Config::new(
            self.limit,
            (self.slew_per_s / scale.tick_hz()).min(2.0),
        )?)
    }
}
