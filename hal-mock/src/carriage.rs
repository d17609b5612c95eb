//! What lies between the screw and the carriage: screw error, backlash, compliance.

use leadscrew::parameter_table::ParameterTable;
use leadscrew::units::{AxisScale, RangeError};

use crate::arc::State;
use crate::play::Play;
use crate::wave::sine;

leadscrew::parameter_table! {
    /// The carriage of the 16K20F3 on its screw.
    pub struct CarriageParams {
        /// Travel per revolution of the screw
        pitch_mm: 10.0, "mm", 0.1..=1000.0;
        /// Resonance of the carriage on the screw's compliance; 0 for a rigid one
        resonance_hz: 60.0, "Hz", 0.0..=1e4;
        /// Damping ratio of that resonance
        resonance_damping: 0.05, "1", 0.0..=2.0;
        /// Error of the screw that grows with travel
        screw_error_per_m: 0.026_667, "mm/m", -10.0..=10.0;
        /// Amplitude of the screw's error once a revolution
        screw_wobble_mm: 0.002, "mm", 0.0..=1.0;
        /// Play between screw and carriage, outside the loop
        backlash_mm: 0.0, "mm", 0.0..=1.0;
    }
}

impl CarriageParams {
    /// A carriage that is where the shaft says: rigid, without error and play.
    #[must_use]
    pub fn bare(self) -> Self {
        Self {
            resonance_hz: 0.0,
            screw_error_per_m: 0.0,
            screw_wobble_mm: 0.0,
            backlash_mm: 0.0,
            ..self
        }
    }
}

/// The carriage.
#[derive(Clone, Debug)]
pub struct Carriage {
    revolution: f64,
    slope: f64,
    wobble: f64,
    play: Play,
    stiffness: f64,
    damping_rate: f64,
    driver: State,
    state: State,
}

impl Carriage {
    /// A carriage at rest where the shaft's `position` (d) puts it.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(
        params: &CarriageParams,
        scale: AxisScale,
        position: f64,
    ) -> Result<Self, RangeError> {
        params.check()?;
        let omega = core::f64::consts::TAU * params.resonance_hz / scale.tick_hz();
        let mut carriage = Self {
            revolution: scale.counts_from_mm(params.pitch_mm),
            slope: params.screw_error_per_m / 1000.0,
            wobble: scale.counts_from_mm(params.screw_wobble_mm),
            play: Play::new(scale.counts_from_mm(params.backlash_mm), position),
            stiffness: omega * omega,
            damping_rate: params.resonance_damping * omega,
            driver: State::default(),
            state: State::default(),
        };
        carriage.driver.position = carriage.nut(position);
        carriage.state.position = carriage.driver.position;
        Ok(carriage)
    }

    /// State of the carriage, d and ticks.
    #[must_use]
    pub const fn state(&self) -> State {
        self.state
    }

    /// Follows the shaft to the end of a tick.
    pub fn step(&mut self, shaft: State) {
        let position = self.nut(shaft.position);
        let driver = State {
            position,
            velocity: position - self.driver.position,
            acceleration: 0.0,
        };
        if self.stiffness == 0.0 {
            let acceleration = driver.velocity - self.state.velocity;
            self.state = State {
                acceleration,
                ..driver
            };
        } else {
            self.swing(driver);
        }
        self.driver = driver;
    }

    /// Where the nut would put a rigid carriage.
    fn nut(&mut self, shaft: f64) -> f64 {
        let (driven, _) = self.play.follow(shaft);
        let wobble = if self.wobble == 0.0 {
            0.0
        } else {
            self.wobble * sine(driven / self.revolution)
        };
        driven + self.slope * driven + wobble
    }

    /// The resonance, by the trapezoidal rule: x″ = ω²(d − x) + 2ζω(d′ − x′).
    fn swing(&mut self, driver: State) {
        let State {
            position,
            velocity,
            acceleration,
        } = self.state;
        let quarter = 0.25 * self.stiffness;
        let reached = position + velocity + 0.25 * acceleration;
        let speed = velocity + 0.5 * acceleration;
        let pull = self.stiffness * (driver.position - reached)
            + 2.0 * self.damping_rate * (driver.velocity - speed);
        let next = pull / (1.0 + self.damping_rate + quarter);
        let mean = 0.5 * (acceleration + next);
        self.state = State {
            position: position + velocity + 0.5 * mean,
            velocity: velocity + mean,
            acceleration: next,
        };
    }
}
