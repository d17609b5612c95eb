//! A velocity follower in the tick: to any velocity, within limits of acceleration and jerk.
//!
//! In a tick the acceleration goes from a to a′, |a′ − a| ≤ j, so v += (a + a′)/2. The least that v still gains
//! after that, by taking a′ back to zero a full j a tick, makes with a′/2 of the tick itself
//!
//! G(a′) = Σₖ max(a′ − k·j, 0) = j·n(n + 1)/2 + (n + 1)(a′ − n·j), n = ⌊a′/j⌋.
//!
//! So a′ is the largest acceleration with G(a′) ≤ E = target − v − a/2, within a ± j and the limit. One tick later
//! E has become E − a′, and G(a′ − j) = G(a′) − a′: what fits once fits on. Below E = j the equation is a′ = E,
//! solved exactly, so that v meets its target with a = 0 and without overshoot; further up it is solved from below,
//! by a 32-bit division, and what is missing is made up in the ticks that follow.
//!
//! State is whole units of 2⁻⁴⁸ d, as in [`trajectory`](super::trajectory); the acceleration is even.

mod config;
mod stopping;

pub use config::Config;

use super::profile::STATE_FRAC;
use super::{Setpoint, Turn};
use crate::units::{Acceleration, Jerk, Position, Velocity};

const POSITION_SHIFT: u32 = STATE_FRAC - Position::FRAC_NBITS;
const VELOCITY_SHIFT: u32 = STATE_FRAC - Velocity::FRAC_NBITS;
const ACCELERATION_SHIFT: u32 = STATE_FRAC - Acceleration::FRAC_NBITS;
const JERK_SHIFT: u32 = STATE_FRAC - Jerk::FRAC_NBITS;
/// Where the velocity saturates, so that it stays in its format.
const TOP_SPEED: i64 = 2047 << STATE_FRAC;
/// 2³²/6.
const SIXTH: i64 = 715_827_883;

/// A follower: where it is, and the acceleration it goes to.
#[derive(Clone, Debug)]
pub struct Follower {
    config: Config,
    /// Position, 2⁻⁴⁸ d.
    position: i128,
    /// Velocity, 2⁻⁴⁸ d/tick.
    velocity: i64,
    /// Acceleration, 2⁻⁴⁸ d/tick²; even.
    acceleration: i64,
    /// Acceleration at the next tick; even.
    next_acceleration: i64,
}

impl Follower {
    /// A follower that stands at 0 d.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            position: 0,
            velocity: 0,
            acceleration: 0,
            next_acceleration: 0,
        }
    }

    /// Takes other limits; a greater acceleration is left by the jerk of the new ones.
    pub const fn reconfigure(&mut self, config: Config) {
        self.config = config;
    }

    /// The limits in force.
    #[must_use]
    pub const fn config(&self) -> &Config {
        &self.config
    }

    /// Goes on from `last`, the setpoint of the tick before the next [`step`](Self::step): the jerk it announced is
    /// kept for that tick, as far as the limits allow.
    pub fn take_over(&mut self, last: &Setpoint) {
        self.position = i128::from(last.position.to_bits()).wrapping_shl(POSITION_SHIFT);
        self.velocity = i64::from(last.velocity.to_bits()).wrapping_shl(VELOCITY_SHIFT);
        self.acceleration = i64::from(last.acceleration.to_bits()).wrapping_shl(ACCELERATION_SHIFT);
        let jerk = i64::from(last.jerk.to_bits()).wrapping_shl(JERK_SHIFT);
        self.next_acceleration = self.config.announced(self.acceleration, jerk);
    }

    /// Ends all motion and stands at `position`.
    pub fn stand(&mut self, position: Position) {
        self.take_over(&Setpoint {
            position,
            ..Setpoint::default()
        });
    }

    /// The setpoint of the next tick; the jerk it announces leads to `target`.
    pub fn step(&mut self, target: Velocity) -> Setpoint {
        self.advance();
        let target = i64::from(target.to_bits())
            .wrapping_shl(VELOCITY_SHIFT)
            .clamp(-TOP_SPEED, TOP_SPEED);
        let gap = target
            .wrapping_sub(self.velocity)
            .wrapping_sub(self.acceleration.wrapping_shr(1));
        self.next_acceleration = self.config.next_acceleration(gap, self.acceleration);
        if self.acceleration == 0 && self.next_acceleration == 0 {
            // An odd unit, which no even acceleration could cover.
            self.velocity = target;
        }
        self.setpoint()
    }

    /// True if it stands and will stand.
    #[must_use]
    pub const fn is_at_rest(&self) -> bool {
        self.is_settled(Velocity::ZERO)
    }

    /// True if it moves at `target` exactly, without acceleration.
    #[must_use]
    pub const fn is_settled(&self, target: Velocity) -> bool {
        self.velocity == (target.to_bits() as i64).wrapping_shl(VELOCITY_SHIFT)
            && self.acceleration == 0
            && self.next_acceleration == 0
    }

    /// The setpoint of the last step.
    #[must_use]
    pub fn now(&self) -> Setpoint {
        self.setpoint()
    }

    /// See [`Config::stopping_distance`].
    #[must_use]
    pub fn stopping_distance(&self, setpoint: &Setpoint) -> Position {
        self.config.stopping_distance(setpoint)
    }

    fn advance(&mut self) {
        let jerk = self.next_acceleration.wrapping_sub(self.acceleration);
        let sixth = jerk
            .wrapping_shr(JERK_SHIFT)
            .wrapping_mul(SIXTH)
            .wrapping_shr(32)
            .wrapping_shl(JERK_SHIFT);
        let step = self
            .velocity
            .wrapping_add(self.acceleration.wrapping_shr(1))
            .wrapping_add(sixth);
        self.position = self.position.wrapping_add(i128::from(step));
        self.velocity = self
            .velocity
            .wrapping_add(self.acceleration.wrapping_shr(1))
            .wrapping_add(self.next_acceleration.wrapping_shr(1));
        self.acceleration = self.next_acceleration;
        if self.velocity.unsigned_abs() > TOP_SPEED.unsigned_abs() {
            self.saturate();
        }
    }

    /// The format is used up: only a state beyond the limits that was taken over comes here.
    #[cold]
    fn saturate(&mut self) {
        self.velocity = self.velocity.clamp(-TOP_SPEED, TOP_SPEED);
        self.acceleration = 0;
    }

    fn setpoint(&self) -> Setpoint {
        let jerk = self.next_acceleration.wrapping_sub(self.acceleration);
        Setpoint {
            position: Position::from_bits(
                self.position
                    .wrapping_add(1 << (POSITION_SHIFT - 1))
                    .wrapping_shr(POSITION_SHIFT) as i64,
            ),
            velocity: Velocity::from_bits(rounded::<VELOCITY_SHIFT>(self.velocity)),
            acceleration: Acceleration::from_bits(rounded::<ACCELERATION_SHIFT>(self.acceleration)),
            jerk: Jerk::from_bits(rounded::<JERK_SHIFT>(jerk)),
            turn: Turn::NONE,
        }
    }
}

/// `value` / 2^`BITS` to nearest.
const fn rounded<const BITS: u32>(value: i64) -> i32 {
    value
        .wrapping_add(1_i64.wrapping_shl(BITS.wrapping_sub(1)))
        .wrapping_shr(BITS) as i32
}
