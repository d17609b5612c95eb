//! Prescribed motions for measuring estimators: an encoder on a shaft that does just what is said.

use leadscrew::hal::Capture;
use leadscrew::units::RangeError;

use crate::arc::{Arc, State};
use crate::encoder::{Encoder, EncoderModel};

/// A motion known beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// Constant velocity, d/tick.
    Steady {
        /// Velocity, d/tick.
        velocity: f64,
    },
    /// Constant acceleration from a velocity on, without end.
    Ramp {
        /// Velocity at first, d/tick.
        velocity: f64,
        /// Acceleration, d/tick².
        acceleration: f64,
    },
    /// Constant jerk from rest.
    Jerk {
        /// Jerk, d/tick³.
        jerk: f64,
    },
    /// A flywheel that coasts to a stop.
    Coast {
        /// Velocity at first, d/tick.
        velocity: f64,
        /// Loss of velocity, d/tick².
        deceleration: f64,
    },
}

impl Motion {
    /// P1's flywheel: from 20 d/tick at −0.006 d/tick².
    pub const FLYWHEEL: Self = Self::Coast {
        velocity: 20.0,
        deceleration: 0.006,
    };

    const fn start(self) -> State {
        let (velocity, acceleration) = match self {
            Self::Steady { velocity } => (velocity, 0.0),
            Self::Ramp {
                velocity,
                acceleration,
            } => (velocity, acceleration),
            Self::Jerk { .. } => (0.0, 0.0),
            Self::Coast {
                velocity,
                deceleration,
            } => (velocity, -deceleration),
        };
        State {
            position: 0.0,
            velocity,
            acceleration,
        }
    }

    fn arc(self, state: State) -> Arc {
        match self {
            Self::Jerk { jerk } => Arc { start: state, jerk },
            Self::Coast { deceleration, .. } if state.velocity <= deceleration => {
                // The last tick of motion ends at rest.
                let start = State {
                    acceleration: -state.velocity,
                    ..state
                };
                Arc { start, jerk: 0.0 }
            }
            _ => Arc {
                start: state,
                jerk: 0.0,
            },
        }
    }
}

/// An encoder on a prescribed motion.
#[derive(Clone, Debug)]
pub struct Scene {
    motion: Motion,
    /// The tick to come.
    arc: Arc,
    encoder: Encoder,
}

impl Scene {
    /// The encoder `model`, drawn by `seed`, at `start_d` on a shaft in `motion`.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(
        motion: Motion,
        model: &EncoderModel,
        tick_hz: f64,
        start_d: f64,
        seed: u64,
    ) -> Result<Self, RangeError> {
        let start = State {
            position: start_d,
            ..motion.start()
        };
        let encoder = Encoder::new(model, tick_hz, start_d, seed)?;
        Ok(Self {
            motion,
            arc: motion.arc(start),
            encoder,
        })
    }

    /// Moves one tick on.
    pub fn step(&mut self) {
        self.encoder.advance(&self.arc);
        self.arc = self.motion.arc(self.arc.end());
    }

    /// What the capture hardware saw in the last tick.
    #[must_use]
    pub fn capture(&self) -> Capture<'_> {
        self.encoder.capture()
    }

    /// The shaft at the last sampling instant.
    #[must_use]
    pub fn truth(&self) -> State {
        self.arc.at(-self.encoder.sampling_advance())
    }
}
