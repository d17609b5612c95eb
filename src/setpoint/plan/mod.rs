//! Planned motion: a table of constant-jerk segments from an exact state to an exact end at rest.
//!
//! A plan changes the velocity to a cruising velocity in the fastest way that whole ticks allow ([`ramp`]), cruises
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
//! From rest to rest a plan takes at most three ticks longer than the time-optimal motion in continuous time. From
//! a state with an acceleration it is slower where the optimum would not bring the acceleration to zero in
//! between: by twice the time that the jerk takes to do that, at the most.

mod ramp;
mod state;

use core::fmt;

use ramp::{Course, Ramp};
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
/// A creep that is small enough to stop looking for a better velocity, 2⁻⁴⁸ d/tick (2e-10 d/tick).
const FINE_CREEP: i128 = 1 << 16;

/// Velocities as close as that cover the same way but for a fine creep, 2⁻⁴⁸ d/tick.
const FINE_VELOCITY: i128 = 1 << 8;
/// How often a cruise is made longer to meet the target; the ticks that are added grow, so that it ends.
const LONGER_CRUISES: u32 = 64;

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

/// The search for a cruising velocity, turned so that it is not negative.
struct Search {
    ramp: Ramp,
    start: State,
    way: i128,
}

impl Search {
    /// To `velocity`, `ticks` of cruise, and to rest.
    fn course(&self, velocity: i64, ticks: i128) -> Option<Course> {
        let mut course = Course::new(self.start);
        self.ramp.change(&mut course, velocity)?;
        course.run(ticks, 0)?;
        // What the first change leaves of its target by rounding would be a change by itself.
        if velocity != 0 {
            self.ramp.change(&mut course, 0)?;
        }
        Some(course)
    }

    /// What `course` leaves of the way, 2⁻⁴⁸ d; negative if it goes too far.
    fn missing(&self, course: &Course) -> i128 {
        self.start
            .position
            .wrapping_add(self.way)
            .wrapping_sub(course.state.position)
    }

    /// The course that ends at the target, with velocities up to `top`.
    fn solve(&self, top: i64) -> Option<Course> {
        let mut below = Guess {
            velocity: 0,
            course: self.course(0, 0)?,
        };
        let mut above = Guess {
            velocity: top,
            course: self.course(top, 0)?,
        };
        let mut cruise = 0;
        let missing = self.missing(&above.course);
        if missing > 0 {
            let top = i128::from(top);
            let up = missing.wrapping_add(top).wrapping_sub(1);
            cruise = up.checked_div(top)?.max(1);
            above.course = self.course(above.velocity, cruise)?;
        }
        for attempt in 0..LONGER_CRUISES {
            if self.narrow(&mut below, &mut above, cruise)? {
                return Some(below.course);
            }
            // A greater velocity takes a tick more to reach, and in that tick the way grows by a jump: the target
            // lies in it. A tick more of cruise at a lower velocity meets it.
            cruise = cruise.wrapping_add(1 << (attempt / 4));
            above = Guess {
                velocity: below.velocity,
                course: self.course(below.velocity, cruise)?,
            };
            below = Guess {
                velocity: 0,
                course: self.course(0, 0)?,
            };
        }
        None
    }

    /// Brings `below`, which does not go too far, up to the target; false if the way jumps over it.
    fn narrow(&self, below: &mut Guess, above: &mut Guess, cruise: i128) -> Option<bool> {
        // Every other step halves what is left, so that 128 are enough for any function.
        for step in 0..128 {
            let rest = self.missing(&below.course);
            let grain = below.course.grain();
            let fine = FINE_CREEP
                .max(grain)
                .wrapping_mul(i128::from(below.course.ticks));
            if rest <= fine {
                return Some(true);
            }
            let width = above.velocity.wrapping_sub(below.velocity);
            if i128::from(width) <= FINE_VELOCITY.max(grain) {
                break;
            }
            let part = if step % 2 == 0 {
                let span = rest.wrapping_sub(self.missing(&above.course));
                // A little below the line, where the course does not go too far.
                let share = rest as f64 / span as f64 * (1.0 - 1e-9);
                ((width as f64 * share) as i64).clamp(1, width.wrapping_sub(1))
            } else {
                width.wrapping_shr(1)
            };
            let velocity = below.velocity.wrapping_add(part);
            let guess = Guess {
                velocity,
                course: self.course(velocity, cruise)?,
            };
            if self.missing(&guess.course) >= 0 {
                *below = guess;
            } else {
                *above = guess;
            }
        }
        Some(false)
    }
}

/// A cruising velocity and what comes of it.
struct Guess {
    velocity: i64,
    course: Course,
}
