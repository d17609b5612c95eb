//! Parameters in physical units, and their validation into the quantised configuration of the tick.

mod sections;

pub use sections::SectionVisitor;

use core::fmt;

use crate::compensation::CompensationParams;
use crate::controller::params::LawParams;
pub use crate::controller::params::{CalmParams, ControllerParams, FilterParams, FrictionParams};
use crate::edges::EdgeConfig;
use crate::estimator::EstimatorConfig;
use crate::estimator::paths::{Config as EstimatorsConfig, Paths};
use crate::homing::HomingParams;
use crate::parameter_table;
use crate::parameter_table::ParameterTable;
use crate::probe::ProbeParams;
use crate::setpoint::profile::Limits;
use crate::setpoint::sources::{self, SourceParams};
use crate::setpoint::travel::TravelLimits;
use crate::supervisor::{self, SupervisorParams};
use crate::uncertainty::EdgeErrors;
use crate::units::{AxisScale, Position, RangeError};
use crate::{compensation, controller, homing, output, probe};

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
    /// A second one for paths of its own; it costs only where it is given.
    pub second_estimator: Option<EstimatorConfig>,
    /// Which of them serves which path.
    pub paths: Paths,
    /// Control law.
    pub controller: ControllerParams,
    /// Filters of its feedback part.
    pub filter: FilterParams,
    /// Its feedforward against friction.
    pub friction: FrictionParams,
    /// Its gains for slow motion and rest.
    pub calm: CalmParams,
    /// Limits of the output.
    pub output: OutputParams,
    /// Compensation of the screw.
    pub compensation: CompensationParams,
    /// What the axis is watched for.
    pub supervisor: SupervisorParams,
    /// Homing.
    pub homing: HomingParams,
    /// Probing.
    pub probe: ProbeParams,
    /// Sources of setpoints other than planned moves.
    pub sources: SourceParams,
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
        /// Counts of the encoder from index to index; 0: it has none
        counts_per_revolution: 10_000.0, "d", 0.0..=1e7;
        /// Low soft limit of travel, from the origin of homing; none where it equals the high one
        travel_low_mm: 0.0, "mm", -1e6..=1e6;
        /// High soft limit of travel
        travel_high_mm: 0.0, "mm", -1e6..=1e6;
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
    /// A parameter of the control law, or what its weights come to in the units of the tick, is out of range.
    Law(RangeError),
    /// The maximum feed leaves the drive no room for control.
    FeedTooHigh {
        /// The feed asked for, mm/min.
        max_feed_mm_per_min: f64,
        /// The feed at full command, mm/min.
        full_command_feed_mm_per_min: f64,
    },
    /// The low soft limit is above the high one.
    TravelReversed {
        /// The low one, mm.
        travel_low_mm: f64,
        /// The high one, mm.
        travel_high_mm: f64,
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
            Self::Range(error) | Self::Law(error) => error.fmt(f),
            Self::FeedTooHigh {
                max_feed_mm_per_min,
                full_command_feed_mm_per_min,
            } => write!(
                f,
                "max_feed_mm_per_min = {max_feed_mm_per_min} is out of range: allowed 0 to {} \
                 (95 % of the {full_command_feed_mm_per_min} mm/min at full command, the rest is for control)",
                full_command_feed_mm_per_min * MAX_FEED_SHARE
            ),
            Self::TravelReversed {
                travel_low_mm,
                travel_high_mm,
            } => write!(
                f,
                "travel_low_mm = {travel_low_mm} is above travel_high_mm = {travel_high_mm}: exchange them, or set both \
                 to 0 for no soft limits"
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
    /// Counts and ticks.
    pub scale: AxisScale,
    /// Estimators and their paths.
    pub estimators: EstimatorsConfig,
    /// Control law.
    pub controller: controller::Config,
    /// Limits of the output.
    pub output: output::Config,
    /// Limits of moves: those of the axis less what the compensation takes.
    pub limits: Limits,
    /// Compensation of the screw.
    pub compensation: compensation::Config,
    /// What the axis is watched for.
    pub supervisor: supervisor::Config,
    /// Homing.
    pub homing: homing::Config,
    /// Probing.
    pub probe: probe::Config,
    /// Soft limits of travel, from the origin of homing.
    pub travel: Option<TravelLimits>,
    /// Sources of setpoints other than planned moves.
    pub sources: sources::Config,
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
            second_estimator: None,
            paths: Paths::default(),
            controller: ControllerParams::default(),
            filter: FilterParams::default(),
            friction: FrictionParams::default(),
            calm: CalmParams::default(),
            output: OutputParams::default(),
            compensation: CompensationParams::default(),
            supervisor: SupervisorParams::default(),
            homing: HomingParams::default(),
            probe: ProbeParams::default(),
            sources: SourceParams::default(),
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
        let estimators = EstimatorsConfig::new(self.estimator, self.second_estimator, self.paths)?;
        let limits = self.motion.limits(scale)?;
        let compensation = self.compensation.quantise(scale, &limits)?;
        let limits = compensation.setpoint_limits(&limits)?;
        Ok(AxisConfig {
            edges,
            scale,
            estimators,
            limits,
            compensation,
            homing: self
                .homing
                .quantise(scale, &limits, self.motion.counts_per_revolution)?,
            probe: self
                .probe
                .quantise(scale, &limits, self.motion.counts_per_revolution)?,
            travel: self.motion.travel(scale)?,
            controller: LawParams {
                controller: &self.controller,
                filter: &self.filter,
                friction: &self.friction,
                calm: &self.calm,
            }
            .quantise(scale, full_velocity, estimators.delay())
            .map_err(ParamError::Law)?,
            output: self.output.quantise(scale)?,
            sources: self.sources.quantise(scale, limits, edges)?,
            supervisor: self.supervisor.quantise(
                scale,
                full_velocity,
                scale.velocity_from_feed(self.motion.max_feed_mm_per_min)?,
                self.motion.counts_per_revolution,
            )?,
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

impl MotionParams {
    /// Soft limits of travel from the origin; none where both are the same.
    fn travel(&self, scale: AxisScale) -> Result<Option<TravelLimits>, ParamError> {
        let Self {
            travel_low_mm,
            travel_high_mm,
            ..
        } = *self;
        if travel_low_mm == travel_high_mm {
            return Ok(None);
        }
        let place = |mm| Position::saturating_from_num(scale.counts_from_mm(mm));
        TravelLimits::new(place(travel_low_mm), place(travel_high_mm))
            .map(Some)
            .map_err(|_| ParamError::TravelReversed {
                travel_low_mm,
                travel_high_mm,
            })
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
