//! The velocity drive with its motor and screw: from the ±10 V command to the motion of the shaft.
//!
//! v″ + 2ζω·v′ + ω²·v = ω²·(G·u − friction), |v′| limited, integrated by the trapezoidal rule, so that
//! the motion of a tick is exactly a cubic ([`Arc`]).
//!
//! The state of the shaft is f64. What moves it (the gap between aim and velocity, friction, ripple) is
//! f32, for which the target has hardware: 1e-7 of an acceleration is lost.

mod friction;
mod response;

use leadscrew::parameter_table::ParameterTable;
use leadscrew::units::{AxisScale, Command, RangeError};

use self::friction::Friction;
use self::response::Response;
use crate::arc::{Arc, State};
use crate::wave::{Phase, phase, sine};

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
        /// Time for which a reversal of the command is answered by standstill
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

/// What has the shaft besides the drive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Grip {
    /// Nothing.
    #[default]
    None,
    /// A brake, which slows it down by so many d/tick² and then holds it.
    Braked(f64),
    /// A load, which accelerates it by so many d/tick².
    Falling(f64),
}

/// Most ticks of transport delay; a power of two, so that a place that wraps stays in step.
const MAX_DELAY: usize = 4096;
/// Finest resolution that an f32 of the command has.
const FINEST_RESOLUTION: f64 = 1e-7;

/// The drive and the shaft it turns.
#[derive(Clone, Debug)]
pub struct Drive {
    full_velocity: f64,
    response: Response,
    max_acceleration: f64,
    offset: f32,
    /// `None` if the command is not stepped.
    steps: Option<Steps>,
    dead_ticks: u32,
    ripple_amplitude: f32,
    ripple_step: Phase,
    friction: Option<Friction>,

    shaft: State,
    line: [f32; MAX_DELAY],
    delay: usize,
    place: usize,
    /// Sign of the last command that was not zero, and what is left of the dead time after its change.
    sign: i32,
    dead_left: u32,
    ripple_phase: Phase,
    /// Ripple in the tick to come.
    ripple: f32,
}

impl Drive {
    /// A drive at rest at `position` d.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(params: &DriveParams, scale: AxisScale, position: f64) -> Result<Self, RangeError> {
        params.check()?;
        let tick_hz = scale.tick_hz();
        let full_velocity = scale.velocity_from_feed(params.full_command_feed_mm_per_min)?;
        Ok(Self {
            full_velocity,
            response: Response::new(params, tick_hz),
            max_acceleration: scale.acceleration_from_m_s2(params.max_acceleration_m_s2),
            offset: params.offset as f32,
            steps: Steps::new(params.resolution, full_velocity),
            dead_ticks: (params.dead_time_s * tick_hz + 0.5) as u32,
            ripple_amplitude: params.ripple as f32,
            ripple_step: phase(params.ripple_hz / tick_hz),
            friction: Friction::new(params, scale)?,
            shaft: State {
                position,
                ..State::default()
            },
            line: [0.0; MAX_DELAY],
            delay: ((params.delay_s * tick_hz + 0.5) as usize).min(MAX_DELAY - 1),
            place: 0,
            sign: 0,
            dead_left: 0,
            ripple_phase: 0,
            ripple: 0.0,
        })
    }

    /// State of the shaft at the end of the last tick; held by static friction, it has no acceleration.
    #[must_use]
    pub const fn shaft(&self) -> State {
        self.shaft
    }

    /// Instantaneous ripple of the tachogenerator, as a share of the speed.
    #[must_use]
    pub fn ripple(&self) -> f64 {
        f64::from(self.ripple)
    }

    /// Moves one tick under `command`; off (`enable` false) the drive brakes to a stop.
    pub fn step(&mut self, command: Command, enable: bool) -> Arc {
        self.step_gripped(command, enable, Grip::None)
    }

    /// The same with what grips the shaft besides the drive.
    pub fn step_gripped(&mut self, command: Command, enable: bool, grip: Grip) -> Arc {
        let delayed = self.delayed(command);
        let wanted = if enable { self.answer(delayed) } else { 0.0 };
        let arc = if let Some(arc) = self.gripped(grip) {
            self.shaft = arc.end();
            // A grip ends with the tick.
            self.shaft.acceleration = 0.0;
            arc
        } else if self.is_stuck(wanted) {
            let arc = self.rest();
            // What stopped the shaft ends with its motion: the next start is from rest.
            self.shaft = State {
                position: arc.end().position,
                ..State::default()
            };
            arc
        } else {
            let arc = self.accelerate(wanted);
            self.shaft = arc.end();
            arc
        };
        if self.ripple_amplitude != 0.0 {
            self.ripple_phase = self.ripple_phase.wrapping_add(self.ripple_step);
            self.ripple = self.ripple_amplitude * sine(self.ripple_phase);
        }
        arc
    }

    fn delayed(&mut self, command: Command) -> f32 {
        // A command has at most 31 bits, but the drive resolves far fewer than the 24 kept here.
        self.line[self.place % MAX_DELAY] = command.to_bits() as f32 * (1.0 / 1_073_741_824.0);
        let due = self.place.wrapping_sub(self.delay);
        self.place = self.place.wrapping_add(1);
        self.line[due % MAX_DELAY]
    }

    /// The velocity that the drive aims at, d/tick.
    fn answer(&mut self, command: f32) -> f64 {
        let command = command + self.offset;
        let (sign, answered) = match &self.steps {
            Some(steps) => {
                let whole = steps.nearest(command);
                (whole.signum(), f64::from(whole) * steps.velocity)
            }
            None => (sign(command), f64::from(command) * self.full_velocity),
        };
        if sign * self.sign < 0 {
            self.dead_left = self.dead_ticks;
        }
        if sign != 0 {
            self.sign = sign;
        }
        if self.dead_left > 0 {
            self.dead_left -= 1;
            return 0.0;
        }
        answered
    }

    /// True if static friction holds the shaft, or catches it within this tick: where its velocity would change sign, unless the
    /// drive pulls it the other way by more than friction holds.
    fn is_stuck(&self, wanted: f64) -> bool {
        let State {
            velocity,
            acceleration,
            ..
        } = self.shaft;
        let Some(friction) = &self.friction else {
            return false;
        };
        let wanted = wanted as f32;
        let is_held = wanted.abs() <= friction.held;
        if velocity == 0.0 {
            return is_held;
        }
        // Signs first: on the target they cost a fraction of an f64 product.
        let backward = velocity.is_sign_negative();
        if backward == acceleration.is_sign_negative() {
            return false;
        }
        let pulls_on = wanted.is_sign_negative() == backward;
        (is_held || pulls_on) && (velocity + acceleration) * velocity <= 0.0
    }

    /// The motion of a tick in which something stronger than the drive has the shaft.
    fn gripped(&self, grip: Grip) -> Option<Arc> {
        let State {
            position, velocity, ..
        } = self.shaft;
        let acceleration = match grip {
            Grip::None => return None,
            Grip::Braked(deceleration) => -velocity.clamp(-deceleration, deceleration),
            Grip::Falling(acceleration) => acceleration,
        };
        let start = State {
            position,
            velocity,
            acceleration,
        };
        Some(Arc { start, jerk: 0.0 })
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
        let mut gap = (wanted - velocity) as f32;
        let speed = velocity as f32;
        if let Some(friction) = &self.friction {
            let direction = if velocity == 0.0 { gap } else { speed };
            gap -= friction.at(speed).copysign(direction);
        }
        gap -= speed * self.ripple;
        let next = self.limited(self.response.next(acceleration as f32, gap));
        Arc {
            start: self.shaft,
            jerk: next - acceleration,
        }
    }

    /// An acceleration within the limit, which is not rounded.
    fn limited(&self, acceleration: f32) -> f64 {
        let limit = self.max_acceleration as f32;
        if acceleration >= limit {
            self.max_acceleration
        } else if acceleration <= -limit {
            -self.max_acceleration
        } else {
            f64::from(acceleration)
        }
    }
}

/// The steps of command that the drive answers to.
#[derive(Clone, Debug)]
struct Steps {
    per_full: f32,
    /// Velocity of a step, d/tick.
    velocity: f64,
}

impl Steps {
    fn new(resolution: f64, full_velocity: f64) -> Option<Self> {
        (resolution >= FINEST_RESOLUTION).then(|| Self {
            per_full: (1.0 / resolution) as f32,
            velocity: resolution * full_velocity,
        })
    }

    fn nearest(&self, command: f32) -> i32 {
        let steps = command * self.per_full;
        (steps + 0.5_f32.copysign(steps)) as i32
    }
}

fn sign(value: f32) -> i32 {
    i32::from(value > 0.0) - i32::from(value < 0.0)
}
