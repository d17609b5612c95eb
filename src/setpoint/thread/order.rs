//! What a pass of a thread is to be, and why it may be refused.

use core::fmt;

use super::reach::ThreadPlace;
use crate::parameter_table;
use crate::setpoint::profile::PlanError;
use crate::units::{RangeError, checked};

parameter_table! {
    /// Thread cutting: what is kept in reserve.
    pub struct ThreadParams {
        /// How much faster than at planning the spindle may turn in a pass
        thread_speed_rise: 0.1, "of the speed", 0.02..=1.0;
        /// How much slower than at planning the spindle may turn in a pass
        thread_speed_drop: 0.3, "of the speed", 0.02..=0.95;
        /// Share of the axis' acceleration and jerk that the run-in may use at the planned speed
        thread_limit_share: 0.8, "1", 0.1..=1.0;
        /// Way in the direction of the thread up to where a pass begins, which takes up backlash
        thread_take_up_mm: 1.0, "mm", 0.0..=100.0;
        /// Time on the line before the full-depth part, and at rest before the run-in
        thread_settle_s: 0.1, "s", 0.0..=10.0;
    }
}

/// Way that the spindle turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SpindleWay {
    /// Its counts rise.
    #[default]
    Forward,
    /// Its counts fall.
    Backward,
}

/// One pass of a thread. Positions are from the axis' origin; the thread is cut from `from_mm` to `to_mm`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThreadOrder {
    /// Travel a revolution (starts × pitch), mm; its direction follows from the positions.
    pub lead_mm: f64,
    /// Where the pass waits for the spindle, at rest, mm.
    pub start_mm: f64,
    /// Where the full-depth part begins, mm.
    pub from_mm: f64,
    /// Where the full-depth part ends, mm.
    pub to_mm: f64,
    /// θ₀, °: where the spindle stands when the line passes the origin.
    pub angle_deg: f64,
    /// Starts of the thread.
    pub starts: u32,
    /// Which of them this pass cuts, from 0.
    pub start: u32,
    /// Way that the spindle turns.
    pub spindle: SpindleWay,
    /// How much before the end of the full-depth part retraction is requested, °.
    pub retract_deg: f64,
}

impl ThreadOrder {
    /// Checks what can be checked without the machine.
    pub(super) fn check(&self) -> Result<(), ThreadRefusal> {
        checked("lead_mm", self.lead_mm, 0.001, 1000.0)?;
        for (name, value) in [
            ("start_mm", self.start_mm),
            ("from_mm", self.from_mm),
            ("to_mm", self.to_mm),
        ] {
            checked(name, value, -1e5, 1e5)?;
        }
        checked("angle_deg", self.angle_deg, -360.0, 360.0)?;
        checked("retract_deg", self.retract_deg, 0.0, 3600.0)?;
        if self.start >= self.starts {
            return Err(ThreadRefusal::NoSuchStart {
                start: self.start,
                starts: self.starts,
            });
        }
        let (run_in, cut) = (self.from_mm - self.start_mm, self.to_mm - self.from_mm);
        if run_in * cut > 0.0 {
            Ok(())
        } else {
            Err(ThreadRefusal::Order)
        }
    }
}

/// What a pass will be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThreadFigures {
    /// Speed of the spindle at planning, rpm.
    pub rpm: f64,
    /// Feed at that speed, mm/min.
    pub feed_mm_per_min: f64,
    /// Way that the run-in needs, settling on the line included, mm.
    pub run_in_mm: f64,
    /// Where the axis comes to rest after the run-out, mm from the origin.
    pub rest_mm: f64,
}

/// Why a pass was refused; nothing has moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ThreadRefusal {
    /// The axis is not enabled.
    Disabled,
    /// The axis moves, or a pass is under way.
    Moving,
    /// Another source than planned moves is selected.
    OtherSource,
    /// No signal comes from the spindle's encoder.
    NoSignal,
    /// The spindle does not turn.
    SpindleStands,
    /// The spindle turns the other way.
    WrongWay,
    /// No index has been seen in this direction.
    NoIndex,
    /// Lead × speed is more than the axis can do.
    TooFast {
        /// Feed with the speed's reserve, mm/min.
        feed_mm_per_min: f64,
        /// Largest feed of the axis, mm/min.
        max_feed_mm_per_min: f64,
        /// Speed of the spindle, rpm.
        rpm: f64,
        /// Largest speed for this lead, rpm.
        max_rpm: f64,
    },
    /// The axis cannot be on the line where the full-depth part begins.
    RunInTooShort {
        /// Way that is needed, mm.
        needed_mm: f64,
        /// Way there is, mm.
        available_mm: f64,
    },
    /// The pass would leave the soft limits of travel.
    BeyondTravel {
        /// The place that lies beyond them.
        place: ThreadPlace,
        /// Where it lies, mm.
        at_mm: f64,
        /// The low limit, mm.
        low_mm: f64,
        /// The high limit, mm.
        high_mm: f64,
    },
    /// The positions do not follow one another in one direction.
    Order,
    /// A start that the thread has not.
    NoSuchStart {
        /// The one asked for, from 0.
        start: u32,
        /// How many there are.
        starts: u32,
    },
    /// A quantity is out of range.
    Range(RangeError),
    /// The way to the start cannot be planned.
    Approach(PlanError),
}

impl From<RangeError> for ThreadRefusal {
    fn from(error: RangeError) -> Self {
        Self::Range(error)
    }
}

impl fmt::Display for ThreadRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Disabled => f.write_str("the axis is not enabled: enable it first"),
            Self::Moving => f.write_str("the axis moves: wait until it stands"),
            Self::OtherSource => {
                f.write_str("another source of setpoints is selected: select planned moves first")
            }
            Self::NoSignal => {
                f.write_str("no signal from the spindle's encoder: check its cable and supply")
            }
            Self::SpindleStands => {
                f.write_str("the spindle stands: start it and wait for its speed")
            }
            Self::WrongWay => f.write_str(
                "the spindle turns the other way: reverse it, or order the thread for that way",
            ),
            Self::NoIndex => f.write_str(
                "no index of the spindle has been seen in this direction: let it turn once, or check the index line",
            ),
            Self::TooFast {
                feed_mm_per_min,
                max_feed_mm_per_min,
                rpm,
                max_rpm,
            } => write!(
                f,
                "at {rpm:.1} rpm the thread needs a feed of {feed_mm_per_min:.0} mm/min with reserve, the axis has \
                 {max_feed_mm_per_min:.0}: turn the spindle at {max_rpm:.1} rpm at most"
            ),
            Self::RunInTooShort {
                needed_mm,
                available_mm,
            } => write!(
                f,
                "the run-in needs {needed_mm:.3} mm and has {available_mm:.3}: start farther away or turn slower"
            ),
            Self::BeyondTravel {
                place,
                at_mm,
                low_mm,
                high_mm,
            } => write!(
                f,
                "{place} at {at_mm:.3} mm, and the soft limits of travel are {low_mm:.3} to {high_mm:.3} mm: {}",
                place.remedy()
            ),
            Self::Order => f.write_str(
                "start_mm, from_mm and to_mm must follow one another in the direction of the thread",
            ),
            Self::NoSuchStart { start, starts } => write!(
                f,
                "start {start} of a thread with {starts}: expected 0 to {}",
                starts.saturating_sub(1)
            ),
            Self::Range(error) => error.fmt(f),
            Self::Approach(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for ThreadRefusal {}
