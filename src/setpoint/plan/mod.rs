//! Planned motion: a table of constant-jerk segments from an exact state to an exact end at rest.
//!
//! A plan changes the velocity to a cruising velocity in the fastest way that whole ticks allow (`ramp`), cruises
//! for whole ticks, and changes it to zero. The way of both changes and the cruise is a continuous and growing
//! function of the cruising velocity but for one thing, below. If the way at the velocity limit without a cruise is too short for the
//! target, the cruise is as many ticks as are missing, rounded up; then the cruising velocity is found at which the
//! way is that to the target. It may be against the velocity at the start: then the axis comes back. Limits hold
//! by construction, except for a start beyond them, which is left as fast as jerk and acceleration allow. Where the
//! change to a greater velocity takes a tick more, the way jumps by that tick; a target within the jump is met by a
//! tick more of cruise.
//!
//! State is whole units of 2⁻⁴⁸ d: no rounding adds up. The way is met to some thousand units a tick (about
//! 1e-11 d), which a position step of the same size in each tick covers, the creep; what that leaves, less than a
//! unit a tick, is taken at the end.
//!
//! From rest to rest a plan takes at most seven ticks longer than the time-optimal motion in continuous time, three
//! with a cruise; from a state of motion the median is one tick. It is slower only where the axis is slowing down
//! already and the optimum would not bring the acceleration to zero in between.

mod ramp;
mod search;
mod state;

use core::fmt;

use ramp::{Course, Ramp};
use search::Search;
pub use state::State;
pub(in crate::setpoint) use state::{Segment, in_units};

use super::limits::Limits;
use crate::units::{Position, Velocity};

/// Fractional bits of planned quantities, in d.
pub const STATE_FRAC: u32 = 48;
/// Longest plan, ticks.
pub const MAX_TICKS: u32 = i32::MAX.cast_unsigned();
/// Longest way of a plan, d.
const MAX_DISTANCE: u128 = 1 << (31 + STATE_FRAC);
/// Segments of a plan: two changes of velocity of eight and six, and the cruise.
pub(super) const MAX_SEGMENTS: usize = 15;
/// A planned motion that ends at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Plan {
    pub(super) segments: [Segment; MAX_SEGMENTS],
    /// Where it starts; without, at rest wherever the axis is, and `end` is counted from there.
    start: Option<State>,
    end: i128,
    /// Velocity in 2⁻⁴⁸ d/tick that carries the rounding rest of the way.
    pub(super) creep: i64,
    ticks: u32,
}

/// Why a motion cannot be planned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlanError {
    /// The distance is beyond ±2³¹ d.
    TooFar,
    /// The move would take 2³¹ ticks or more: raise the limits or shorten the move.
    TooLong,
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TooFar => "the distance is beyond 2147483648 d: shorten the move",
            Self::TooLong => "the move takes too many ticks: raise its limits or shorten it",
        })
    }
}

impl core::error::Error for PlanError {}

impl Plan {
    /// A move from rest by `distance` d under `limits`, from wherever the axis stands at its start.
    ///
    /// # Errors
    /// [`PlanError`] for a move that is too far or too long.
    #[expect(
        clippy::self_named_constructors,
        reason = "a move from rest is known as `Profile::plan`"
    )]
    pub fn plan(distance: Position, limits: &Limits) -> Result<Self, PlanError> {
        let plan = Self::by(State::default(), in_units(distance), limits)?;
        Ok(Self {
            start: None,
            ..plan
        })
    }

    /// A motion from `start` to rest at `target`.
    ///
    /// # Errors
    /// [`PlanError`] for one that is too far or too long.
    pub fn to(start: State, target: Position, limits: &Limits) -> Result<Self, PlanError> {
        Self::by(start, in_units(target).wrapping_sub(start.position), limits)
    }

    /// The fastest stop from `start`, wherever it ends.
    ///
    /// # Errors
    /// [`PlanError::TooLong`].
    pub fn stop(start: State, limits: &Limits) -> Result<Self, PlanError> {
        let mut course = Course::new(start);
        Ramp::new(limits)
            .change(&mut course, 0)
            .ok_or(PlanError::TooLong)?;
        Ok(Self {
            segments: course.segments,
            start: Some(start),
            end: course.state.position,
            creep: 0,
            ticks: course.ticks,
        })
    }

    /// Stands at `position`.
    #[must_use]
    pub fn standing(position: Position) -> Self {
        Self::standing_at(State::at_rest(position))
    }

    /// Stands at a state at rest.
    #[must_use]
    pub(super) fn standing_at(state: State) -> Self {
        Self {
            start: Some(state),
            end: state.position,
            ..Self::default()
        }
    }

    /// Duration in ticks: the end is reached this many ticks after the start.
    #[must_use]
    pub const fn ticks(&self) -> u32 {
        self.ticks
    }

    /// Where it starts; `None` for a move from rest by a distance.
    #[must_use]
    pub const fn start(&self) -> Option<&State> {
        self.start.as_ref()
    }

    /// Where it ends, or how far from its start if it has none.
    #[must_use]
    pub const fn end(&self) -> State {
        State {
            position: self.end,
            velocity: 0,
            acceleration: 0,
        }
    }

    /// The state `ticks` after the start, exactly as the tick will have it; from the end on that at the end.
    #[must_use]
    pub fn state_at(&self, ticks: u32) -> State {
        if ticks >= self.ticks {
            return self.end();
        }
        let mut state = self.start.unwrap_or_default();
        let mut left = ticks;
        for segment in &self.segments {
            let within = left.min(segment.ticks);
            state = state.after(segment, within);
            left = left.wrapping_sub(within);
        }
        let crept = i128::from(self.creep).wrapping_mul(i128::from(ticks));
        state.position = state.position.wrapping_add(crept);
        state
    }

    /// A motion from `start` to rest after `way`, 2⁻⁴⁸ d.
    fn by(start: State, way: i128, limits: &Limits) -> Result<Self, PlanError> {
        if way.unsigned_abs() > MAX_DISTANCE {
            return Err(PlanError::TooFar);
        }
        let ramp = Ramp::new(limits);
        let stop = Search { ramp, start, way }
            .course(0, 0)
            .ok_or(PlanError::TooLong)?;
        let back = stop.state.position.wrapping_sub(start.position) > way;
        let search = Search {
            ramp,
            start: if back { start.mirrored() } else { start },
            way: if back { way.wrapping_neg() } else { way },
        };
        let top =
            i64::from(limits.velocity().to_bits()).wrapping_shl(STATE_FRAC - Velocity::FRAC_NBITS);
        let course = search.solve(top).ok_or(PlanError::TooLong)?;

        let mut segments = course.segments;
        if back {
            for segment in &mut segments {
                segment.jerk = segment.jerk.wrapping_neg();
            }
        }
        let rest = search.missing(&course);
        let creep = rest
            .checked_div(i128::from(course.ticks))
            .unwrap_or_default() as i64;
        Ok(Self {
            segments,
            start: Some(start),
            end: start.position.wrapping_add(way),
            creep: if back { creep.wrapping_neg() } else { creep },
            ticks: course.ticks,
        })
    }
}
