//! The S-curve: seven phases of constant jerk, each of whole ticks.

use leadscrew::units::{RangeError, checked};

use super::course::advanced;
use crate::arc::{Arc, State};

/// A motion from rest to a velocity and, symmetrically, back to rest.
///
/// The phases last whole ticks; acceleration and jerk are what meets the velocity in them exactly, a little
/// below the limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SCurve {
    /// Velocity of the cruise, d/tick; negative in the other direction.
    pub velocity: f64,
    /// Largest acceleration, d/tick².
    pub acceleration: f64,
    /// Largest jerk, d/tick³.
    pub jerk: f64,
    /// Ticks at the full velocity.
    pub cruise_ticks: u32,
    /// Ticks at rest before the motion.
    pub rest_ticks: u32,
    /// After the motion, the same in the other direction, and so on; otherwise it stays at rest.
    pub there_and_back: bool,
}

/// Ticks of rest, the rise of the acceleration, its stay, its fall, the cruise, and the same three phases of the
/// way back to rest.
const PHASES: usize = 8;

/// Most ticks of a phase of acceleration.
const LONGEST_PHASE: u32 = 1 << 24;

/// An S-curve under way.
#[derive(Clone, Debug)]
pub struct SCurving {
    phases: [Phase; PHASES],
    phase: usize,
    /// Ticks left in the phase.
    left: u32,
    /// 1 or −1.
    direction: f64,
    there_and_back: bool,
    state: State,
}

/// A phase of the motion forward.
#[derive(Clone, Copy, Debug)]
struct Phase {
    ticks: u32,
    jerk: f64,
    /// At its start.
    velocity: f64,
    acceleration: f64,
}

impl SCurve {
    /// Ticks from the start of the motion to rest again, the rest before it not counted.
    ///
    /// # Errors
    /// A limit out of range.
    pub fn motion_ticks(&self) -> Result<u32, RangeError> {
        let (rise, stay) = self.rise_and_stay()?;
        Ok(2 * (2 * rise + stay) + self.cruise_ticks)
    }

    /// Ticks in which the acceleration rises, and in which it stays.
    fn rise_and_stay(&self) -> Result<(u32, u32), RangeError> {
        let speed = self.velocity.max(-self.velocity);
        checked("velocity", speed, 0.0, 1e4)?;
        let acceleration = checked("acceleration", self.acceleration, 1e-6, 1e4)?;
        let jerk = checked("jerk", self.jerk, 1e-9, 1e4)?;
        // As long as the jerk allows for the largest acceleration, or for the velocity without a stay.
        let rise = least(|ticks| {
            let gain = jerk * ticks * BARELY_MORE;
            gain >= acceleration || gain * ticks >= speed
        });
        let stay = least(|ticks| acceleration * (f64::from(rise) + ticks) * BARELY_MORE >= speed);
        Ok((rise.max(1), stay))
    }

    fn phases(&self) -> Result<[Phase; PHASES], RangeError> {
        let (rise, stay) = self.rise_and_stay()?;
        let speed = self.velocity.max(-self.velocity);
        let acceleration = speed / f64::from(rise + stay);
        let jerk = acceleration / f64::from(rise);
        // The velocity at the end of the rise; it is as far from the full one at the end of the stay.
        let low = 0.5 * acceleration * f64::from(rise);
        let high = speed - low;
        let phase = |ticks, jerk, velocity, acceleration| Phase {
            ticks,
            jerk,
            velocity,
            acceleration,
        };
        Ok([
            phase(self.rest_ticks, 0.0, 0.0, 0.0),
            phase(rise, jerk, 0.0, 0.0),
            phase(stay, 0.0, low, acceleration),
            phase(rise, -jerk, high, acceleration),
            phase(self.cruise_ticks, 0.0, speed, 0.0),
            phase(rise, -jerk, speed, 0.0),
            phase(stay, 0.0, high, -acceleration),
            phase(rise, jerk, low, -acceleration),
        ])
    }
}

impl SCurving {
    /// The S-curve from `start_d` on.
    pub fn new(curve: &SCurve, start_d: f64) -> Result<Self, RangeError> {
        let phases = curve.phases()?;
        Ok(Self {
            phases,
            phase: 0,
            left: phases[0].ticks,
            direction: if curve.velocity < 0.0 { -1.0 } else { 1.0 },
            there_and_back: curve.there_and_back,
            state: State {
                position: start_d,
                ..State::default()
            },
        })
    }

    /// The state at the start of the tick to come.
    pub const fn state(&self) -> State {
        self.state
    }

    /// The arc of the next tick.
    pub fn next_arc(&mut self) -> Arc {
        while self.left == 0 {
            self.begin_next();
        }
        self.left -= 1;
        advanced(
            &mut self.state,
            self.direction * self.phases[self.phase].jerk,
        )
    }

    fn begin_next(&mut self) {
        self.phase += 1;
        if self.phase == PHASES {
            self.phase = 0;
            self.direction = -self.direction;
        }
        let phase = &self.phases[self.phase];
        self.left = if self.phase == 0 && !self.there_and_back {
            u32::MAX
        } else {
            phase.ticks
        };
        // As planned, so that rounding does not add up: rest is rest.
        self.state.velocity = self.direction * phase.velocity;
        self.state.acceleration = self.direction * phase.acceleration;
    }
}

/// A quotient that is whole but for its rounding counts as whole.
const BARELY_MORE: f64 = 1.0 + 1e-12;

/// The least number of ticks, up to [`LONGEST_PHASE`], for which `is_enough`, which holds from there on.
fn least(is_enough: impl Fn(f64) -> bool) -> u32 {
    let (mut low, mut high) = (0, LONGEST_PHASE);
    while low < high {
        let middle = low.midpoint(high);
        if is_enough(f64::from(middle)) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    low
}
