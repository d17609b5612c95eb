//! A motion under way: the arc of each tick.

use leadscrew::units::RangeError;

use super::Motion;
use super::s_curve::SCurving;
use super::swing::Swaying;
use crate::arc::{Arc, State};

/// A motion, and how far it has come.
#[derive(Clone, Debug)]
pub enum Course {
    /// Constant jerk.
    Free { state: State, jerk: f64 },
    /// Constant deceleration to a stop.
    Coasting { state: State },
    /// Phases of constant jerk.
    SCurving(SCurving),
    /// Steady and to and fro.
    Swaying(Swaying),
}

impl Course {
    /// The motion from `start_d` on.
    pub fn new(motion: Motion, start_d: f64) -> Result<Self, RangeError> {
        let state = |velocity, acceleration| State {
            position: start_d,
            velocity,
            acceleration,
        };
        let free = |state, jerk| Self::Free { state, jerk };
        Ok(match motion {
            Motion::Steady { velocity } => free(state(velocity, 0.0), 0.0),
            Motion::Ramp {
                velocity,
                acceleration,
            } => free(state(velocity, acceleration), 0.0),
            Motion::Jerk { jerk } => free(state(0.0, 0.0), jerk),
            Motion::Coast {
                velocity,
                deceleration,
            } => Self::Coasting {
                state: state(velocity, -deceleration),
            },
            Motion::SCurve(curve) => Self::SCurving(SCurving::new(&curve, start_d)?),
            Motion::Sine(swing) => Self::Swaying(Swaying::new(0.0, &[swing], start_d)?),
            Motion::Feed {
                velocity,
                wobble,
                drift,
            } => Self::Swaying(Swaying::new(velocity, &[wobble, drift], start_d)?),
        })
    }

    /// The state at the start.
    pub const fn start(&self) -> State {
        match self {
            Self::Free { state, .. } | Self::Coasting { state } => *state,
            Self::SCurving(curve) => curve.state(),
            Self::Swaying(swaying) => swaying.start(),
        }
    }

    /// The arc of the next tick.
    pub fn next_arc(&mut self) -> Arc {
        match self {
            Self::Free { state, jerk } => advanced(state, *jerk),
            Self::Coasting { state } => {
                let size = |value: f64| value.max(-value);
                if size(state.velocity) <= size(state.acceleration) {
                    // The last tick of motion ends at rest.
                    state.acceleration = -state.velocity;
                }
                advanced(state, 0.0)
            }
            Self::SCurving(curve) => curve.next_arc(),
            Self::Swaying(swaying) => swaying.next_arc(),
        }
    }
}

/// The arc of constant jerk from `state` on, which moves to its end.
pub fn advanced(state: &mut State, jerk: f64) -> Arc {
    let arc = Arc {
        start: *state,
        jerk,
    };
    *state = arc.end();
    arc
}
