//! What the supervisor tells between ticks, and what it is told.

use super::record::FirstFault;
use super::{Fault, FaultSet, State, Supervisor};

impl Supervisor {
    /// Where it stands.
    #[must_use]
    #[inline]
    pub const fn state(&self) -> State {
        match (self.sequence.is_running(), self.moving) {
            (true, true) => State::Moving,
            (true, false) => State::Ready,
            (false, _) => self.sequence.state(self.moving, self.latch.is_set()),
        }
    }

    /// The fault that is latched.
    #[must_use]
    pub const fn fault(&self) -> Option<Fault> {
        self.latch.fault()
    }

    /// The fault that is latched, with its context.
    #[must_use]
    pub const fn first_fault(&self) -> Option<&FirstFault> {
        self.latch.first()
    }

    /// Warnings since the last [`Self::clear_warnings`].
    #[must_use]
    pub const fn warnings(&self) -> FaultSet {
        self.warnings
    }

    /// Forgets the warnings.
    pub fn clear_warnings(&mut self) {
        self.warnings = FaultSet::default();
        self.has_news = true;
    }

    /// True while enable is asked for anew and refused: a fault is latched, and has to be cleared first.
    #[must_use]
    pub const fn is_refused(&self) -> bool {
        self.refused
    }

    /// True if state, fault, warnings, refusal or brake may be others since it was asked last.
    #[inline]
    pub(crate) const fn has_news(&self) -> bool {
        self.has_news
    }

    /// It has been asked.
    pub(crate) const fn forget_news(&mut self) {
        self.has_news = false;
    }

    /// True if the loop was closed in the last tick.
    #[must_use]
    pub const fn is_in_loop(&self) -> bool {
        self.in_loop
    }

    /// True while sources of setpoints are followed.
    #[must_use]
    pub const fn is_following(&self) -> bool {
        self.sequence.is_running()
    }

    /// True if the brake is to be open.
    #[must_use]
    #[inline]
    pub const fn brake_released(&self) -> bool {
        self.sequence.is_running() || self.sequence.brake_released()
    }

    /// Largest following error since the last reset, Q15.16 d.
    #[must_use]
    pub const fn following_error_peak(&self) -> i32 {
        self.watch.following.peak
    }

    /// Begins a new peak.
    pub const fn reset_following_error_peak(&mut self) {
        self.watch.following.peak = 0;
    }

    /// Takes a fault that was found between ticks, by homing for instance; it acts in the next tick.
    pub const fn report(&mut self, fault: Fault) {
        if self.reported.is_none() {
            self.reported = Some(fault);
        }
    }

    /// Says whether the parameter store is corrupt; while it is, the axis is not enabled.
    pub const fn set_store_corrupt(&mut self, corrupt: bool) {
        self.store_corrupt = corrupt;
    }
}
