//! The velocity drive with its motor and screw: from the ±10 V command to the motion of the shaft.
//!
//! v″ + 2ζω·v′ + ω²·v = ω²·(G·u − friction), |v′| limited, integrated by the trapezoidal rule, so that
//! the motion of a tick is exactly a cubic ([`Arc`]).

use leadscrew::parameter_table::ParameterTable;
use leadscrew::units::{AxisScale, Command, RangeError};

use crate::arc::{Arc, State};
use crate::wave::sine;

leadscrew::parameter_table! {
    /// The drive of the 16K20F3, longitudinal axis, with its imperfections.
    pub struct DriveParams {
        /// Feed at full command
        full_command_feed_mm_per_min: 9600.0, "mm/min", 0.001..=1e6;
        /// Natural period of the velocity response
        natural_period_s: 0.09, "s", 0.001..=10.0;
        /// Damping ratio of the velocity response
        damping: 0.5, "1", 0.01..=10.0;
        /// Largest acceleration
        max_acceleration_m_s2: 2.1, "m/s²", 0.001..=1e4;
        /// Smallest step of command that the drive answers to
        resolution: 1e-4, "of full command", 0.0..=0.1;
        /// Offset of the command input
        offset: -0.005, "of full command", -0.5..=0.5;
        /// Transport delay, rounded to whole ticks
        delay_s: 0.002, "s", 0.0..=0.1;
        /// Time without current at each reversal of the command
        dead_time_s: 0.005, "s", 0.0..=1.0;
        /// Amplitude of the tachogenerator's ripple
        ripple: 0.001, "of the speed", 0.0..=0.2;
        /// Frequency of the ripple
        ripple_hz: 300.0, "Hz", 0.0..=1e5;
        /// Kinetic friction, as the feed that the command loses
        friction_mm_per_min: 90.0, "mm/min", 0.0..=1e5;
        /// Static friction over kinetic friction
        stiction_ratio: 2.0, "1", 1.0..=10.0;
        /// Feed at which half of the excess of static over kinetic friction is gone (Stribeck)
        stribeck_mm_per_min: 60.0, "mm/min", 0.001..=1e5;
    }
}

impl DriveParams {
    /// The same drive without offset, delay, dead time, ripple and friction; its resolution and
    /// acceleration limit stay.
    #[must_use]
    pub fn bare(self) -> Self {
        Self {
            offset: 0.0,
            delay_s: 0.0,
            dead_time_s: 0.0,
            ripple: 0.0,
            friction_mm_per_min: 0.0,
            ..self
        }
    }
}

/// Most ticks of transport delay.
const MAX_DELAY: usize = 4096;

/// The drive and the shaft it turns.
#[derive(Clone, Debug)]
pub struct Drive {
    full_velocity: f64,
    stiffness: f64,
    damping_rate: f64,
    max_acceleration: f64,
    resolution: f64,
    steps_per_full: f64,
    offset: f64,
    dead_ticks: u32,
    ripple: f64,
    ripple_turns_per_tick: f64,
    kinetic: f64,
    excess: f64,
    stribeck: f64,

    shaft: State,
    line: [f32; MAX_DELAY],
    delay: usize,
    place: usize,
    /// Sign of the last command that was not zero, and what is left of the dead time after its change.
    sign: f64,
    dead_left: u32,
    ripple_phase: f64,
}

impl Drive {
    /// A drive at rest at `position` d.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(params: &DriveParams, scale: AxisScale, position: f64) -> Result<Self, RangeError> {
        params.check()?;
        let tick_hz = scale.tick_hz();
        let omega = core::f64::consts::TAU / (params.natural_period_s * tick_hz);
        let kinetic = scale.velocity_from_feed(params.friction_mm_per_min)?;
        Ok(Self {
            full_velocity: scale.velocity_from_feed(params.full_command_feed_mm_per_min)?,
            stiffness: omega * omega,
            damping_rate: params.damping * omega,
            max_acceleration: scale.acceleration_from_m_s2(params.max_acceleration_m_s2),
            resolution: params.resolution,
            steps_per_full: if params.resolution > 0.0 {
                1.0 / params.resolution
            } else {
                0.0
            },
            offset: params.offset,
            dead_ticks: (params.dead_time_s * tick_hz + 0.5) as u32,
            ripple: params.ripple,
            ripple_turns_per_tick: params.ripple_hz / tick_hz,
            kinetic,
            excess: kinetic * (params.stiction_ratio - 1.0),
            stribeck: scale.velocity_from_feed(params.stribeck_mm_per_min)?,
            shaft: State {
                position,
                ..State::default()
            },
            line: [0.0; MAX_DELAY],
            delay: ((params.delay_s * tick_hz + 0.5) as usize).min(MAX_DELAY - 1),
            place: 0,
            sign: 0.0,
            dead_left: 0,
            ripple_phase: 0.0,
        })
    }

    /// State of the shaft at the end of the last tick.
    #[must_use]
    pub const fn shaft(&self) -> State {
        self.shaft
    }

    /// Instantaneous ripple of the tachogenerator, as a share of the speed.
    #[must_use]
    pub fn ripple(&self) -> f64 {
        if self.ripple == 0.0 {
            0.0
        } else {
            self.ripple * sine(self.ripple_phase)
        }
    }

    /// Moves one tick under `command`; off (`enable` false) the drive brakes to a stop.
    pub fn step(&mut self, command: Command, enable: bool) -> Arc {
        let delayed = self.delayed(command);
        let wanted = if enable { self.answer(delayed) } else { 0.0 };
        let arc = if self.is_stuck(wanted) {
            self.rest()
        } else {
            self.accelerate(wanted)
        };
        self.shaft = arc.end();
        self.ripple_phase += self.ripple_turns_per_tick;
        if self.ripple_phase >= 1.0 {
            self.ripple_phase -= 1.0;
        }
        arc
    }

    fn delayed(&mut self, command: Command) -> f64 {
        // A command has at most 31 bits, but the drive resolves far fewer than the 24 kept here.
        self.line[self.place] = command.to_bits() as f32 * (1.0 / 1_073_741_824.0);
        let due = if self.place >= self.delay {
            self.place - self.delay
        } else {
            self.place + MAX_DELAY - self.delay
        };
        self.place = if self.place + 1 == MAX_DELAY {
            0
        } else {
            self.place + 1
        };
        f64::from(self.line[due])
    }

    /// The velocity that the drive aims at, d/tick.
    fn answer(&mut self, command: f64) -> f64 {
        let offset = command + self.offset;
        let steps = offset * self.steps_per_full;
        let rounded = (if steps < 0.0 {
            steps - 0.5
        } else {
            steps + 0.5
        }) as i64 as f64
            * self.resolution;
        let answered = if self.steps_per_full > 0.0 {
            rounded
        } else {
            offset
        };
        if answered * self.sign < 0.0 {
            self.dead_left = self.dead_ticks;
        }
        if answered != 0.0 {
            self.sign = answered;
        }
        if self.dead_left > 0 {
            self.dead_left -= 1;
            return 0.0;
        }
        answered * self.full_velocity
    }

    /// Friction in terms of the velocity that the drive aims at, opposing `direction`.
    fn friction(&self, direction: f64) -> f64 {
        if self.kinetic == 0.0 {
            return 0.0;
        }
        let relative = self.shaft.velocity / self.stribeck;
        let size = self.kinetic + self.excess / (1.0 + relative * relative);
        if direction < 0.0 { -size } else { size }
    }

    /// True if static friction holds the shaft, or catches it within this tick.
    fn is_stuck(&self, wanted: f64) -> bool {
        let held = self.kinetic + self.excess;
        let next = self.shaft.velocity + self.shaft.acceleration;
        held > 0.0 && wanted.abs() <= held && next * self.shaft.velocity <= 0.0
    }

    /// Comes to rest within the tick.
    fn rest(&self) -> Arc {
        let State {
            position, velocity, ..
        } = self.shaft;
        let mut arc = Arc {
            start: State {
                position,
                velocity,
                acceleration: -velocity,
            },
            jerk: 0.0,
        };
        if velocity == 0.0 {
            arc.start.acceleration = 0.0;
        }
        arc
    }

    fn accelerate(&self, wanted: f64) -> Arc {
        let State {
            velocity,
            acceleration,
            ..
        } = self.shaft;
        let direction = if velocity == 0.0 { wanted } else { velocity };
        let target = wanted - self.friction(direction);
        let seen = velocity * (1.0 + self.ripple());
        let quarter = 0.25 * self.stiffness;
        let kept = acceleration * (1.0 - self.damping_rate - quarter);
        let next = (kept + self.stiffness * (target - seen)) / (1.0 + self.damping_rate + quarter);
        let limit = self.max_acceleration;
        let next = if next > limit {
            limit
        } else if next < -limit {
            -limit
        } else {
            next
        };
        Arc {
            start: self.shaft,
            jerk: next - acceleration,
        }
    }
}
