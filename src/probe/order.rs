//! What is to be probed, and whether it may be.

use super::{Probe, ProbeRefused, Stage};
use crate::setpoint::Setpoint;
use crate::setpoint::travel::TravelLimits;
use crate::units::{Position, Velocity};

/// What is to be probed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProbeOrder {
    /// How far to go for a touch, raw d.
    pub target: Position,
    /// Feed until the touch, d/tick; not negative.
    pub feed: Velocity,
    /// Way back from where the axis came to rest, d; not negative.
    pub retract: Position,
}

impl Probe {
    /// Begins from `last`, the last setpoint commanded. Gives the farthest that the axis goes on after a contact, d.
    ///
    /// # Errors
    /// [`ProbeRefused`]; nothing moves then.
    pub fn start(
        &mut self,
        order: &ProbeOrder,
        last: &Setpoint,
        travel: Option<TravelLimits>,
    ) -> Result<Position, ProbeRefused> {
        let bound = self.check(order, last.position, travel)?;
        self.order = *order;
        self.direction = if order.target > last.position { 1 } else { -1 };
        self.follower.take_over(last);
        self.history.clear();
        (self.edge, self.touch, self.is_unplaced) = (None, None, false);
        self.stage = Stage::Approach;
        Ok(bound)
    }

    fn check(
        &self,
        order: &ProbeOrder,
        from: Position,
        travel: Option<TravelLimits>,
    ) -> Result<Position, ProbeRefused> {
        let way = order.target.saturating_sub(from);
        if way.saturating_abs() < 1 {
            return Err(ProbeRefused::NoWay);
        }
        if order.feed <= 0 || order.feed > self.config.fastest || order.retract < 0 {
            return Err(ProbeRefused::FeedOutOfRange);
        }
        let bound = self.config.overtravel(order.feed);
        let whole = |way: Position| way.saturating_ceil().saturating_to_num();
        if bound > self.config.max_overtravel {
            return Err(ProbeRefused::Overtravel {
                bound: whole(bound),
                allowed: whole(self.config.max_overtravel),
            });
        }
        let (farthest, back) = if way > 0 {
            (
                order.target.saturating_add(bound),
                from.saturating_sub(order.retract),
            )
        } else {
            (
                order.target.saturating_sub(bound),
                from.saturating_add(order.retract),
            )
        };
        let is_within = |travel: TravelLimits| travel.contains(farthest) && travel.contains(back);
        match travel {
            Some(travel) if !is_within(travel) => Err(ProbeRefused::BeyondTravel),
            _ => Ok(bound),
        }
    }
}
