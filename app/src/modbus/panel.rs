//! What the axis gives to the line.

use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::service::{Passed, Seen, Ticket};
use leadscrew::settings::Settings;
use leadscrew::supervisor::{FirstFault, State};
use leadscrew::units::{AxisScale, Position, Velocity};

use crate::tick::Counts;

const NM_PER_MM: f64 = 1e6;
const UM_PER_MM: f64 = 1e3;

/// Where the probe touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProbeLatch {
    /// Rises by one with each latch; wraps.
    pub count: u16,
    /// Position of the axis at the touch, nm from the origin.
    pub position_nm: i64,
}

/// The axis at a moment.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// As the last tick left it.
    pub seen: Seen,
    /// What its counts and ticks are in mm and mm/min.
    pub scale: AxisScale,
    /// Feed override, %.
    pub percent: u16,
    /// A feed hold is on.
    pub is_held: bool,
    /// A tool holds the control lease.
    pub is_leased: bool,
    /// Counts of the tick.
    pub counts: Counts,
    /// The fault that is latched, with its context.
    pub first_fault: Option<FirstFault>,
    /// The last touch of the probe; none since the start, or on an axis that latches none.
    pub probe: Option<ProbeLatch>,
    /// What the axis can do: bits of [`reply`](leadscrew::protocol::reply).
    pub capabilities: u32,
}

impl View {
    /// True if parameters may be written: the drive is off, and nothing is about to enable it.
    #[must_use]
    pub const fn is_off(&self) -> bool {
        !self.seen.enabled && matches!(self.seen.state, State::Disabled | State::Fault)
    }

    /// A distance in nm.
    pub(super) fn nm(&self, distance: Position) -> i64 {
        // A cast saturates; so do those below.
        libm::round(self.scale.mm_from_counts(distance.to_num()) * NM_PER_MM) as i64
    }

    /// A raw position in nm from the origin.
    pub(super) fn coordinate_nm(&self, raw: Position) -> i64 {
        self.nm(raw.saturating_sub(self.seen.origin.unwrap_or_default()))
    }

    /// A distance in Q15.16 d in nm.
    pub(super) fn short_nm(&self, bits: i32) -> i32 {
        let nm = self.nm(Position::from_bits(i64::from(bits)));
        nm.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
    }

    /// A velocity in µm/min.
    pub(super) fn um_per_min(&self, velocity: Velocity) -> i32 {
        libm::round(self.scale.feed_from_velocity(velocity.to_num()) * UM_PER_MM) as i32
    }
}

/// The axis, for whoever reads its state and sets it up.
pub trait Panel {
    /// How it stands; asked once for a request, so that all values of a reply are of one tick.
    fn view(&self) -> View;

    /// What is set.
    fn settings(&self) -> Settings;

    /// Sets all of it, or nothing: it is validated here. What comes of it where it is on its way is asked of
    /// [`Self::outcome`].
    ///
    /// # Errors
    /// A [`Refusal`]; nothing is changed then. An axis that is on refuses with [`Refusal::AxisOn`].
    fn set(&mut self, settings: Settings) -> Result<Passed, Refusal>;

    /// What came of the last [`Self::set`], which was on its way with this ticket; none yet while it is.
    fn outcome(&mut self, ticket: Ticket) -> Option<Result<(), Refusal>>;

    /// Keeps all parameters in the store. It returns when they are there.
    ///
    /// # Errors
    /// A [`Refusal`]; [`Refusal::NotSupported`] where there is no store.
    fn save(&mut self) -> Result<(), Refusal>;
}
