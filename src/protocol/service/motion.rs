//! Orders of motion: from nanometres and µm/min to plans that start a few ticks ahead.

use super::port::{Order, Passed, Port, Seen, Ticket};
use crate::axis;
use crate::params::AxisConfig;
use crate::probe::ProbeOrder;
use crate::protocol::refusal::Refusal;
use crate::protocol::request::Request;
use crate::setpoint::planner::{Planner, PlannerError, Timed};
use crate::units::{AxisScale, Position, Velocity};

/// Farthest target, nm.
const MAX_TARGET_NM: i64 = 1_000_000_000_000;
/// How many times the lead a plan has after one that came too late.
const LATE_STRETCH: u32 = 8;
const NM_PER_MM: f64 = 1e6;
const UM_PER_MM: f64 = 1e3;

/// What the axis is to do by plans.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Motion {
    Move { target_nm: i64, feed_um: u32 },
    Jog { feed_um: i32 },
    Hold,
    Resume,
    Override { percent: u16 },
    Stop,
}

impl Motion {
    /// What a request asks for, if it asks for motion by plans.
    pub(super) const fn of(request: &Request<'_>) -> Option<Self> {
        Some(match *request {
            Request::Move {
                target_nm,
                feed_um_per_min: feed_um,
            } => Self::Move { target_nm, feed_um },
            Request::Jog {
                feed_um_per_min: feed_um,
            } => Self::Jog { feed_um },
            Request::Hold {} => Self::Hold,
            Request::Resume {} => Self::Resume,
            Request::Override { percent } => Self::Override { percent },
            Request::Stop {} => Self::Stop,
            _ => return None,
        })
    }
}

/// A stop that waits until the plan before it has begun: an axis keeps one waiting plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Waiting {
    Hold,
    Stop,
}

/// The planner with what it stands for in the units of the link.
#[derive(Clone, Debug)]
pub(super) struct Mover {
    scale: AxisScale,
    fastest_um: f64,
    /// Ticks from an order to the start of its plan.
    lead: u32,
    /// The last plan came too late: the next one, which is likely to be the same again, has more time.
    was_late: bool,
    planner: Planner,
    percent: u16,
    /// Something else than the planner's plans moved the axis.
    is_stale: bool,
    dropped_plans: u32,
    /// Start of the plan that the axis has not begun.
    start: Option<u32>,
    /// The same plan on its way to the axis.
    on_its_way: Option<Ticket>,
    waiting: Option<Waiting>,
}

impl Mover {
    pub(super) fn new(config: &AxisConfig, max_feed_mm_per_min: f64, lead: u32) -> Self {
        Self {
            scale: config.scale,
            fastest_um: max_feed_mm_per_min * UM_PER_MM,
            lead,
            was_late: false,
            planner: Planner::new(config.limits, Position::ZERO, 0),
            percent: 100,
            is_stale: true,
            dropped_plans: 0,
            start: None,
            on_its_way: None,
            waiting: None,
        }
    }

    /// Begins anew for another configuration of an axis that is off; the override stays.
    pub(super) fn reconfigure(&mut self, config: &AxisConfig, max_feed_mm_per_min: f64) {
        let percent = self.percent;
        let dropped_plans = self.dropped_plans;
        *self = Self::new(config, max_feed_mm_per_min, self.lead);
        let _ = self.planner.set_override(percent, 0);
        self.percent = percent;
        self.dropped_plans = dropped_plans;
    }

    pub(super) const fn is_held(&self) -> bool {
        self.planner.is_held()
    }

    /// True while a plan waits for its start.
    pub(super) const fn is_to_start(&self) -> bool {
        self.start.is_some()
    }

    pub(super) const fn percent(&self) -> u16 {
        self.percent
    }

    /// Looks at the axis; then does what waits, if it may.
    pub(super) fn look(&mut self, seen: &Seen, port: &mut dyn Port) {
        if seen.dropped_plans != self.dropped_plans {
            self.dropped_plans = seen.dropped_plans;
            self.planner.withdraw();
        }
        let has_begun = |start: u32| seen.tick.wrapping_sub(start).cast_signed() >= 0;
        if self.start.is_some_and(has_begun) {
            self.start = None;
        }
        if !seen.is_planned {
            self.is_stale = true;
            self.start = None;
            self.waiting = None;
        }
        if !self.is_stale {
            self.planner.pass(seen.tick);
        }
        if self.start.is_none()
            && let Some(waiting) = self.waiting.take()
        {
            let motion = match waiting {
                Waiting::Hold => Motion::Hold,
                Waiting::Stop => Motion::Stop,
            };
            // A stop is refused only where nothing moves by plans any more.
            let _ = self.order(motion, seen, port);
        }
    }

    /// Plans it and passes it on.
    pub(super) fn order(
        &mut self,
        motion: Motion,
        seen: &Seen,
        port: &mut dyn Port,
    ) -> Result<Passed, Refusal> {
        if self.start.is_some() {
            self.waiting = match motion {
                Motion::Stop => Some(Waiting::Stop),
                Motion::Hold => Some(self.waiting.unwrap_or(Waiting::Hold)),
                _ => return Err(Refusal::Busy),
            };
            return Ok(Passed::Taken);
        }
        self.catch_up(seen)?;
        let stretch = if self.was_late { LATE_STRETCH } else { 1 };
        let start = seen.tick.wrapping_add(self.lead.saturating_mul(stretch));
        let Some(Timed { plan, start }) = self.plan(motion, seen, start)? else {
            return Ok(Passed::Taken);
        };
        let queue = axis::Request::Queue { plan, start };
        let passed = port
            .order(&Order::Axis(queue))
            .inspect_err(|_| self.planner.withdraw())?;
        self.start = Some(start);
        self.on_its_way = match passed {
            Passed::Taken => None,
            Passed::OnItsWay(ticket) => Some(ticket),
        };
        Ok(passed)
    }

    /// What came of a plan that was on its way.
    pub(super) fn settle(&mut self, ticket: Ticket, outcome: Result<(), Refusal>) {
        if self.on_its_way == Some(ticket) {
            self.on_its_way = None;
            self.was_late = outcome == Err(Refusal::TooLate);
            if outcome.is_err() {
                self.planner.withdraw();
                self.start = None;
            }
        }
    }

    /// Begins anew where something else has moved the axis.
    fn catch_up(&mut self, seen: &Seen) -> Result<(), Refusal> {
        if !self.is_stale {
            return Ok(());
        }
        if seen.moving {
            return Err(Refusal::StillMoving);
        }
        self.planner.begin(seen.commanded, seen.tick);
        self.is_stale = false;
        Ok(())
    }

    fn plan(&mut self, motion: Motion, seen: &Seen, start: u32) -> Result<Option<Timed>, Refusal> {
        self.planner.set_travel(seen.travel);
        let planned = match motion {
            Motion::Move { target_nm, feed_um } => {
                let target = self.raw(seen, target_nm)?;
                let feed = self.feed(f64::from(feed_um))?;
                if feed == 0 {
                    return Err(Refusal::FeedOutOfRange);
                }
                self.planner.move_to(target, feed, start)
            }
            Motion::Jog { feed_um } => {
                let feed = self.feed(f64::from(feed_um))?;
                self.planner.jog(feed, start)
            }
            Motion::Hold => self.planner.hold(start),
            Motion::Resume => self.planner.resume(start),
            Motion::Override { percent } => self
                .planner
                .set_override(percent, start)
                .inspect(|_| self.percent = percent),
            Motion::Stop => self.planner.stop(start),
        };
        planned.map_err(PlannerError::into)
    }

    /// What is to be probed.
    pub(super) fn probe_order(
        &self,
        seen: &Seen,
        target_nm: i64,
        feed_um: u32,
        retract_nm: u32,
    ) -> Result<ProbeOrder, Refusal> {
        if self.start.is_some() {
            return Err(Refusal::Busy);
        }
        let retract = self.scale.counts_from_mm(f64::from(retract_nm) / NM_PER_MM);
        Ok(ProbeOrder {
            target: self.raw(seen, target_nm)?,
            feed: self.feed(f64::from(feed_um))?,
            retract: Position::saturating_from_num(retract),
        })
    }

    /// The raw position of a coordinate.
    fn raw(&self, seen: &Seen, nm: i64) -> Result<Position, Refusal> {
        if nm.unsigned_abs() > MAX_TARGET_NM.unsigned_abs() {
            return Err(Refusal::TargetOutOfRange);
        }
        let counts = self.scale.counts_from_mm(nm as f64 / NM_PER_MM);
        let position = Position::checked_from_num(counts).ok_or(Refusal::TargetOutOfRange)?;
        Ok(seen.origin.unwrap_or_default().saturating_add(position))
    }

    /// A feed of either sign.
    fn feed(&self, um_per_min: f64) -> Result<Velocity, Refusal> {
        if libm::fabs(um_per_min) > self.fastest_um {
            return Err(Refusal::FeedOutOfRange);
        }
        let velocity = self.scale.velocity_from_feed(um_per_min / UM_PER_MM);
        velocity
            .map(Velocity::saturating_from_num)
            .map_err(|_| Refusal::FeedOutOfRange)
    }

    /// A position in nm.
    pub(super) fn nm(&self, position: Position) -> i64 {
        // A cast saturates; so does the one below.
        libm::round(self.scale.mm_from_counts(position.to_num()) * NM_PER_MM) as i64
    }

    /// A velocity in µm/min.
    pub(super) fn um_per_min(&self, velocity: Velocity) -> i32 {
        libm::round(self.scale.feed_from_velocity(velocity.to_num()) * UM_PER_MM) as i32
    }
}
