//! Parameters of the control law in physical units, and their quantisation.

use super::biquad::Section;
use super::config::{Calm, Config, Extras, Gains};
use super::filter::MAX_TAPS;
use super::friction::Friction;
use crate::estimator::Delay;
use crate::parameter_table;
use crate::parameter_table::ParameterTable;
use crate::tuning::plant::Plant;
use crate::units::{AxisScale, RangeError, checked};

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
        /// How far ahead of the setpoint the feedforward is: the drive's delay and half a tick of hold
        feedforward_lead_s: 0.0, "s", 0.0..=1.0;
        /// Following error that is ignored
        deadband_mm: 0.0, "mm", 0.0..=1.0;
        /// Constant output against the drive's offset
        bias: 0.0, "of full command", -1.0..=1.0;
        /// Time constant with which a jump of the law at enable or at a parameter change is let in
        transfer_time_s: 0.05, "s", 0.0..=10.0;
        /// Following error within which the integral holds while the setpoint rests
        rest_band_mm: 0.0, "mm", 0.0..=1.0;
        /// What the feedforward's terms leave of a command unexplained, 1σ: their gains are learned against it; 0 for never
        learning_noise: 0.0, "of full command", 0.0..=0.1;
    }
}

parameter_table! {
    /// Gains for slow motion and rest, where edges come too seldom for a fast loop: none.
    pub struct CalmParams {
        /// Feed of the setpoint below which they count; 0 for never
        below_mm_per_min: 0.0, "mm/min", 0.0..=1e5;
        /// Following error above which they do not begin to; eight times as much ends them
        within_mm: 10.0, "mm", 0.0..=10.0;
        /// Time for which both have to be smaller
        after_s: 0.3, "s", 0.0..=10.0;
        /// kp
        position_gain_per_s: 0.0, "1/s", 0.0..=1e4;
        /// ki
        integral_gain_per_s2: 0.0, "1/s²", 0.0..=1e6;
        /// kv: velocity demand per velocity error
        velocity_gain: 0.0, "1", -1e4..=1e4;
        /// ka: velocity demand per acceleration error
        acceleration_gain_s: 0.0, "s", -10.0..=10.0;
    }
}

parameter_table! {
    /// Filters of the feedback part: none. A frequency of 0 is off.
    pub struct FilterParams {
        /// Frequency of the notch
        notch_hz: 0.0, "Hz", 0.0..=2e4;
        /// Damping ratio of the notch: half its width over its frequency
        notch_damping: 0.5, "1", 0.01..=5.0;
        /// Natural frequency of the low-pass
        low_pass_hz: 0.0, "Hz", 0.0..=2e4;
        /// Damping ratio of the low-pass
        low_pass_damping: 0.7, "1", 0.05..=5.0;
        /// Delay of the drive that feedback predicts over, rounded to whole ticks, 8 at most
        predicted_delay_s: 0.0, "s", 0.0..=0.1;
        /// Natural period of the drive, for the prediction
        predicted_period_s: 0.09, "s", 0.001..=10.0;
        /// Damping ratio of the drive, for the prediction
        predicted_damping: 0.5, "1", 0.01..=10.0;
    }
}

parameter_table! {
    /// What the drive and its guides lose, fed forward: friction as the feed that the command loses, and dead time. None.
    pub struct FrictionParams {
        /// Kinetic friction forward
        forward_mm_per_min: 0.0, "mm/min", 0.0..=1e5;
        /// Kinetic friction backward
        backward_mm_per_min: 0.0, "mm/min", 0.0..=1e5;
        /// What it takes to start forward, over the kinetic friction
        excess_forward_mm_per_min: 0.0, "mm/min", 0.0..=1e5;
        /// What it takes to start backward, over the kinetic friction
        excess_backward_mm_per_min: 0.0, "mm/min", 0.0..=1e5;
        /// Feed at which half of that excess is gone (Stribeck)
        stribeck_mm_per_min: 60.0, "mm/min", 0.02..=1e5;
        /// Feed of the setpoint from which on it counts as motion
        least_mm_per_min: 0.1, "mm/min", 0.0..=1e3;
        /// Time for which the drive stands at a reversal of its command
        dead_time_s: 0.0, "s", 0.0..=0.1;
        /// Command either side of zero that the drive takes for none
        least_command: 5e-5, "of full command", 0.0..=0.1;
        /// Time in which the largest level comes or goes
        rise_s: 0.001, "s", 0.0..=1.0;
        /// Time in which, at rest with a standing error, a push rises by what it takes to start; 0 for never
        lift_s: 0.0, "s", 0.0..=100.0;
    }
}

/// What makes up a control law.
#[derive(Clone, Copy, Debug)]
pub struct LawParams<'a> {
    /// Gains.
    pub controller: &'a ControllerParams,
    /// Filters.
    pub filter: &'a FilterParams,
    /// Friction.
    pub friction: &'a FrictionParams,
    /// Slow motion and rest.
    pub calm: &'a CalmParams,
}

/// Gains on the state of now, taps of the prediction and sections.
#[derive(Clone, Copy, Debug)]
pub struct Feedback {
    /// Gains.
    pub gains: Gains,
    /// Taps.
    pub taps: [f64; MAX_TAPS],
    /// Sections.
    pub sections: [Option<Section>; 2],
}

impl LawParams<'_> {
    /// The quantised law; `full_velocity` is the speed at full command, d/tick, `delay` is the estimator's.
    ///
    /// # Errors
    /// [`RangeError`] naming the parameter that is out of range, or does not fit the tick.
    pub fn quantise(
        &self,
        scale: AxisScale,
        full_velocity: f64,
        delay: Delay,
    ) -> Result<Config, RangeError> {
        self.controller.check()?;
        self.filter.check()?;
        self.friction.check()?;
        self.calm.check()?;
        let rate = scale.tick_hz();
        let params = self.controller;
        let (gains, taps) = self.predicted(scale, full_velocity)?;
        let extras = Extras {
            taps,
            sections: self.filter.sections(rate)?,
            friction: self.friction.in_ticks(scale, full_velocity, params)?,
            learning_noise: params.learning_noise,
            rest_band_d: scale.counts_from_mm(params.rest_band_mm),
            lift_ticks: self.friction.lift_s * rate,
            dead_ticks: self.friction.dead_time_s * rate,
            least_command: self.friction.least_command,
            calm: self.calm(scale, full_velocity, taps.iter().sum())?,
        };
        Config::with_extras(
            &gains,
            delay,
            scale.counts_from_mm(params.deadband_mm),
            params.bias,
            (params.transfer_time_s * rate).max(1.0),
            &extras,
        )
    }

    /// The gains for slow motion. They need no prediction, but the taps, whose sum is `taps`, stay: what is held under
    /// them is made up for.
    fn calm(
        &self,
        scale: AxisScale,
        full_velocity: f64,
        taps: f64,
    ) -> Result<Option<Calm>, RangeError> {
        let calm = self.calm;
        if calm.below_mm_per_min == 0.0 {
            return Ok(None);
        }
        let params = ControllerParams {
            position_gain_per_s: calm.position_gain_per_s,
            integral_gain_per_s2: calm.integral_gain_per_s2,
            velocity_gain: calm.velocity_gain,
            acceleration_gain_s: calm.acceleration_gain_s,
            ..*self.controller
        };
        let gains = params.gains(scale, full_velocity);
        let whole = 1.0 + taps;
        Ok(Some(Calm {
            gains: Gains {
                position: gains.position * whole,
                velocity: gains.velocity * whole,
                acceleration: gains.acceleration * whole,
                ..gains
            },
            speed: scale.velocity_from_feed(calm.below_mm_per_min)?,
            error: scale.counts_from_mm(calm.within_mm),
            ticks: calm.after_s * scale.tick_hz(),
        }))
    }

    /// The feedback part of the law as it is in motion, in `f64`.
    ///
    /// # Errors
    /// As [`Self::quantise`].
    pub fn feedback(&self, scale: AxisScale, full_velocity: f64) -> Result<Feedback, RangeError> {
        let (gains, taps) = self.predicted(scale, full_velocity)?;
        let sections = self.filter.sections(scale.tick_hz())?;
        Ok(Feedback {
            gains,
            taps,
            sections,
        })
    }

    /// Gains on the state of now, and the taps of the prediction.
    fn predicted(
        &self,
        scale: AxisScale,
        full_velocity: f64,
    ) -> Result<(Gains, [f64; MAX_TAPS]), RangeError> {
        let gains = self.controller.gains(scale, full_velocity);
        let rate = scale.tick_hz();
        let ticks = checked(
            "predicted_delay_s * tick_hz",
            libm::round(self.filter.predicted_delay_s * rate),
            0.0,
            MAX_TAPS as f64,
        )? as usize;
        if ticks == 0 {
            return Ok((gains, [0.0; MAX_TAPS]));
        }
        let period = checked(
            "predicted_period_s * tick_hz",
            self.filter.predicted_period_s * rate,
            8.0,
            1e5,
        )?;
        let plant = Plant::with_period(period, self.filter.predicted_damping, full_velocity);
        let wanted = [gains.position, gains.velocity, gains.acceleration];
        let ([position, velocity, acceleration], taps) = plant.predicted(&wanted, ticks);
        let gains = Gains {
            position,
            velocity,
            acceleration,
            ..gains
        };
        Ok((gains, taps))
    }
}

impl ControllerParams {
    /// Gains per d and tick; `full_velocity` is the speed at full command, d/tick.
    #[must_use]
    pub fn gains(&self, scale: AxisScale, full_velocity: f64) -> Gains {
        let rate = scale.tick_hz();
        Gains {
            position: self.position_gain_per_s / (rate * full_velocity),
            integral: self.integral_gain_per_s2 / (rate * rate * full_velocity),
            derivative: self.derivative_gain / full_velocity,
            velocity: self.velocity_gain / full_velocity,
            acceleration: self.acceleration_gain_s * rate / full_velocity,
            velocity_feedforward: self.velocity_feedforward / full_velocity,
            acceleration_feedforward: self.acceleration_feedforward_s * rate / full_velocity,
            jerk_feedforward: self.jerk_feedforward_s2 * rate * rate / full_velocity,
            feedforward_lead: self.feedforward_lead_s * rate,
        }
    }
}

impl FilterParams {
    /// The sections that are on.
    fn sections(&self, tick_hz: f64) -> Result<[Option<Section>; 2], RangeError> {
        let notch = (self.notch_hz > 0.0)
            .then(|| Section::notch(self.notch_hz / tick_hz, self.notch_damping));
        let low_pass = (self.low_pass_hz > 0.0)
            .then(|| Section::low_pass(self.low_pass_hz / tick_hz, self.low_pass_damping));
        Ok([notch.transpose()?, low_pass.transpose()?])
    }
}

impl FrictionParams {
    /// In fractions of full command, d and ticks.
    fn in_ticks(
        &self,
        scale: AxisScale,
        full_velocity: f64,
        controller: &ControllerParams,
    ) -> Result<Friction, RangeError> {
        let velocity = |feed: f64| scale.velocity_from_feed(feed);
        let share = |feed: f64| velocity(feed).map(|velocity| velocity / full_velocity);
        let rise_ticks = (self.rise_s * scale.tick_hz()).max(1.0);
        Ok(Friction {
            kinetic: [
                share(self.forward_mm_per_min)?,
                share(self.backward_mm_per_min)?,
            ],
            breakaway: [
                share(self.forward_mm_per_min + self.excess_forward_mm_per_min)?,
                share(self.backward_mm_per_min + self.excess_backward_mm_per_min)?,
            ],
            stribeck: velocity(self.stribeck_mm_per_min)?,
            least_speed: velocity(self.least_mm_per_min)?,
            rise_ticks,
            dead_ticks: self.dead_time_s * scale.tick_hz(),
            lead_ticks: controller.feedforward_lead_s * scale.tick_hz() + rise_ticks / 2.0,
        })
    }
}
