//! Evaluation of plans, tick by tick, without a rounding error.
//!
//! Within a tick the jerk is constant, so x += v + a/2 + j/6, v += a + j/2, a += j. With acceleration and jerk even
//! and the sixth rounded once a segment, all of these are whole units of 2⁻⁴⁸ d, the state at any tick is what the
//! plan says it is, and the last setpoint of a plan is its target with velocity and acceleration zero, however many
//! plans went before.

use core::fmt;

use super::plan::{Plan, STATE_FRAC, Segment, State};
use super::{Setpoint, Turn};
use crate::units::{Acceleration, Jerk, Position, Velocity};

/// Why a plan was not taken. What runs goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QueueError {
    /// Its start tick has passed: plan for a later one.
    Late,
    /// Another plan is still waiting, or will still run at the start tick of a move from rest.
    Busy,
    /// The axis is not enabled.
    Disabled,
    /// The axis is stopping, or not yet allowed to move after a stop.
    Stopping,
    /// It ends beyond the soft limits of travel.
    BeyondTravel,
    /// Another source of setpoints is selected.
    OtherSource,
}

impl fmt::Display for QueueError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Late => "the start tick has passed: plan the move for a later one",
            Self::Busy => "another move is not finished by then: wait for its end",
            Self::Disabled => "the axis is not enabled: enable it first",
            Self::Stopping => "the axis is being stopped: wait until it stands and may move",
            Self::BeyondTravel => "the move ends beyond the soft limits: choose a nearer target",
            Self::OtherSource => {
                "another source of setpoints is selected: select planned moves first"
            }
        })
    }
}

impl core::error::Error for QueueError {}

/// The setpoint generator of an axis: one plan that runs and one that waits.
// The plans are large, and so come last.
#[derive(Clone, Debug, Default)]
#[repr(C)]
pub struct Trajectory {
    state: State,
    /// Where the running plan ends, 2⁻⁴⁸ d.
    target: i128,
    phase: Phase,
    next_segment: usize,
    running: usize,
    remaining_ticks: u32,
    waiting_start: Option<u32>,
    dropped: u32,
    /// The plan that runs and the one that waits; they change places when it starts.
    plans: [Plan; 2],
}

/// The segment that runs, as what it adds in a tick.
#[derive(Clone, Copy, Debug, Default)]
struct Phase {
    remaining_ticks: u32,
    /// The jerk as the feedforward sees it.
    jerk: Jerk,
    /// j/6 and the creep of the plan.
    position_step: i64,
    /// j, even.
    step_of_acceleration: i64,
}

impl Phase {
    fn new(segment: &Segment, creep: i64) -> Self {
        Self {
            remaining_ticks: segment.ticks,
            jerk: jerk_of(segment),
            position_step: segment.sixth().wrapping_add(creep),
            step_of_acceleration: segment.jerk,
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
        self.state = State::at_rest(position);
        self.target = self.state.position;
        self.phase = Phase::default();
        self.remaining_ticks = 0;
        self.waiting_start = None;
    }

    /// True while a plan runs.
    #[must_use]
    pub const fn is_moving(&self) -> bool {
        self.remaining_ticks != 0
    }

    /// Plans that were dropped at their start because the state was not the one they start from.
    #[must_use]
    pub const fn dropped(&self) -> u32 {
        self.dropped
    }

    /// Where `plan` would end, d: a move by a distance begins where the running plan ends.
    #[must_use]
    pub const fn end_of(&self, plan: &Plan) -> Position {
        match plan.start() {
            Some(_) => plan.end().position(),
            None => State {
                position: self.target.wrapping_add(plan.end().position),
                velocity: 0,
                acceleration: 0,
            }
            .position(),
        }
    }

    /// Queues `plan` to start at tick `start`; `now` is the tick that was evaluated last. Ticks wrap at 32 bits;
    /// `start` lies less than 2³¹ ahead. A plan from a state takes over a running one if the state is then exactly
    /// that one, or else is dropped and counted, and the old plan goes on; a move by a distance begins at rest.
    ///
    /// # Errors
    /// [`QueueError::Late`] unless `start` is after `now`, [`QueueError::Busy`] if a plan waits, or for a move by a
    /// distance if the one that runs ends after `start`.
    pub fn queue(&mut self, plan: &Plan, start: u32, now: u32) -> Result<(), QueueError> {
        let ahead = start.wrapping_sub(now);
        if ahead == 0 || ahead > i32::MAX.cast_unsigned() {
            return Err(QueueError::Late);
        }
        let must_rest = plan.start().is_none();
        if self.waiting_start.is_some() || must_rest && self.remaining_ticks > ahead {
            return Err(QueueError::Busy);
        }
        if let Some(waiting) = self.plans.get_mut(self.running ^ 1) {
            *waiting = *plan;
        }
        self.waiting_start = Some(start);
        Ok(())
    }

    /// The setpoint of tick `now`.
    #[inline]
    pub fn step(&mut self, now: u32) -> Setpoint {
        if self.remaining_ticks != 0 {
            self.advance();
        }
        let mut until_start = u32::MAX;
        if let Some(start) = self.waiting_start {
            until_start = start.wrapping_sub(now);
            if until_start == 0 {
                self.start();
                until_start = u32::MAX;
            }
        }
        let mut setpoint = self.setpoint();
        let until_phase = self.phase.remaining_ticks.wrapping_sub(1);
        if until_start.min(until_phase) < Turn::HORIZON {
            setpoint.turn = self.turn(until_start);
        }
        setpoint
    }

    /// The change of the jerk that comes next, where a waiting plan is to start in `until_start` ticks.
    #[inline(never)]
    fn turn(&self, until_start: u32) -> Turn {
        let phase_ticks = match self.phase.remaining_ticks {
            0 => u32::MAX,
            ticks => ticks,
        };
        let (ticks, plan, segment) = if until_start <= phase_ticks {
            (until_start, self.running ^ 1, 0)
        } else {
            (phase_ticks, self.running, self.next_segment)
        };
        let is_last = ticks == self.remaining_ticks && plan == self.running;
        let next = self
            .plans
            .get(plan)
            .and_then(|plan| plan.segments.get(segment));
        Turn {
            ticks,
            jerk: match next {
                Some(next) if !is_last => jerk_of(next),
                _ => Jerk::ZERO,
            },
        }
    }

    #[inline]
    fn advance(&mut self) {
        let Phase {
            position_step,
            step_of_acceleration,
            ..
        } = self.phase;
        let State {
            position,
            velocity,
            acceleration,
        } = &mut self.state;
        // Half the acceleration before and half of that after are the gain: both are even.
        let way = velocity.wrapping_add(acceleration.wrapping_shr(1));
        let step = way.wrapping_add(position_step);
        *position = position.wrapping_add(i128::from(step));
        *acceleration = acceleration.wrapping_add(step_of_acceleration);
        *velocity = way.wrapping_add(acceleration.wrapping_shr(1));

        self.remaining_ticks = self.remaining_ticks.wrapping_sub(1);
        self.phase.remaining_ticks = self.phase.remaining_ticks.wrapping_sub(1);
        if self.phase.remaining_ticks == 0 {
            self.end_phase();
        }
    }

    #[cold]
    fn end_phase(&mut self) {
        if self.remaining_ticks == 0 {
            self.end();
        } else {
            self.enter_segment(self.next_segment);
        }
    }

    /// Less than one unit a tick of the creep is still missing, at most half an LSB of the output after the longest
    /// plan of all, and less than 2⁻²⁶ d/tick of the velocity.
    fn end(&mut self) {
        self.state = State {
            position: self.target,
            velocity: 0,
            acceleration: 0,
        };
        self.phase = Phase::default();
    }

    #[cold]
    fn start(&mut self) {
        self.waiting_start = None;
        let Some(plan) = self.plans.get(self.running ^ 1) else {
            return;
        };
        let (fits, target) = match plan.start() {
            Some(state) => (*state == self.state, plan.end().position),
            None => (
                self.remaining_ticks == 0,
                self.state.position.wrapping_add(plan.end().position),
            ),
        };
        if !fits {
            self.dropped = self.dropped.wrapping_add(1);
            return;
        }
        self.target = target;
        self.remaining_ticks = plan.ticks();
        self.running ^= 1;
        if self.remaining_ticks == 0 {
            self.end();
        } else {
            self.enter_segment(0);
        }
    }

    fn enter_segment(&mut self, index: usize) {
        if let Some(plan) = self.plans.get(self.running)
            && let Some(segment) = plan.segments.get(index)
        {
            self.phase = Phase::new(segment, plan.creep);
        }
        self.next_segment = index.wrapping_add(1);
    }

    fn setpoint(&self) -> Setpoint {
        let velocity = rounded::<{ STATE_FRAC - Velocity::FRAC_NBITS }>(self.state.velocity);
        let acceleration =
            rounded::<{ STATE_FRAC - Acceleration::FRAC_NBITS }>(self.state.acceleration);
        Setpoint {
            position: self.state.position(),
            velocity: Velocity::from_bits(velocity as i32),
            acceleration: Acceleration::from_bits(acceleration as i32),
            jerk: self.phase.jerk,
            turn: Turn::NONE,
        }
    }
}

/// The jerk of a segment as the feedforward sees it.
const fn jerk_of(segment: &Segment) -> Jerk {
    Jerk::from_bits(rounded::<{ STATE_FRAC - Jerk::FRAC_NBITS }>(segment.jerk) as i32)
}

/// `value` / 2^`BITS` to nearest.
const fn rounded<const BITS: u32>(value: i64) -> i64 {
    value
        .wrapping_add(1_i64.wrapping_shl(BITS.wrapping_sub(1)))
        .wrapping_shr(BITS)
}
