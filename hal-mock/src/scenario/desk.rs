//! The operator where requests take their time to the axis: asks are ordered ahead, from what records tell.

use leadscrew::telemetry::Record;

use super::action::{Action, Timed};
use super::definition::tick_at;
use super::error::ScenarioError;
use super::operator::{Operator, Order, Seen};

/// How long before its tick a request is made, ticks: more than planning takes on the target.
pub const LEAD_TICKS: u32 = 32;

/// The timeline of a scenario, as the operator goes through it.
#[derive(Clone, Debug)]
pub struct Desk<'s> {
    operator: Operator,
    timeline: &'s [Timed],
    next: usize,
    tick_hz: f64,
}

impl<'s> Desk<'s> {
    /// The desk of `operator`, before the run.
    #[must_use]
    pub const fn new(operator: Operator, timeline: &'s [Timed], tick_hz: f64) -> Self {
        Self {
            operator,
            timeline,
            next: 0,
            tick_hz,
        }
    }

    /// Looks at a record, then orders what is due by [`LEAD_TICKS`] after it: `send` is given each order and the tick
    /// that it is for.
    ///
    /// # Errors
    /// The planner refuses an order.
    pub fn follow(
        &mut self,
        record: &Record,
        send: impl FnMut(Order, u32),
    ) -> Result<(), ScenarioError> {
        let seen = Seen::in_record(record);
        self.operator.look(&seen);
        self.order_until(record.tick.wrapping_add(LEAD_TICKS), &seen, send)
    }

    /// Orders what is due before the first record.
    ///
    /// # Errors
    /// The planner refuses an order.
    pub fn open(&mut self, send: impl FnMut(Order, u32)) -> Result<(), ScenarioError> {
        self.order_until(0, &Seen::default(), send)
    }

    fn order_until(
        &mut self,
        last: u32,
        seen: &Seen,
        mut send: impl FnMut(Order, u32),
    ) -> Result<(), ScenarioError> {
        while let Some(timed) = self.timeline.get(self.next) {
            let tick = tick_at(timed.at_s, self.tick_hz);
            if tick > last {
                break;
            }
            self.next += 1;
            if let Action::Ask(ask) = &timed.action {
                send(self.operator.order(ask, tick, seen)?, tick);
            }
        }
        Ok(())
    }
}
