//! What makes up a controller, in fractions of full command per d and tick, and quantised.

use super::FollowingError;
use super::biquad::Section;
use super::dead_time::Config as DeadTimeConfig;
use super::filter::{Config as FilterConfig, MAX_SECTIONS, MAX_TAPS};
use super::friction::{Config as FrictionConfig, Friction};
use super::learning::Config as LearningConfig;
use super::rest::{Config as RestConfig, Rest};
use super::turning::Config as TurningConfig;
use super::weights::{GainSet, SETPOINTS, feedforward, quantise, scaled, shifted, weighed};
use crate::estimator::Delay;
use crate::narrowing::Narrowing;
use crate::units::{Command, RangeError, Velocity, checked};

/// Gains in fractions of full command per unit of the tick (d, d/tick, …).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gains {
    /// kp, per d of following error.
    pub position: f64,
    /// ki, per d and tick.
    pub integral: f64,
    /// kd, per d of change of the following error in a tick.
    pub derivative: f64,
    /// kv, per d/tick of velocity error.
    pub velocity: f64,
    /// ka, per d/tick² of acceleration error.
    pub acceleration: f64,
    /// Feedforward per d/tick.
    pub velocity_feedforward: f64,
    /// Feedforward per d/tick².
    pub acceleration_feedforward: f64,
    /// Feedforward per d/tick³.
    pub jerk_feedforward: f64,
    /// How far ahead of the setpoint the feedforward is, ticks: the delay of command and hold.
    pub feedforward_lead: f64,
}

/// What there is beside gains; by default nothing of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extras {
    /// Taps of the prediction over the drive's delay.
    pub taps: [f64; MAX_TAPS],
    /// Filter sections of the feedback part.
    pub sections: [Option<Section>; MAX_SECTIONS],
    /// Friction.
    pub friction: Friction,
    /// Following error within which the integral holds while the setpoint rests, d.
    pub rest_band_d: f64,
    /// Ticks in which a push against static friction at rest rises by it; 0 for never.
    pub lift_ticks: f64,
    /// What a command is for that the feedforward's terms are not, 1σ, fractions of full command; 0: nothing is learned.
    pub learning_noise: f64,
    /// Ticks for which the drive stands at a reversal of its command.
    pub dead_ticks: f64,
    /// Command either side of zero that the drive does not answer to.
    pub least_command: f64,
    /// Other gains near standstill.
    pub calm: Option<Calm>,
}

/// Gains for slow motion and rest, where edges come too seldom for a fast loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calm {
    /// Gains of the feedback part; the others are as in motion.
    pub gains: Gains,
    /// Speed of the setpoint below which they count, d/tick.
    pub speed: f64,
    /// Following error above which they do not count, d.
    pub error: f64,
    /// Ticks for which the setpoint has to be slower and the error smaller.
    pub ticks: f64,
}

/// Quantised controller parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    pub(super) moving: GainSet,
    pub(super) calm: GainSet,
    /// Speed of the setpoint below which the latter counts, Q11.20; below zero: never.
    pub(super) calm_speed: i32,
    /// Following error above which it does not count.
    pub(super) calm_error: i32,
    /// Ticks for which both have to be smaller.
    pub(super) calm_ticks: u32,
    deadband: i32,
    pub(super) learning: LearningConfig,
    /// What the integral may be off by after a rest: static friction before the filters, Q.30.
    pub(super) held: i32,
    pub(super) rest: RestConfig,
    /// Q.30.
    pub(super) bias: i32,
    pub(super) transfer_decay: u32,
    pub(super) filter: FilterConfig,
    /// Where there are filters, the feedforward and the bias, which pass by them.
    feedforward: [i32; SETPOINTS],
    feedforward_narrowing: Narrowing,
    feedforward_offset: i64,
    pub(super) turning: TurningConfig,
    /// Ticks within which a change of the jerk counts.
    pub(super) horizon: u32,
    pub(super) friction: FrictionConfig,
    pub(super) dead_time: DeadTimeConfig,
}

impl Config {
    /// Quantises `gains`; `deadband_d` in d is subtracted from the following error, `bias` in fractions
    /// of full command is added to the output, and a jump of the law decays with a time constant of
    /// `transfer_ticks`. `delay` is that of the estimates that the law will get.
    ///
    /// # Errors
    /// [`RangeError`] naming the parameter that does not fit.
    pub fn new(
        gains: &Gains,
        delay: impl Into<Delay>,
        deadband_d: f64,
        bias: f64,
        transfer_ticks: f64,
    ) -> Result<Self, RangeError> {
        let delay = delay.into();
        Self::with_extras(
            gains,
            delay,
            deadband_d,
            bias,
            transfer_ticks,
            &Extras::default(),
        )
    }

    /// The same with `extras`.
    ///
    /// # Errors
    /// [`RangeError`] naming the parameter that does not fit.
    pub fn with_extras(
        gains: &Gains,
        delay: Delay,
        deadband_d: f64,
        bias: f64,
        transfer_ticks: f64,
        extras: &Extras,
    ) -> Result<Self, RangeError> {
        let filter = FilterConfig::new(&extras.taps, extras.sections)?;
        let ahead = feedforward(gains)?;
        let bias_share = bias;
        let bias = scaled(checked("bias", bias, -1.0, 1.0)?, Command::FRAC_NBITS);
        let (within, beside, biases) = if filter.is_on() {
            ([0.0; SETPOINTS], ahead, [0, bias])
        } else {
            (ahead, [0.0; SETPOINTS], [bias, 0])
        };
        let [within_bias, feedforward_offset] = biases.map(i64::from);
        let set = |gains: &Gains| GainSet::new(gains, delay, within, within_bias);
        let (feedforward, feedforward_shift) = quantise(&beside)?;
        let moving = set(gains)?;
        let (calm, calm_speed, calm_error, calm_ticks) = match &extras.calm {
            Some(calm) => (
                set(&calm.gains)?,
                scaled(
                    checked("calm_d_per_tick", calm.speed, 0.0, 2047.0)?,
                    Velocity::FRAC_NBITS,
                ),
                scaled(
                    checked("calm_error_d", calm.error, 0.0, 3e4)?,
                    FollowingError::FRAC_NBITS,
                ),
                (checked("calm_ticks", calm.ticks, 0.0, 1e6)? as u32).max(1),
            ),
            None => (moving, -1, 0, u32::MAX),
        };
        let transfer = checked("transfer_ticks", transfer_ticks, 1.0, 1e6)?;
        let held = extras.friction.breakaway.into_iter().fold(0.0, f64::max);
        let rest = Rest {
            band: extras.rest_band_d,
            held,
            lift_ticks: extras.lift_ticks,
            delay_ticks: gains.feedforward_lead,
            per_jerk: gains.jerk_feedforward,
        };
        // Before the filters, which let a steady command through by 1/(1 + Σ taps).
        let held = held * (1.0 + extras.taps.iter().sum::<f64>());
        let turning = TurningConfig::new(gains);
        let friction = FrictionConfig::new(&extras.friction)?;
        let learning = LearningConfig::new(gains, delay, bias_share, extras.learning_noise)?;
        let horizons = [turning.horizon(), friction.horizon(), learning.horizon()];
        Ok(Self {
            moving,
            learning,
            held: scaled(held.min(1.9), Command::FRAC_NBITS),
            rest: RestConfig::new(&rest)?,
            bias: scaled(bias_share, Command::FRAC_NBITS),
            calm,
            calm_speed,
            calm_error,
            calm_ticks,
            feedforward,
            feedforward_narrowing: Narrowing::by(feedforward_shift),
            feedforward_offset: shifted(feedforward_offset, feedforward_shift),
            filter,
            horizon: horizons.into_iter().fold(0, u32::max),
            turning,
            friction,
            dead_time: DeadTimeConfig::new(extras.dead_ticks, bias_share, extras.least_command)?,
            deadband: scaled(
                checked("deadband_d", deadband_d, 0.0, 1000.0)?,
                FollowingError::FRAC_NBITS,
            ),
            transfer_decay: libm::round(libm::ldexp(libm::exp(-1.0 / transfer), 31)) as u32,
        })
    }

    /// Ticks from the announcement of a motion from rest to its start, at least 1, that make it ready.
    #[must_use]
    pub const fn notice_ticks(&self) -> u32 {
        self.friction.notice().saturating_add(1)
    }

    /// The error less the deadband, which does not step at its border.
    pub(super) const fn apply_deadband(&self, error: i32) -> i32 {
        if error > self.deadband {
            error.wrapping_sub(self.deadband)
        } else if error < self.deadband.wrapping_neg() {
            error.saturating_add(self.deadband)
        } else {
            0
        }
    }

    /// Where there are filters, bias and feedforward of the setpoints of v, a and j, Q.30; saturates.
    #[inline]
    pub(super) fn ahead(&self, setpoints: &[i32; SETPOINTS]) -> i32 {
        self.feedforward_narrowing.apply(weighed(
            &self.feedforward,
            setpoints,
            self.feedforward_offset,
        ))
    }
}
