//! Homing: a switch says which revolution, the encoder's index says where in it.
//!
//! ```text
//!          ▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁┌──────── switch ────────────────
//!                                      │            ▲ index
//!  search        ─────────────────────►│──╮
//!  back off                 ╭──────────│──╯
//!  approach                 ╰─────────►│
//!  index                               └───────────►│ latched: the origin
//!  stop                                             └──► at rest
//!                                      ◄── 10…90 % ►
//! ```
//!
//! The switch is met fast once, to know where it is, and then slowly; the index is always passed in the direction of
//! the search, so that its width and hysteresis do not matter. What counts is what the hardware latched at the index,
//! not where the axis was in the tick: the origin is the same at every speed. A start on the switch begins with the
//! way back; a start beyond it comes to the limit switch, turns round there and backs off over the home switch.
//!
//! Each way and the whole time are bounded. On failure the axis stops and [`Homing::trouble`] tells the supervisor;
//! [`HomingFailure`] says what to do about it.
//!
//! The origin is the raw position at which users read 0. It is an offset for them, for soft limits and for the screw
//! table; the loop does not know of it. It is kept while the drive is off, since the encoder counts on, and lost
//! with the encoder's signal, on encoder faults, and when an index comes elsewhere than whole revolutions from the
//! one homed on.

pub mod config;
mod failure;
mod index;

pub use config::{Config, HomingParams};
pub use failure::{HomeRefused, HomingFailure};

use self::index::IndexWatch;
use crate::capture::{Observation, UnwrappedLatch};
use crate::encoder_map::Direction;
use crate::hal::Lines;
use crate::setpoint::Setpoint;
use crate::setpoint::follower::Follower;
use crate::supervisor::Fault;
use crate::units::{Position, Velocity};

/// What homing is at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Stage {
    /// Nothing.
    #[default]
    Idle = 0,
    /// On the way to the switch.
    Search = 1,
    /// The limit switch was met: on the way back to the home switch.
    Return = 2,
    /// On the way back off the switch.
    BackOff = 3,
    /// Slowly towards the switch.
    Approach = 4,
    /// From the switch on to the index.
    Index = 5,
    /// The index was found: coming to rest.
    Stop = 6,
    /// Coming to rest without an origin.
    Failed = 7,
}

/// What homing sees in a tick.
#[derive(Clone, Copy, Debug)]
pub struct Sight<'a> {
    /// The capture, unwrapped.
    pub observation: &'a Observation<'a>,
    /// Discrete inputs.
    pub lines: &'a Lines,
    /// Where the index really lies, by the encoder map: off its boundary, Q.16 d.
    pub index_error: i32,
}

/// Homing, and whether it was done.
#[derive(Clone, Debug)]
pub struct Homing {
    config: Config,
    stage: Stage,
    follower: Follower,
    /// Count at which the stage began.
    stage_start: i64,
    ticks_left: u32,
    /// Farthest back that the switch was seen.
    switch: i64,
    failure: Option<HomingFailure>,
    /// From switch to index, d.
    index_distance: Option<i32>,
    origin: Option<Position>,
    watch: IndexWatch,
}

impl Homing {
    /// Not homed.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            stage: Stage::Idle,
            follower: Follower::new(config.follower),
            stage_start: 0,
            ticks_left: 0,
            switch: 0,
            failure: None,
            index_distance: None,
            origin: None,
            watch: IndexWatch::new(),
        }
    }

    /// Takes another configuration; homing that runs goes on by it.
    pub fn reconfigure(&mut self, config: Config) {
        self.config = config;
        self.follower.reconfigure(config.follower);
    }

    /// Where it stands.
    #[must_use]
    pub const fn stage(&self) -> Stage {
        self.stage
    }

    /// True while homing commands the setpoint.
    #[must_use]
    #[inline]
    pub const fn is_active(&self) -> bool {
        !matches!(self.stage, Stage::Idle)
    }

    /// The raw position of coordinate 0, if the axis is homed.
    #[must_use]
    pub const fn origin(&self) -> Option<Position> {
        self.origin
    }

    /// From the switch to the index in the last homing that found both, d.
    #[must_use]
    pub const fn index_distance(&self) -> Option<i32> {
        self.index_distance
    }

    /// Why the last homing failed.
    #[must_use]
    pub const fn failure(&self) -> Option<HomingFailure> {
        self.failure
    }

    /// The fault of a homing that failed and still comes to rest.
    #[must_use]
    pub fn trouble(&self) -> Option<Fault> {
        match self.stage {
            Stage::Failed => self.failure.map(HomingFailure::fault),
            _ => None,
        }
    }

    /// Begins from `last`, the last setpoint commanded, with the encoder at `count`. The origin of before is lost.
    pub fn start(&mut self, last: &Setpoint, count: i64) {
        self.follower.take_over(last);
        self.origin = None;
        self.failure = None;
        self.index_distance = None;
        self.watch = IndexWatch::new();
        self.ticks_left = self.config.max_ticks;
        self.enter(Stage::Search, count);
    }

    /// Ends without an origin, wherever it is; who goes on takes the last setpoint over.
    pub const fn abort(&mut self) {
        self.stage = Stage::Idle;
    }

    /// The place is lost: an encoder fault. Gives true if there was an origin to lose.
    pub const fn lose_origin(&mut self) -> bool {
        self.origin.take().is_some()
    }

    /// An origin that is known without homing, or none.
    pub const fn set_origin(&mut self, origin: Option<Position>) {
        self.origin = origin;
        self.watch = IndexWatch::new();
    }

    /// Takes notice of an index of a homed axis: true if it lies where it must. Every tick.
    #[inline]
    pub fn check_index(&mut self, observation: &Observation<'_>) -> bool {
        match observation.index() {
            Some(latch) if self.origin.is_some() => {
                self.watch
                    .agrees(observation.delta, latch, self.config.revolution)
            }
            _ => true,
        }
    }

    /// The lines as the supervisor is to see them: while homing leaves a limit switch, it is none.
    #[must_use]
    #[cold]
    pub const fn leave_limit(&self, lines: Lines) -> Lines {
        match (self.stage, self.config.direction < 0) {
            (Stage::Search | Stage::Return | Stage::BackOff, true) => Lines {
                limit_low: false,
                ..lines
            },
            (Stage::Search | Stage::Return | Stage::BackOff, false) => Lines {
                limit_high: false,
                ..lines
            },
            _ => lines,
        }
    }

    /// The setpoint of a tick while homing is active.
    pub fn step(&mut self, sight: &Sight<'_>) -> Setpoint {
        let count = sight.observation.count;
        let is_bounded = matches!(self.stage, Stage::Stop | Stage::Failed);
        if !is_bounded {
            self.ticks_left = self.ticks_left.saturating_sub(1);
            if self.ticks_left == 0 {
                self.fail(HomingFailure::TimeOut, count);
            }
        }
        match self.stage {
            Stage::Idle => {}
            Stage::Search => self.search(sight),
            Stage::Return => self.go_back_to_switch(sight),
            Stage::BackOff => self.back_off(sight),
            Stage::Approach => self.approach(sight),
            Stage::Index => self.seek_index(sight),
            Stage::Stop | Stage::Failed => {
                if self.follower.is_at_rest() {
                    self.stage = Stage::Idle;
                }
            }
        }
        self.follower.step(self.target())
    }

    /// Where the stage wants to go.
    const fn target(&self) -> Velocity {
        let config = &self.config;
        match self.stage {
            Stage::Idle | Stage::Stop | Stage::Failed => Velocity::ZERO,
            Stage::Search => config.towards(config.search, false),
            Stage::Return | Stage::BackOff => config.towards(config.search, true),
            Stage::Approach | Stage::Index => config.towards(config.approach, false),
        }
    }

    fn search(&mut self, sight: &Sight<'_>) {
        let count = sight.observation.count;
        if let Some(switch) = switch_seen(sight) {
            self.switch = switch;
            self.enter(Stage::BackOff, count);
        } else if self.at_limit(sight.lines, false) {
            self.enter(Stage::Return, count);
        } else if self.has_gone(count, self.config.max_way) {
            self.fail(HomingFailure::SwitchNotFound, count);
        }
    }

    fn go_back_to_switch(&mut self, sight: &Sight<'_>) {
        let count = sight.observation.count;
        if let Some(switch) = switch_seen(sight) {
            self.switch = switch;
            self.enter(Stage::BackOff, count);
        } else if self.at_limit(sight.lines, true) || self.has_gone(count, self.config.max_way) {
            self.fail(HomingFailure::SwitchNotFound, count);
        }
    }

    fn back_off(&mut self, sight: &Sight<'_>) {
        let count = sight.observation.count;
        if let Some(switch) = switch_seen(sight)
            && self.ahead(switch, self.switch) < 0
        {
            self.switch = switch;
        }
        if self.ahead(self.switch, count) > self.config.back_off && !sight.lines.home {
            self.enter(Stage::Approach, count);
        } else if self.at_limit(sight.lines, true) || self.has_gone(count, self.config.max_way) {
            self.fail(HomingFailure::SwitchStuck, count);
        }
    }

    fn approach(&mut self, sight: &Sight<'_>) {
        let count = sight.observation.count;
        let goes_on = self.config.onward(i64::from(sight.observation.delta)) > 0;
        if let Some(switch) = switch_seen(sight).filter(|_| goes_on) {
            self.switch = switch;
            self.enter(Stage::Index, count);
            // Both may lie in one tick.
            self.seek_index(sight);
        } else if self.at_limit(sight.lines, false) || self.has_gone(count, self.config.max_way) {
            self.fail(HomingFailure::SwitchNotFound, count);
        }
    }

    fn seek_index(&mut self, sight: &Sight<'_>) {
        let observation = sight.observation;
        let passed = observation.index().filter(|latch| {
            self.config.onward(i64::from(observation.delta)) > 0
                && self.ahead(latch.count, self.switch) >= 0
        });
        if let Some(latch) = passed {
            self.take_index(latch, sight);
        } else if self.ahead(observation.count, self.switch) > self.config.index_way {
            self.fail(HomingFailure::IndexNotFound, observation.count);
        }
    }

    fn take_index(&mut self, latch: UnwrappedLatch, sight: &Sight<'_>) {
        let count = sight.observation.count;
        let distance = self.ahead(latch.count, self.switch);
        self.index_distance = Some(distance as i32);
        let (earliest, latest) = self.config.index_window;
        if distance < earliest || distance > latest {
            let failure = HomingFailure::IndexTooNear {
                distance: distance as i32,
                revolution: self.config.revolution as i32,
            };
            return self.fail(failure, count);
        }
        // A boundary passed downwards lies above the count that was latched.
        let direction = Direction::of(sight.observation.delta);
        let boundary = latch
            .count
            .wrapping_add(i64::from(direction == Direction::Backward));
        self.origin = Some(Position::from_bits(
            boundary
                .wrapping_shl(Position::FRAC_NBITS)
                .wrapping_add(i64::from(sight.index_error))
                .wrapping_sub(self.config.home_position),
        ));
        self.watch.note(direction, latch.count);
        self.enter(Stage::Stop, count);
    }

    fn enter(&mut self, stage: Stage, count: i64) {
        self.stage = stage;
        self.stage_start = count;
    }

    #[cold]
    fn fail(&mut self, failure: HomingFailure, count: i64) {
        self.failure = Some(failure);
        self.enter(Stage::Failed, count);
    }

    /// How far `count` lies ahead of `other` in the direction of the search.
    const fn ahead(&self, count: i64, other: i64) -> i64 {
        self.config.onward(count.wrapping_sub(other))
    }

    /// True if the stage has moved by more than `way`, either way.
    const fn has_gone(&self, count: i64, way: i64) -> bool {
        count.wrapping_sub(self.stage_start).unsigned_abs() > way.unsigned_abs()
    }

    /// On the limit switch in the direction of the search, or on the one behind.
    const fn at_limit(&self, lines: &Lines, behind: bool) -> bool {
        if (self.config.direction < 0) == behind {
            lines.limit_high
        } else {
            lines.limit_low
        }
    }
}

/// Where the home switch is, if it was seen in the tick: where the hardware latched it, or just here.
fn switch_seen(sight: &Sight<'_>) -> Option<i64> {
    let observation = sight.observation;
    match observation.home() {
        Some(latch) => Some(latch.count),
        None => sight.lines.home.then_some(observation.count),
    }
}
