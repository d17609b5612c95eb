//! Motions to and fro.

use leadscrew::units::{RangeError, checked};

use crate::arc::{Arc, State};
use crate::wave::Rotor;

/// A sine of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swing {
    /// Amplitude, d.
    pub amplitude: f64,
    /// Period, ticks.
    pub period_ticks: f64,
    /// Where in its period it starts, turns.
    pub phase_turns: f64,
}

impl Swing {
    pub(super) const fn reversed(self) -> Self {
        Self {
            amplitude: -self.amplitude,
            ..self
        }
    }
}

/// A swing under way.
#[derive(Clone, Copy, Debug, Default)]
struct Pendulum {
    amplitude: f64,
    /// Radians a tick.
    omega: f64,
    rotor: Rotor,
}

impl Pendulum {
    fn new(swing: &Swing) -> Result<Self, RangeError> {
        let amplitude = checked("amplitude", swing.amplitude, -1e6, 1e6)?;
        let period = checked("period_ticks", swing.period_ticks, 8.0, 1e9)?;
        let turns = checked("phase_turns", swing.phase_turns, -1.0, 1.0)?;
        Ok(Self {
            amplitude,
            omega: core::f64::consts::TAU / period,
            rotor: Rotor::new(turns, 1.0 / period),
        })
    }

    fn position(&self) -> f64 {
        self.amplitude * self.rotor.sine()
    }

    fn velocity(&self) -> f64 {
        self.amplitude * self.omega * self.rotor.cosine()
    }

    fn acceleration(&self) -> f64 {
        -self.omega * self.omega * self.position()
    }
}

/// A steady motion with swings on it.
#[derive(Clone, Debug)]
pub struct Swaying {
    /// Position of the steady motion.
    middle: f64,
    velocity: f64,
    pendulums: [Pendulum; 2],
    state: State,
}

impl Swaying {
    /// The motion from `start_d` on, with up to two swings.
    pub fn new(velocity: f64, swings: &[Swing], start_d: f64) -> Result<Self, RangeError> {
        let mut pendulums = [Pendulum::default(); 2];
        for (pendulum, swing) in pendulums.iter_mut().zip(swings) {
            *pendulum = Pendulum::new(swing)?;
        }
        let mut swaying = Self {
            middle: start_d,
            velocity,
            pendulums,
            state: State::default(),
        };
        swaying.middle -= swaying.sum(Pendulum::position);
        swaying.state = State {
            position: start_d,
            velocity: velocity + swaying.sum(Pendulum::velocity),
            acceleration: swaying.sum(Pendulum::acceleration),
        };
        Ok(swaying)
    }

    /// The state at the start.
    pub const fn start(&self) -> State {
        self.state
    }

    /// The arc of the next tick: it joins exact positions and velocities, and meets the acceleration to a
    /// twelfth of the fourth derivative at both its ends, so that neighbours meet much better.
    pub fn next_arc(&mut self) -> Arc {
        let from = (self.state.position, self.state.velocity);
        self.middle += self.velocity;
        for pendulum in &mut self.pendulums {
            pendulum.rotor.turn();
        }
        self.state.position = self.middle + self.sum(Pendulum::position);
        self.state.velocity = self.velocity + self.sum(Pendulum::velocity);
        Arc::joining(from, (self.state.position, self.state.velocity))
    }

    fn sum(&self, of: impl Fn(&Pendulum) -> f64) -> f64 {
        of(&self.pendulums[0]) + of(&self.pendulums[1])
    }
}
