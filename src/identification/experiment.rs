//! The part of identification that runs in the tick: a program, segment by segment, within hard bounds.
//!
//! Whatever ends an open-loop experiment, its command goes to zero through the output stage and stays there, the
//! loop open, until the experiment is released: after a failed proof of the sign no loop may close. One that
//! excites a closed loop ends by exciting it no more.

use super::program::{Loop, Program};
use crate::capture::Observation;
use crate::supervisor::Permit;
use crate::units::Command;

/// How an experiment ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Its program is through.
    Complete,
    /// The axis left the window.
    WindowLeft,
    /// The axis was too fast.
    TooFast,
    /// It took too long.
    TooLong,
    /// Somebody asked for it.
    Aborted,
    /// The supervisor took its permit back.
    NotPermitted,
}

/// Fractional bits of [`Experiment::position`].
pub const POSITION_FRAC: u32 = 4;

/// What an experiment knows of the tick it runs in.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// What the encoder inputs saw.
    pub observation: &'a Observation<'a>,
    /// Errors of the boundary passed last by the encoder map, Q.16 d, had it been passed forward and backward; none
    /// without a map in use.
    pub errors: Option<[i32; 2]>,
    /// What was permitted before the loop.
    pub permit: Permit,
    /// What the controller asks for.
    pub demand: Command,
    /// What was put out last.
    pub in_force: Command,
}

/// An experiment under way, or ended and not yet released.
#[derive(Clone, Debug)]
pub struct Experiment {
    program: Program,
    /// Number of the segment that runs, and its tick.
    segment: usize,
    segment_tick: u32,
    /// Ticks since the start.
    ticks: u32,
    /// Count at the start of the segment.
    segment_count: i64,
    /// Centre of the window, once the first tick has set it.
    centre: Option<i64>,
    position: i64,
    /// The encoder map was in use when it began: it is until the end then, as a change would look like motion.
    is_mapped: bool,
    /// The last motion was backward.
    is_backward: bool,
    in_force: Command,
    ending: Option<Ending>,
    abort: bool,
}

impl Experiment {
    /// An experiment that begins with the next tick.
    #[must_use]
    pub const fn new(program: Program) -> Self {
        Self {
            centre: program.centre,
            program,
            segment: 0,
            segment_tick: 0,
            ticks: 0,
            segment_count: 0,
            position: 0,
            is_mapped: false,
            is_backward: false,
            in_force: Command::ZERO,
            ending: None,
            abort: false,
        }
    }

    /// Asks it to end with the next tick.
    pub const fn abort(&mut self) {
        self.abort = true;
    }

    /// How it ended; none while it runs.
    #[must_use]
    pub const fn ending(&self) -> Option<Ending> {
        self.ending
    }

    /// Number of the segment that runs.
    #[must_use]
    pub const fn segment(&self) -> usize {
        self.segment
    }

    /// Ticks since the start.
    #[must_use]
    pub const fn ticks(&self) -> u32 {
        self.ticks
    }

    /// Position at the last sample in 1/16 d, by the age of the last edge where it is known, and by its place on the
    /// encoder map where that was in use from the beginning.
    #[must_use]
    pub const fn position(&self) -> i64 {
        self.position
    }

    /// The command under which the axis moved to that position.
    #[must_use]
    pub const fn in_force(&self) -> Command {
        self.in_force
    }

    /// True if the controller's loop is open: while an open-loop program runs and after its end.
    #[must_use]
    pub fn is_open_loop(&self) -> bool {
        self.program.control == Loop::Open
    }

    /// The demand of this tick, for the output stage. Cold: an axis at work runs none.
    #[cold]
    #[inline(never)]
    pub fn step(&mut self, seen: &Seen<'_>) -> Command {
        let observation = seen.observation;
        self.position = sub_count(observation).wrapping_add(self.correction(seen));
        self.in_force = seen.in_force;
        if self.ending.is_none() {
            self.ending = self.trouble(seen);
        }
        if self.ending.is_none() {
            let aligned = self.ticks.checked_rem(self.program.aligned_to);
            if aligned == Some(0) {
                self.advance(observation.count);
            }
        }
        self.ticks = self.ticks.saturating_add(1);
        let limit = self.program.bounds.command.to_bits();
        let shape = match self.ending {
            None => self.program.segment(self.segment).map(|part| part.shape),
            Some(_) => None,
        };
        let wanted = shape.map_or(0, |shape| shape.command(self.segment_tick));
        let bounded = wanted.max(limit.wrapping_neg()).min(limit);
        self.segment_tick = self.segment_tick.saturating_add(1);
        match self.program.control {
            Loop::Open => Command::from_bits(bounded),
            Loop::Closed => Command::from_bits(seen.demand.to_bits().saturating_add(bounded)),
        }
    }

    /// Ends the experiment if the supervisor took the permit back after the loop.
    pub fn review(&mut self, permit: Permit) {
        if permit < Permit::Follow && self.ending.is_none() {
            self.ending = Some(Ending::NotPermitted);
        }
    }

    /// What the encoder map says of the last edge, 1/16 d.
    fn correction(&mut self, seen: &Seen<'_>) -> i64 {
        if self.ticks == 0 {
            self.is_mapped = seen.errors.is_some();
        }
        let delta = seen.observation.delta;
        if delta != 0 {
            self.is_backward = delta < 0;
        }
        let Some([forward, backward]) = seen.errors.filter(|_| self.is_mapped) else {
            return 0;
        };
        let error = if self.is_backward { backward } else { forward };
        i64::from(error).wrapping_shr(16_u32.wrapping_sub(POSITION_FRAC))
    }

    /// What ends the experiment in this tick.
    fn trouble(&mut self, seen: &Seen<'_>) -> Option<Ending> {
        let observation = seen.observation;
        let bounds = &self.program.bounds;
        let centre = *self.centre.get_or_insert(observation.count);
        if self.ticks == 0 {
            self.segment_count = observation.count;
        }
        let from_centre = observation.count.wrapping_sub(centre).unsigned_abs();
        if seen.permit < Permit::Follow {
            Some(Ending::NotPermitted)
        } else if self.abort {
            Some(Ending::Aborted)
        } else if from_centre > u64::from(bounds.window_d) {
            Some(Ending::WindowLeft)
        } else if observation.delta.unsigned_abs() > bounds.speed_d_per_tick {
            Some(Ending::TooFast)
        } else if self.ticks >= bounds.ticks {
            Some(Ending::TooLong)
        } else {
            None
        }
    }

    /// Goes to the next segment where one is through.
    fn advance(&mut self, count: i64) {
        let Some(segment) = self.program.segment(self.segment) else {
            self.ending = Some(Ending::Complete);
            return;
        };
        let moved = count.wrapping_sub(self.segment_count);
        let towards = moved.wrapping_mul(i64::from(segment.shape.direction()));
        let travelled = if segment.either_way {
            moved.wrapping_abs()
        } else {
            towards
        };
        let arrived = segment
            .travel_d
            .is_some_and(|travel| travelled >= i64::from(travel));
        if self.segment_tick < segment.ticks && !arrived {
            return;
        }
        self.segment = self.segment.wrapping_add(1);
        self.segment_tick = 0;
        self.segment_count = count;
        if self.program.segment(self.segment).is_none() {
            self.ending = Some(Ending::Complete);
        }
    }
}

/// Where the shaft is at the sample, in 1/16 d: the last edge and how far the mean velocity of the tick carried
/// it since; the middle of the discrete where no edge came.
fn sub_count(observation: &Observation<'_>) -> i64 {
    let count = observation.count.wrapping_shl(POSITION_FRAC);
    let one = 1_i64 << POSITION_FRAC;
    let middle = count.wrapping_add(one >> 1);
    let delta = observation.delta;
    let (Some(age), true) = (observation.since_last_edge(), delta != 0) else {
        return middle;
    };
    // 16·2047 has 15 bits, so the age may have 17.
    let shift = 15_u32.saturating_sub(observation.elapsed.leading_zeros());
    let elapsed = observation.elapsed.wrapping_shr(shift).max(1);
    let age = age.wrapping_shr(shift).min(elapsed);
    let moved = delta.unsigned_abs().wrapping_shl(POSITION_FRAC);
    let since = moved
        .wrapping_mul(age)
        .checked_div(elapsed)
        .map_or(0, i64::from)
        .min(one.wrapping_sub(1));
    if delta > 0 {
        count.wrapping_add(since)
    } else {
        count.wrapping_add(one).wrapping_sub(since)
    }
}
