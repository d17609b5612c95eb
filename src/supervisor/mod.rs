//! What the axis may do, and when it must stop.
//!
//! ```text
//!              enable             ready, loop holds,
//!                                 brake opens
//!  ┌──────────┐ ─────► ┌──────────┐ ─────► ┌───────┐ ◄────► ┌────────┐
//!  │ Disabled │        │ Enabling │        │ Ready │ motion │ Moving │
//!  └──────────┘ ◄───── └──────────┘        └───┬───┘        └───┬────┘
//!    ▲   ▲    taken back                       │ enable taken   │
//!    │   │                                     ▼ back, or fault ▼
//!    │   │  stop over, brake closed,        ┌─────────────────────┐
//!    │   └─ enable off ──────────────────── │      Stopping       │
//!    │                                      └──────────┬──────────┘
//!    │ clear_fault                    the same, with   │
//!    │                                a fault latched  ▼
//!    │                                           ┌─────────┐ ◄── any state: 0 V with enable kept
//!    └────────────────────────────────────────── │  Fault  │     for a time, then off; or off at once
//!                                                └─────────┘
//! ```
//!
//! The supervisor is asked twice a tick: [`Supervisor::permit`] before the setpoint, from what the board
//! reports, and [`Supervisor::review`] after the loop, from what the tick came to. What it says last holds for the
//! output of that very tick.
//!
//! A fault is latched with its context by [`FirstFault`]; faults that come later are noted and do not take its
//! place, but a stronger reaction acts whenever it comes. Fault is left by [`Supervisor::clear`] alone. The
//! supervisor can ask the drive to be off; the removal of power is the matter of the hardware's
//! emergency-stop chain.

mod clear;
pub mod config;
pub mod fault;
mod fault_set;
mod io;
mod latch;
pub mod monitor;
pub mod record;
mod sequence;
mod status;
mod watch;

pub use clear::ClearError;
pub use config::{Config, SupervisorParams};
pub use fault::{Fault, Reaction};
pub use fault_set::FaultSet;
use io::{Judged, Loopback};
pub use io::{Permit, Review, Situation, State};
pub use record::{Context, FirstFault, Trip};

use crate::hal::Lines;
use latch::Latch;
use sequence::{Cue, Phase, Sequence};
use watch::Watch;

/// The supervisor.
#[derive(Clone, Debug)]
pub struct Supervisor {
    config: Config,
    sequence: Sequence,
    latch: Latch,
    watch: Watch,
    warnings: FaultSet,
    /// Faults that others found between ticks.
    reported: Option<Fault>,
    store_corrupt: bool,
    /// The loop was closed in the last tick.
    in_loop: bool,
    moving: bool,
    /// Estimated velocity of the last tick, Q11.20 d/tick.
    velocity: i32,
    lines: Lines,
    enable: bool,
    refused: bool,
    /// Something of what [`status`] tells may be another since it was told.
    has_news: bool,
}

impl Supervisor {
    /// Disabled, without a fault.
    #[must_use]
    pub fn new(config: Config) -> Self {
        Self {
            config,
            sequence: Sequence::default(),
            latch: Latch::default(),
            watch: Watch::default(),
            warnings: FaultSet::default(),
            reported: None,
            store_corrupt: false,
            in_loop: false,
            moving: false,
            velocity: 0,
            lines: Lines::default(),
            enable: false,
            refused: false,
            has_news: true,
        }
    }

    /// Takes new limits and times; state and latched fault stay, and a time that runs goes on.
    pub const fn reconfigure(&mut self, config: Config) {
        self.config = config;
    }

    /// What may be done in this tick.
    #[inline]
    pub fn permit(&mut self, situation: &Situation<'_>) -> Permit {
        let tolerance = self.config.readback_tolerance;
        let Situation { readback, told, .. } = *situation;
        let is_quiet = self.sequence.is_running()
            && situation.enable
            && (situation.illegal | situation.missed_ticks) == 0
            && self.reported.is_none()
            && situation.lines.is_well()
            && self
                .watch
                .readback
                .is_good(tolerance, Loopback { readback, told });
        if is_quiet {
            Permit::Follow
        } else {
            let counts = [situation.illegal, situation.missed_ticks];
            let Situation {
                tick,
                enable,
                lines,
                ..
            } = *situation;
            self.decide(tick, enable, lines, counts, Loopback { readback, told })
        }
    }

    // Taken apart: what is handed on as it came has to be in memory in every tick.
    #[cold]
    #[inline(never)]
    fn decide(
        &mut self,
        tick: u32,
        enable: bool,
        lines: &Lines,
        counts: [u16; 2],
        loopback: Loopback,
    ) -> Permit {
        self.has_news = true;
        self.lines = *lines;
        self.sequence.count_down();
        let is_off = matches!(self.sequence.phase(), Phase::Disabled | Phase::Faulted);
        let may_enable = enable && !self.latch.is_set();
        let found = [
            (self.watch.readback).check(self.config.readback_tolerance, loopback),
            self.watch.count(&self.config, tick, counts),
            self.reported.take().map(Trip::line),
        ];
        if !is_off || may_enable {
            self.judge_lines(tick, lines, found);
        }
        let cue = Cue {
            enable,
            ready: lines.drive_ready,
            moving: self.moving,
            faulted: self.latch.is_set(),
        };
        if self.sequence.advance(&self.config.times, cue) {
            let waited = i64::from(self.config.times.ready_timeout);
            let trip = Trip::counted(Fault::DriveNotReady, waited, waited);
            self.trip(trip, tick);
        }
        let is_locked = enable && self.sequence.phase() == Phase::Faulted;
        self.refused = is_locked && (self.refused || !self.enable);
        self.enable = enable;
        self.sequence.permit()
    }

    /// Faults that show before the setpoint, of the board and `found` elsewhere: they count only while the axis is enabled
    /// or about to be.
    fn judge_lines(&mut self, tick: u32, lines: &Lines, found: [Option<Trip>; 3]) {
        let was_ready = !matches!(
            self.sequence.phase(),
            Phase::Disabled | Phase::AwaitingReady | Phase::Faulted
        );
        let line = |active: bool, fault| active.then_some(Trip::line(fault));
        let of_lines = [
            line(lines.emergency_stop, Fault::EmergencyStop),
            line(lines.drive_fault, Fault::DriveFault),
            line(lines.encoder_lost, Fault::SignalLoss),
            line(self.store_corrupt, Fault::StoreCorrupt),
            line(was_ready && !lines.drive_ready, Fault::DriveNotReady),
        ];
        for trip in of_lines.into_iter().chain(found).flatten() {
            self.trip(trip, tick);
        }
    }

    /// Looks at what the tick came to, and may take back what was permitted.
    #[inline]
    pub fn review(&mut self, review: &Review<'_>) -> Permit {
        if self.moving != review.moving {
            self.moving = review.moving;
            self.has_news = true;
        }
        self.velocity = review.estimate.velocity.to_bits();
        self.in_loop = review.permit > Permit::ZeroVolts;
        if self.in_loop && self.watch.is_quiet(&self.config, review) && review.trouble.is_none() {
            return review.permit;
        }
        // Other values: what is handed on as it came has to be in memory in every tick.
        let Review {
            permit,
            tick,
            trouble,
            lines,
            observation,
            following_error,
            told,
            active,
            open_loop,
            ..
        } = *review;
        let review = Judged {
            permit,
            tick,
            trouble,
            lines,
            observation,
            velocity: self.velocity,
            commanded: review.setpoint.velocity.to_bits(),
            following_error,
            told: told.to_bits(),
            active,
            open_loop,
        };
        if self.in_loop {
            self.judge(&review)
        } else {
            self.review_off(&review)
        }
    }

    #[cold]
    #[inline(never)]
    fn judge(&mut self, review: &Judged<'_>) -> Permit {
        self.has_news = true;
        if let Some(fault) = review.trouble {
            self.trip(Trip::line(fault), review.tick);
        }
        let found = self.watch.look(&self.config, review);
        if found.is_warning {
            self.warnings = self.warnings.with(Fault::FollowingError);
        }
        if let Some(trip) = found.trip {
            self.trip(trip, review.tick);
        }
        let permit = self.sequence.permit().min(review.permit);
        self.in_loop = permit > Permit::ZeroVolts;
        permit
    }

    #[cold]
    #[inline(never)]
    fn review_off(&mut self, review: &Judged<'_>) -> Permit {
        self.has_news = true;
        self.moving = false;
        self.watch
            .restart(&self.config, review.observation, review.tick);
        let is_off = review.permit == Permit::Off;
        if let Some(trip) = self
            .watch
            .look_off(&self.config, review.observation, is_off)
        {
            if self.config.disabled.is_fault {
                self.sequence.react(Reaction::Off, &self.config.times);
                self.latch.set(trip, review.tick, State::Disabled);
            } else {
                self.warnings = self.warnings.with(trip.fault);
            }
        }
        review.permit
    }

    /// The one way into a fault: latches it if it is the first, and reacts to it in any case.
    #[cold]
    #[inline(never)]
    fn trip(&mut self, trip: Trip, tick: u32) {
        let state = self.state();
        self.latch.set(trip, tick, state);
        self.sequence
            .react(trip.fault.reaction(), &self.config.times);
    }

    /// True if the first fault was found in this tick, and its context is still to be noted.
    #[must_use]
    pub const fn is_context_due(&self) -> bool {
        self.latch.is_due()
    }

    /// Notes the context of the first fault.
    pub fn note_context(&mut self, context: &Context) {
        self.latch.note(context);
    }
}
