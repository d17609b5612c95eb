//! Evaluation of planned moves, tick by tick, without a rounding error.
//!
//! Within a tick the jerk is constant, so x += v + a/2 + j/6, v += a + j/2, a += j. With the jerk a
//! multiple of six units of 2⁻⁴⁸ d all of these are whole numbers, and the last setpoint of a move is
//! its target with velocity and acceleration zero, however many moves went before.

use core::fmt;

use super::Setpoint;
use super::profile::{Profile, STATE_FRAC, Segment};
use crate::units::{Acceleration, Jerk, Position, Velocity};

/// Why a move was not taken. The move that runs goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QueueError {
    /// Its start tick has passed: plan for a later one.
    Late,
    /// Another move is still waiting, or will still run at the start tick.
    Busy,
    /// The axis is not enabled.
    Disabled,
    /// Another source of setpoints is selected.
    OtherSource,
}

impl fmt::Display for QueueError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Late => "the start tick has passed: plan the move for a later one",
            Self::Busy => "another move is not finished by then: wait for its end",
            Self::Disabled => "the axis is not enabled: enable it first",
            Self::OtherSource => {
                "another source of setpoints is selected: select planned moves first"
            }
        })
    }
}

impl core::error::Error for QueueError {}

/// The setpoint generator of an axis: one move that runs and one that waits.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// Position in 2⁻⁴⁸ d.
    position: i128,
    /// Where the running move ends, 2⁻⁴⁸ d.
    target: i128,
    /// Velocity in 2⁻⁴⁸ d/tick, the creep apart.
    velocity: i64,
    /// Acceleration in 2⁻⁴⁸ d/tick²; always even.
    acceleration: i64,
    phase: Phase,
    next_segment: usize,
    /// The profile that runs and the one that waits; they change places at the start of a move.
    profiles: [Profile; 2],
    running: usize,
    remaining_ticks: u32,
    waiting_start: Option<u32>,
}

/// The segment that runs, as what it adds in a tick.
#[derive(Clone, Copy, Debug, Default)]
struct Phase {
    remaining_ticks: u32,
    /// The jerk as the feedforward sees it.
    jerk: Jerk,
    /// j/6 and the creep of the move.
    position_step: i64,
    /// j/2.
    half_jerk: i64,
}

impl Phase {
    fn new(segment: Segment, creep: i64) -> Self {
        let sixth = segment.jerk_sixth;
        let jerk = sixth.wrapping_mul(6);
        Self {
            remaining_ticks: segment.ticks,
            jerk: Jerk::from_bits(rounded::<{ STATE_FRAC - Jerk::FRAC_NBITS }>(jerk) as i32),
            position_step: sixth.wrapping_add(creep),
            half_jerk: sixth.wrapping_mul(3),
        }
    }
}

impl Trajectory {
    /// A generator that stands at 0 d.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Ends all motion and stands at `position`: for an axis that is not under control.
    pub fn hold(&mut self, position: Position) {
        self.position =
            i128::from(position.to_bits()).wrapping_shl(STATE_FRAC - Position::FRAC_NBITS);
        self.velocity = 0;
        self.acceleration = 0;
        self.phase = Phase::default();
        self.remaining_ticks = 0;
        self.waiting_start = None;
    }

    /// True while a move runs.
    #[must_use]
    pub const fn is_moving(&self) -> bool {
        self.remaining_ticks != 0
    }

    /// Queues a move to start at tick `start`, from wherever the axis then stands; `now` is the tick
    /// that was evaluated last. Ticks wrap at 32 bits; `start` lies less than 2³¹ ahead.
    ///
    /// # Errors
    /// [`QueueError::Late`] unless `start` is after `now`, [`QueueError::Busy`] if a move waits or the
    /// one that runs ends after `start`.
    pub fn queue(&mut self, profile: &Profile, start: u32, now: u32) -> Result<(), QueueError> {
        let ahead = start.wrapping_sub(now);
        if ahead == 0 || ahead > i32::MAX.cast_unsigned() {
            return Err(QueueError::Late);
        }
        if self.waiting_start.is_some() || self.remaining_ticks > ahead {
            return Err(QueueError::Busy);
        }
        if let Some(waiting) = self.profiles.get_mut(self.running ^ 1) {
            *waiting = *profile;
        }
        self.waiting_start = Some(start);
        Ok(())
    }

    /// The setpoint of tick `now`.
    pub fn step(&mut self, now: u32) -> Setpoint {
        if self.remaining_ticks != 0 {
            self.advance();
        }
        if self.waiting_start == Some(now) {
            self.start();
        }
        self.setpoint()
    }

    fn advance(&mut self) {
        let Phase {
            position_step,
            half_jerk,
            ..
        } = self.phase;
        let half_acceleration = self.acceleration.wrapping_shr(1);
        let step = self
            .velocity
            .wrapping_add(half_acceleration)
            .wrapping_add(position_step);
        self.position = self.position.wrapping_add(i128::from(step));
        self.velocity = self
            .velocity
            .wrapping_add(self.acceleration)
            .wrapping_add(half_jerk);
        self.acceleration = self.acceleration.wrapping_add(half_jerk.wrapping_mul(2));

        self.remaining_ticks = self.remaining_ticks.wrapping_sub(1);
        self.phase.remaining_ticks = self.phase.remaining_ticks.wrapping_sub(1);
        if self.phase.remaining_ticks == 0 {
            self.end_phase();
        }
    }

    #[cold]
    fn end_phase(&mut self) {
        if self.remaining_ticks == 0 {
            // Less than one unit a tick of the creep is still missing: at most half an LSB of the output,
            // after the longest move of all. The last ramp's step of acceleration ends here.
            self.position = self.target;
            self.acceleration = 0;
            self.phase = Phase::default();
        } else {
            self.enter_segment(self.next_segment);
        }
    }

    #[cold]
    fn start(&mut self) {
        self.waiting_start = None;
        self.running ^= 1;
        if let Some(profile) = self.profiles.get(self.running) {
            self.target = self.position.wrapping_add(profile.distance);
            self.remaining_ticks = profile.ticks();
        }
        if self.remaining_ticks != 0 {
            self.enter_segment(0);
        }
    }

    fn enter_segment(&mut self, index: usize) {
        if let Some(profile) = self.profiles.get(self.running) {
            let segment = profile.segments.get(index).copied().unwrap_or_default();
            self.phase = Phase::new(segment, profile.creep);
            self.acceleration = self.acceleration.wrapping_add(segment.acceleration_step);
        }
        self.next_segment = index.wrapping_add(1);
    }

    fn setpoint(&self) -> Setpoint {
        let position = rounded_to::<{ STATE_FRAC - Position::FRAC_NBITS }>(self.position);
        let velocity = rounded::<{ STATE_FRAC - Velocity::FRAC_NBITS }>(self.velocity);
        let acceleration = rounded::<{ STATE_FRAC - Acceleration::FRAC_NBITS }>(self.acceleration);
        Setpoint {
            position: Position::from_bits(position),
            velocity: Velocity::from_bits(velocity as i32),
            acceleration: Acceleration::from_bits(acceleration as i32),
            jerk: self.phase.jerk,
        }
    }
}

/// `value` / 2^`BITS` to nearest.
const fn rounded<const BITS: u32>(value: i64) -> i64 {
    value
        .wrapping_add(1_i64.wrapping_shl(BITS.wrapping_sub(1)))
        .wrapping_shr(BITS)
}

/// `value` / 2^`BITS` to nearest, for positions.
const fn rounded_to<const BITS: u32>(value: i128) -> i64 {
    value
        .wrapping_add(1_i128.wrapping_shl(BITS.wrapping_sub(1)))
        .wrapping_shr(BITS) as i64
}
