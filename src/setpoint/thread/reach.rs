//! Where a pass takes the axis, against the soft limits of travel.
//!
//! A pass goes from the far end of the take-up to where its run-out ends, and nowhere back. A controlled stop on the way
//! takes no more room than the run-out, which is planned within a share of the same limits, so a pass that is let through
//! ends within the travel whatever becomes of it.

use core::fmt;

use super::order::ThreadRefusal;
use crate::setpoint::travel::TravelLimits;
use crate::units::{AxisScale, Position};

/// How the axis stands when a pass is planned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Standing {
    /// Where it is.
    pub position: Position,
    /// Where its users count from.
    pub origin: Position,
    /// The soft limits of travel, if there are any.
    pub travel: Option<TravelLimits>,
}

/// A place that a pass comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThreadPlace {
    /// Where the take-up of backlash begins.
    TakeUp,
    /// Where the pass waits for the spindle.
    Start,
    /// Where the run-out comes to rest.
    Rest,
}

impl ThreadPlace {
    /// What to do about a place that is out of reach.
    pub(super) const fn remedy(self) -> &'static str {
        match self {
            Self::TakeUp => "start farther inside, or lower thread_take_up_mm",
            Self::Start => "start farther inside",
            Self::Rest => "end the thread earlier, or turn slower",
        }
    }
}

impl fmt::Display for ThreadPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TakeUp => "the take-up before the start begins",
            Self::Start => "the start lies",
            Self::Rest => "the run-out ends",
        })
    }
}

/// Places in the order in which a pass comes to them, d.
pub(super) struct Reach {
    pub(super) take_up: Position,
    pub(super) start: Position,
    pub(super) rest: Position,
}

impl Reach {
    /// Refuses a pass that would leave `travel`; places are told from `origin`.
    pub(super) fn check(
        &self,
        travel: &TravelLimits,
        origin: Position,
        scale: AxisScale,
    ) -> Result<(), ThreadRefusal> {
        let mm = |place: Position| scale.mm_from_counts(place.saturating_sub(origin).to_num());
        let places = [
            (ThreadPlace::TakeUp, self.take_up),
            (ThreadPlace::Start, self.start),
            (ThreadPlace::Rest, self.rest),
        ];
        match places.iter().find(|(_, at)| !travel.contains(*at)) {
            None => Ok(()),
            Some((place, at)) => Err(ThreadRefusal::BeyondTravel {
                place: *place,
                at_mm: mm(*at),
                low_mm: mm(travel.low()),
                high_mm: mm(travel.high()),
            }),
        }
    }
}
