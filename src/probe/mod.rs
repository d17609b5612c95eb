//! Probing: a touch probe says that it touches, the encoder's edges say where.
//!
//! ```text
//!  level      ▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁┌▔▔▔▔▔▔▔▔▔▔▔▔▔▔▔┐▁▁▁▁▁▁▁▁
//!  approach   ───────────────────►│               │
//!                       latch ────┘ debounce      │
//!  stop                           └────►──╮       │
//!  overtravel                     ◄──────►│       │
//!  retract              ◄───────────────────────────╯
//!  brake             ╰──┘
//!  samples            · · · · · · · · ·|· ·          quadratic, read at the contact
//! ```
//!
//! The axis goes towards a target at a steady feed. The board latches the timer at the probe's edge; the contact was the
//! trigger's delay before. Where the shaft was then is found a few ticks later, when the debounce is over and there
//! are edges after the contact as well as before it: by a quadratic through them all at their times, with the encoder's map
//! (`fit`). Only then the axis stops, by a jerk-limited ramp, and goes back by the distance that was asked for. How far it goes
//! on at most after a contact is known before it moves ([`Config::overtravel`]): a feed that needs more than is allowed is refused.
//!
//! What goes wrong is a result ([`ProbeEnd`]): a probe that touches before the axis moves, no touch on the whole way, a
//! touch on the way back, an axis that is stopped or whose encoder is lost. A touch while something else moves the axis is told as
//! [`ProbeEnd::Unasked`] and, by `stop_on_touch`, stops it; its place is that of the motion estimated, to a count or so.
//!
//! The 1σ of a place is that of the fit by the edges' noise and by what the map leaves, its slow error taken as one wave a
//! revolution, with the trigger's jitter at the velocity of the touch.

pub mod config;
mod failure;
mod fit;
mod history;
mod order;
mod place;
mod stages;
mod touch;
mod trigger;

pub use config::{Config, ProbeParams};
pub use failure::{ProbeEnd, ProbeRefused};
pub use order::ProbeOrder;
pub use touch::{Report, Touch};

use self::history::History;
use self::place::by_count;
use self::trigger::{Edge, Trigger};
use crate::capture::Observation;
use crate::edges::EdgeReader;
use crate::estimator::Estimate;
use crate::setpoint::Setpoint;
use crate::setpoint::follower::Follower;
use crate::units::{Position, Velocity};

/// What probing is at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Stage {
    /// Nothing.
    #[default]
    Idle = 0,
    /// On the way to the touch.
    Approach = 1,
    /// It touched: coming to rest.
    Stop = 2,
    /// On the way back.
    Retract = 3,
    /// Coming to rest at the end of the way back.
    Brake = 4,
    /// Coming to rest for another reason.
    Halt = 5,
}

/// What probing sees in a tick.
#[derive(Clone, Copy, Debug)]
pub struct Sight<'a> {
    /// The capture, unwrapped.
    pub observation: &'a Observation<'a>,
    /// Reads the edges; it has taken note of the tick.
    pub edges: &'a EdgeReader<'a>,
    /// What is estimated of the motion.
    pub estimate: &'a Estimate,
    /// The tick.
    pub tick: u32,
}

/// An edge that may become a touch.
#[derive(Clone, Copy, Debug)]
struct Noted {
    edge: Edge,
    /// The tick that took it in.
    tick: u32,
    /// When it came, as [`History::now`] counts; none if that was too long ago to be measured.
    instant: Option<u32>,
}

/// Probing, and what the probe showed.
#[derive(Clone, Debug)]
pub struct Probe {
    config: Config,
    stage: Stage,
    order: ProbeOrder,
    /// 1 or −1.
    direction: i64,
    follower: Follower,
    trigger: Trigger,
    /// The edge that a touch began with, until its place is found.
    edge: Option<Noted>,
    /// What to end with once the axis stands.
    end: ProbeEnd,
    touch: Option<Touch>,
    /// The touch has yet to be told where it is for users.
    is_unplaced: bool,
    settling: u32,
    /// Last place of the retract, raw d.
    back: Position,
    report: Report,
    history: History,
}

impl Probe {
    /// Nothing was probed.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            stage: Stage::Idle,
            order: ProbeOrder {
                target: Position::ZERO,
                feed: Velocity::ZERO,
                retract: Position::ZERO,
            },
            direction: 1,
            follower: Follower::new(config.follower),
            trigger: Trigger::new(),
            edge: None,
            end: ProbeEnd::Interrupted,
            touch: None,
            is_unplaced: false,
            settling: 0,
            back: Position::ZERO,
            report: Report {
                touches: 0,
                ends: 0,
                end: None,
                touch: None,
                glitches: 0,
            },
            history: History::new(),
        }
    }

    /// Takes another configuration; probing that runs goes on by it.
    pub fn reconfigure(&mut self, config: Config) {
        self.config = config;
        self.follower.reconfigure(config.follower);
    }

    /// Where it stands.
    #[must_use]
    pub const fn stage(&self) -> Stage {
        self.stage
    }

    /// True while probing commands the setpoint.
    #[must_use]
    #[inline]
    pub const fn is_active(&self) -> bool {
        !matches!(self.stage, Stage::Idle)
    }

    /// True while ticks matter to it.
    #[must_use]
    pub const fn is_awake(&self) -> bool {
        self.is_active() || self.trigger.is_awake()
    }

    /// What it came to.
    #[must_use]
    pub const fn report(&self) -> &Report {
        &self.report
    }

    /// The configuration in force.
    #[must_use]
    pub const fn config(&self) -> &Config {
        &self.config
    }

    /// The axis may not go on: ends as it is.
    #[cold]
    pub fn interrupt(&mut self, encoder_lost: bool) {
        if self.is_active() {
            let end = match self.stage {
                Stage::Halt => self.end,
                _ if encoder_lost => ProbeEnd::EncoderLost,
                _ => ProbeEnd::Interrupted,
            };
            self.finish(end);
        }
        self.edge = None;
    }

    /// The setpoint of a tick while probing is active.
    pub fn step(&mut self, sight: &Sight<'_>) -> Setpoint {
        let observation = sight.observation;
        let was_closed = self.trigger.is_closed();
        let edge = self.trigger.step(self.config.debounce, observation);
        self.report.glitches = self.trigger.glitches();
        self.gather(sight);
        match self.stage {
            Stage::Idle => {}
            Stage::Approach => self.approach(edge, was_closed, sight),
            Stage::Stop => self.stop(sight),
            Stage::Retract => self.retract(edge),
            Stage::Brake => self.brake(edge, observation),
            Stage::Halt => {
                self.measure(sight);
                if self.follower.is_at_rest() {
                    self.finish(self.end);
                }
            }
        }
        self.follower.step(self.target())
    }

    /// Takes notice of a tick in which something else than probing moves the axis, or nothing; true if it is to stop.
    #[cold]
    pub fn watch(&mut self, sight: &Sight<'_>, is_moving: bool) -> bool {
        let touched = self.trigger.step(self.config.debounce, sight.observation);
        self.report.glitches = self.trigger.glitches();
        if touched.is_none() {
            let pending = self.trigger.pending();
            // As the axis moved when it came.
            self.touch = pending.map(|edge| {
                self.touch
                    .unwrap_or_else(|| by_count(&edge, sight, &self.config))
            });
            return false;
        }
        self.note_touch();
        let stops = is_moving && self.config.stops_others;
        if !stops {
            self.conclude(ProbeEnd::Unasked);
        }
        stops
    }

    /// Stops what moved the axis, from its last setpoint, after a touch that nobody sought.
    pub fn halt(&mut self, last: &Setpoint) {
        self.direction = if last.velocity < 0 { -1 } else { 1 };
        self.follower.take_over(last);
        self.edge = None;
        self.end = ProbeEnd::Unasked;
        self.stage = Stage::Halt;
    }

    /// The raw place of a touch that has yet to be told where it is for users.
    #[must_use]
    pub fn unplaced(&self) -> Option<Position> {
        let touch = self.report.touch.filter(|_| self.is_unplaced);
        touch.map(|touch| touch.raw)
    }

    /// Tells where that touch is for users.
    pub fn place(&mut self, position: Position) {
        self.is_unplaced = false;
        if let Some(touch) = &mut self.touch {
            touch.position = position;
        }
        if let Some(touch) = &mut self.report.touch {
            touch.position = position;
        }
    }

    fn note_touch(&mut self) {
        self.report.touches = self.report.touches.wrapping_add(1);
        self.report.touch = self.touch;
        self.is_unplaced = true;
    }

    fn finish(&mut self, end: ProbeEnd) {
        self.stage = Stage::Idle;
        self.conclude(end);
    }

    fn conclude(&mut self, end: ProbeEnd) {
        self.report.ends = self.report.ends.wrapping_add(1);
        self.report.end = Some(end);
        self.report.touch = self.touch.take();
        self.edge = None;
    }
}
