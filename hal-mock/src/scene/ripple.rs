//! A ripple that keeps to the angle of the shaft, as a belt, a gear or the drive's poles make it.
//!
//! On the axis itself it cannot be told from an error of the encoder.

use leadscrew::units::{RangeError, checked};

use crate::arc::{Arc, State};
use crate::wave::{phase, sine};

/// A sine of the shaft's angle on a motion: position + amplitude·sin(order·angle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ripple {
    /// Amplitude, d; 0 for none.
    pub amplitude: f64,
    /// Periods a revolution.
    pub order: f64,
}

impl Ripple {
    /// None.
    pub const NONE: Self = Self {
        amplitude: 0.0,
        order: 0.0,
    };

    /// The reference ripple: 0.02 d at 2 a revolution.
    pub const TWICE_A_REVOLUTION: Self = Self {
        amplitude: 0.02,
        order: 2.0,
    };
}

/// A ripple under way.
#[derive(Clone, Copy, Debug)]
pub struct Rippling {
    amplitude: f64,
    turns_per_d: f64,
    /// Position and velocity at the end of the last tick.
    end: (f64, f64),
}

impl Rippling {
    /// The ripple on a motion that starts at `smooth`; `None` if there is none.
    pub fn new(
        ripple: Ripple,
        edges_per_revolution: f64,
        smooth: State,
    ) -> Result<Option<Self>, RangeError> {
        let amplitude = checked("amplitude", ripple.amplitude, -10.0, 10.0)?;
        let order = checked("order", ripple.order, 0.0, 100.0)?;
        let mut rippling = Self {
            amplitude,
            turns_per_d: order / edges_per_revolution,
            end: (0.0, 0.0),
        };
        rippling.end = rippling.on(smooth);
        Ok((amplitude != 0.0).then_some(rippling))
    }

    /// The state at the start, on top of `smooth`.
    pub fn start(&self, smooth: State) -> State {
        let wave = core::f64::consts::TAU * self.turns_per_d;
        let (position, velocity) = self.end;
        let rise = velocity - smooth.velocity;
        let pull = wave * wave * smooth.velocity * smooth.velocity * (position - smooth.position);
        let share = if smooth.velocity == 0.0 {
            0.0
        } else {
            rise / smooth.velocity
        };
        State {
            position,
            velocity,
            acceleration: smooth.acceleration * (1.0 + share) - pull,
        }
    }

    /// The arc of a tick whose smooth motion ends at `smooth`.
    pub fn bend(&mut self, smooth: State) -> Arc {
        let from = self.end;
        self.end = self.on(smooth);
        Arc::joining(from, self.end)
    }

    /// Position and velocity with the ripple.
    fn on(&self, smooth: State) -> (f64, f64) {
        let angle = phase(smooth.position * self.turns_per_d);
        let wave = core::f64::consts::TAU * self.turns_per_d;
        let slope = self.amplitude * wave * f64::from(sine(angle.wrapping_add(QUARTER_TURN)));
        (
            smooth.position + self.amplitude * f64::from(sine(angle)),
            smooth.velocity * (1.0 + slope),
        )
    }
}

const QUARTER_TURN: u32 = 1 << 30;
