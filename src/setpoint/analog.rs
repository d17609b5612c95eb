//! The analog velocity command of a legacy control: its voltage as a jerk-limited velocity.
//!
//! v = K·dead(u − u₀), with u₀ the offset that was measured while the control commanded zero and dead(x) the part
//! of x beyond the deadband, so that nothing steps at its border. K is such that full scale (±10 V) is the feed set
//! for it. A velocity beyond the axis' largest is held at that; the [`Follower`] keeps acceleration and jerk.

use super::Setpoint;
use super::follower::{self, Follower};
use super::profile::Limits;
use super::ratio::Factor;
use crate::narrowing::within_or_high;
use crate::parameter_table;
use crate::parameter_table::ParameterTable;
use crate::units::{AxisScale, Command, Position, RangeError, Velocity};

parameter_table! {
    /// Analog velocity command.
    pub struct AnalogParams {
        /// Feed at full scale; negative turns the direction round
        analog_full_scale_mm_per_min: 9000.0, "mm/min", -1e6..=1e6;
        /// What is read while zero is commanded
        analog_offset: 0.0, "of full scale", -0.5..=0.5;
        /// Command that is taken for zero, to either side
        analog_deadband: 0.001, "of full scale", 0.0..=0.2;
    }
}

/// Quantised parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// 2⁻³⁰ of full scale.
    offset: i32,
    deadband: i32,
    /// From a command beyond the deadband, Q2.30, to a velocity, Q12.20 d/tick.
    scale: Factor,
    /// Largest velocity, 2⁻²⁰ d/tick.
    largest: i32,
}

/// Power of two between the formats.
const COMMAND_TO_VELOCITY: i32 =
    Velocity::FRAC_NBITS.cast_signed() - Command::FRAC_NBITS.cast_signed();

impl AnalogParams {
    /// Validates and quantises, for an axis whose largest velocity is `largest`.
    ///
    /// # Errors
    /// [`RangeError`] naming the parameter that is out of range.
    pub fn quantise(&self, scale: AxisScale, largest: Velocity) -> Result<Config, RangeError> {
        self.check()?;
        let velocity = scale.velocity_from_feed(self.analog_full_scale_mm_per_min)?;
        let command = |value: f64| Command::saturating_from_num(value).to_bits();
        Ok(Config {
            offset: command(self.analog_offset),
            deadband: command(self.analog_deadband),
            scale: Factor::new(libm::ldexp(
                velocity / (1.0 - self.analog_deadband),
                COMMAND_TO_VELOCITY,
            )),
            largest: largest.to_bits(),
        })
    }
}

impl Config {
    /// The velocity that `command` asks for.
    #[must_use]
    pub fn velocity(&self, command: Command) -> Velocity {
        let given = command.to_bits().saturating_sub(self.offset);
        let beyond = if given > self.deadband {
            given.wrapping_sub(self.deadband)
        } else if given < self.deadband.wrapping_neg() {
            given.wrapping_add(self.deadband)
        } else {
            0
        };
        let velocity = self.scale.of(beyond);
        let largest = i64::from(self.largest);
        Velocity::from_bits(within_or_high(velocity, largest.wrapping_neg(), largest) as i32)
    }
}

/// The setpoint by the analog command.
#[derive(Clone, Debug)]
pub struct Analog {
    config: Config,
    follower: Follower,
}

impl Analog {
    /// Standing at 0 d, within `limits`.
    #[must_use]
    pub fn new(config: Config, limits: &Limits) -> Self {
        Self {
            config,
            follower: Follower::new(follower::Config::new(limits)),
        }
    }

    /// Takes over an axis that stands at `position`.
    pub fn start(&mut self, position: Position) {
        self.follower.stand(position);
    }

    /// Takes other parameters; a motion goes over to them within the limits.
    pub fn reconfigure(&mut self, config: Config, limits: &Limits) {
        self.config = config;
        self.follower.reconfigure(follower::Config::new(limits));
    }

    /// True until the setpoint stands.
    #[must_use]
    pub const fn is_moving(&self) -> bool {
        !self.follower.is_at_rest()
    }

    /// The setpoint of this tick.
    pub fn step(&mut self, command: Command) -> Setpoint {
        self.follower.step(self.config.velocity(command))
    }
}
