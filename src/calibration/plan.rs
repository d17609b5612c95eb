//! What a run shall be, and how far it is.

use super::refusal::Refusal;
use super::taper::ORDER;

/// Fewest revolutions that an average is made of.
pub const MIN_REVOLUTIONS: u32 = 12;
/// Revolutions at the beginning that give the speed.
pub const MEASURING_REVOLUTIONS: u32 = 2;
/// How the shaft moves in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunMotion {
    /// Held at a constant feed.
    Steady,
    /// A free flywheel that slows down.
    Coast,
}

/// What a run shall be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunPlan {
    /// How the shaft moves.
    pub motion: RunMotion,
    /// Revolutions to average over, at least 12; of these the largest multiple of 4 is used. The run takes
    /// three more: up to the index, and two to measure the speed.
    pub revolutions: u32,
    /// Most that the duration of a revolution may differ from what the first ones gave, as a part of it.
    pub speed_tolerance: f64,
}

impl RunPlan {
    /// A steady feed, within 1 %.
    #[must_use]
    pub const fn steady(revolutions: u32) -> Self {
        Self {
            motion: RunMotion::Steady,
            revolutions,
            speed_tolerance: 0.01,
        }
    }

    /// A coast-down, within 2 % of a constant deceleration.
    #[must_use]
    pub const fn coast(revolutions: u32) -> Self {
        Self {
            motion: RunMotion::Coast,
            revolutions,
            speed_tolerance: 0.02,
        }
    }

    /// Revolutions that are used.
    pub(super) const fn averaged(&self) -> u32 {
        (self.revolutions / ORDER).wrapping_mul(ORDER)
    }

    pub(super) const fn check(&self) -> Result<(), Refusal> {
        if self.revolutions < MIN_REVOLUTIONS {
            return Err(Refusal::TooFewRevolutions {
                found: self.revolutions,
                needed: MIN_REVOLUTIONS,
            });
        }
        Ok(())
    }
}

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// No index yet.
    SeekingIndex,
    /// The first revolutions give the speed.
    MeasuringSpeed,
    /// So many revolutions are in the average.
    Averaging {
        /// Whole revolutions so far.
        revolutions: u32,
    },
    /// All revolutions are in; end the run.
    Complete,
}
