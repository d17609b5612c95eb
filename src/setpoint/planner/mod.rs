//! The operator's side of planned motion, outside the tick: moves, feed, override, hold, stop and jog.
//!
//! A planner knows the plans that it made and thereby the exact state of the axis at any tick to come. Each order
//! is turned into a plan from that state at a stated tick ahead, to be given to [`Axis::queue`]; the axis takes it
//! over at that tick without a step. If it comes too late for that, the axis goes on by the plan before, and the
//! planner is told so by [`Planner::withdraw`].
//!
//! [`Axis::queue`]: crate::axis::Axis::queue

mod error;

pub use error::PlannerError;

use super::limits::Limits;
use super::plan::{Plan, State};
use super::travel::TravelLimits;
use crate::units::{Position, Velocity};

/// Largest feed override, percent.
pub const LARGEST_OVERRIDE: u16 = 200;
/// How far a jog goes without limits of travel, d.
const FAR: Position = Position::from_bits(1 << (30 + Position::FRAC_NBITS));

/// A plan and the tick of its start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Timed {
    /// The plan.
    pub plan: Plan,
    /// Tick of its start.
    pub start: u32,
}

impl Timed {
    /// Ticks from its start to `tick`; negative before.
    const fn age(&self, tick: u32) -> i32 {
        tick.wrapping_sub(self.start).cast_signed()
    }
}

/// What the operator wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Order {
    /// Where the axis is to go; none after a stop.
    target: Option<Position>,
    /// Feed before the override, d/tick.
    feed: Velocity,
    percent: u16,
    held: bool,
}

/// The planner of an axis.
#[derive(Clone, Debug)]
pub struct Planner {
    limits: Limits,
    travel: Option<TravelLimits>,
    /// Ticks from an order to the start of a motion from rest.
    notice: u32,
    order: Order,
    /// The order before the plan made last.
    previous_order: Order,
    /// The plan in force before the one made last starts.
    previous: Timed,
    latest: Timed,
}

impl Planner {
    /// A planner for an axis that stands at `position` at `tick`, under control.
    #[must_use]
    pub fn new(limits: Limits, position: Position, tick: u32) -> Self {
        let order = Order {
            target: None,
            feed: limits.velocity(),
            percent: 100,
            held: false,
        };
        let standing = Timed {
            plan: Plan::standing(position),
            start: tick,
        };
        Self {
            limits,
            travel: None,
            notice: 1,
            order,
            previous_order: order,
            previous: standing,
            latest: standing,
        }
    }

    /// Begins anew where the axis stands under control: after a fault, a stop by the supervisor, homing, or a start.
    /// All orders but the override are forgotten.
    pub fn begin(&mut self, position: Position, tick: u32) {
        let percent = self.order.percent;
        let (travel, notice) = (self.travel, self.notice);
        *self = Self::new(self.limits, position, tick);
        self.order.percent = percent;
        (self.travel, self.notice) = (travel, notice);
    }

    /// Forgets what is over at `tick`; to be called at least every 2³⁰ ticks, as ticks wrap.
    pub fn pass(&mut self, tick: u32) {
        if self.latest.age(tick) >= self.latest.plan.ticks().cast_signed() {
            let end = self.latest.plan.end();
            self.latest = Timed {
                plan: Plan::standing_at(end),
                start: tick,
            };
            self.previous = self.latest;
            self.previous_order = self.order;
        }
    }

    /// Takes limits of travel, once the axis is homed, or does without.
    pub const fn set_travel(&mut self, travel: Option<TravelLimits>) {
        self.travel = travel;
    }

    /// Lets motions from rest start as much later than asked for as makes `ticks` from the order on: what the drive needs to be
    /// ready for them ([`Axis::notice_ticks`](crate::axis::Axis::notice_ticks)). Motions that change others start as asked.
    pub const fn set_notice(&mut self, ticks: u32) {
        self.notice = ticks;
    }

    /// The exact state at a tick not before the last one passed.
    #[must_use]
    pub fn state_at(&self, tick: u32) -> State {
        let timed = if self.latest.age(tick) < 0 {
            &self.previous
        } else {
            &self.latest
        };
        timed.plan.state_at(timed.age(tick).max(0).cast_unsigned())
    }

    /// The tick at which the last plan ends.
    #[must_use]
    pub const fn end_tick(&self) -> u32 {
        self.latest.start.wrapping_add(self.latest.plan.ticks())
    }

    /// Where the axis is to go, held or not.
    #[must_use]
    pub const fn target(&self) -> Option<Position> {
        self.order.target
    }

    /// True after a feed hold, until it is resumed.
    #[must_use]
    pub const fn is_held(&self) -> bool {
        self.order.held
    }

    /// Goes to `target` d with `feed` d/tick (its size; never above the axis's limit), from whatever it does at tick
    /// `start`. While held or with an override of 0 the target is remembered, and nothing is to be queued.
    ///
    /// # Errors
    /// [`PlannerError`]
    pub fn move_to(
        &mut self,
        target: Position,
        feed: Velocity,
        start: u32,
    ) -> Result<Option<Timed>, PlannerError> {
        if let Some(travel) = self.travel
            && !travel.contains(target)
        {
            return Err(PlannerError::BeyondTravel { target, travel });
        }
        let order = Order {
            target: Some(target),
            feed: feed.saturating_abs(),
            ..self.order
        };
        self.carry_out(order, start)
    }

    /// Moves with `velocity` d/tick until it is stopped, or to the soft limit on that side.
    ///
    /// # Errors
    /// [`PlannerError`]
    pub fn jog(&mut self, velocity: Velocity, start: u32) -> Result<Option<Timed>, PlannerError> {
        if velocity == 0 {
            return self.stop(start);
        }
        let forward = velocity > 0;
        let target = match self.travel {
            Some(travel) if forward => travel.high(),
            Some(travel) => travel.low(),
            None => {
                let from = self.state_at(start).position();
                let far = if forward { FAR } else { -FAR };
                from.saturating_add(far)
            }
        };
        self.move_to(target, velocity, start)
    }

    /// Stops as fast as the limits allow, and forgets the target.
    ///
    /// # Errors
    /// [`PlannerError::TooEarly`]
    pub fn stop(&mut self, start: u32) -> Result<Option<Timed>, PlannerError> {
        let order = Order {
            target: None,
            ..self.order
        };
        self.carry_out(order, start)
    }

    /// Feed hold: stops as fast as the limits allow, and remembers the target.
    ///
    /// # Errors
    /// [`PlannerError::TooEarly`]
    pub fn hold(&mut self, start: u32) -> Result<Option<Timed>, PlannerError> {
        let order = Order {
            held: true,
            ..self.order
        };
        self.carry_out(order, start)
    }

    /// Ends a feed hold: goes on to the target.
    ///
    /// # Errors
    /// [`PlannerError`]
    pub fn resume(&mut self, start: u32) -> Result<Option<Timed>, PlannerError> {
        let order = Order {
            held: false,
            ..self.order
        };
        self.carry_out(order, start)
    }

    /// Feed override in percent of the feed, 0 to 200; 0 stops until it is raised. The axis's limit stays.
    ///
    /// # Errors
    /// [`PlannerError`]
    pub fn set_override(
        &mut self,
        percent: u16,
        start: u32,
    ) -> Result<Option<Timed>, PlannerError> {
        if percent > LARGEST_OVERRIDE {
            return Err(PlannerError::Override { percent });
        }
        let order = Order {
            percent,
            ..self.order
        };
        self.carry_out(order, start)
    }

    /// Takes the last plan back: the axis did not take it and goes on by the one before.
    pub fn withdraw(&mut self) {
        self.latest = self.previous;
        self.order = self.previous_order;
    }

    fn carry_out(&mut self, order: Order, start: u32) -> Result<Option<Timed>, PlannerError> {
        let state = self.state_at(start);
        let goes_to = order.target.filter(|_| !order.held && order.percent > 0);
        let nothing_to_do =
            state.is_at_rest() && goes_to.is_none_or(|target| state == State::at_rest(target));
        if nothing_to_do || order == self.order {
            self.order = order;
            return Ok(None);
        }
        if self.latest.age(start) <= 0 {
            return Err(PlannerError::TooEarly {
                start,
                last: self.latest.start,
            });
        }
        let plan = match goes_to {
            Some(target) => {
                let bits = i64::from(order.feed.to_bits())
                    .wrapping_mul(i64::from(order.percent))
                    .wrapping_div(100);
                let feed = Velocity::from_bits(bits.min(i64::from(i32::MAX)) as i32);
                Plan::to(state, target, &self.limits.slowed(feed))?
            }
            None => Plan::stop(state, &self.limits)?,
        };
        let start = if state.is_at_rest() {
            start.wrapping_add(self.notice).wrapping_sub(1)
        } else {
            start
        };
        self.previous = self.latest;
        self.previous_order = self.order;
        self.latest = Timed { plan, start };
        self.order = order;
        Ok(Some(self.latest))
    }
}
