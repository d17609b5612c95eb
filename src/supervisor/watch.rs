//! All monitors together.

use super::config::Config;
use super::fault::Fault;
use super::fault_set::FaultSet;
use super::monitor::following::{Following, Verdict};
use super::monitor::{
    against, disabled, encoder_loss, index, leaky, readback, saturation, speed, travel,
};
use super::record::Trip;
use super::{Review, Situation};
use crate::capture::Observation;

/// The monitors, and what they found in a tick.
#[derive(Clone, Debug, Default)]
pub(super) struct Watch {
    pub following: Following,
    pub readback: readback::Readback,
    against: against::Against,
    encoder_loss: encoder_loss::EncoderLoss,
    index: index::Index,
    overspeed: speed::Overspeed,
    saturation: saturation::Saturation,
    disabled: disabled::Disabled,
    illegal: leaky::Leaky,
    missed: leaky::Leaky,
    /// The first of this tick, in the order of [`Self::look`].
    found: Option<Trip>,
    warnings: FaultSet,
}

impl Watch {
    /// Looks at a tick in which the loop is closed.
    #[inline]
    pub fn look(&mut self, config: &Config, review: &Review<'_>) {
        let Review { observation, .. } = *review;
        let velocity = review.estimate.velocity.to_bits();
        let commanded = review.setpoint.velocity.to_bits();
        let told = review.told.to_bits();
        let count = observation.count;

        if review.open_loop {
            self.against = against::Against::default();
        } else if let Some(trip) =
            self.against
                .check(&config.against, told, observation.delta, velocity)
        {
            self.find(trip);
        }
        if let Some(trip) = self
            .encoder_loss
            .check(&config.encoder_loss, told, count as u32)
        {
            self.find(trip);
        }
        if let Some(latch) = observation.index()
            && let Some(trip) = self
                .index
                .note(&config.index, latch.count, observation.delta)
        {
            self.find(trip);
        }
        if let Some(trip) = self.index.check(&config.index, count) {
            self.find(trip);
        }
        if let Some(trip) = travel::check(review.lines, commanded, velocity, config.still) {
            self.find(trip);
        }
        if let Some(trip) = self.overspeed.check(config.overspeed, velocity) {
            self.find(trip);
        }
        if let Some(trip) = self.saturation.check(config.saturated_ticks, review.active) {
            self.find(trip);
        }
        let error = review.following_error;
        let verdict = self
            .following
            .check(&config.following, error, commanded, review.moving);
        match verdict {
            Verdict::Good => {}
            Verdict::Warning => self.warnings = self.warnings.with(Fault::FollowingError),
            Verdict::Fault(trip) => self.find(trip),
        }
    }

    /// Looks at a tick in which it is open.
    pub fn look_off(
        &mut self,
        config: &Config,
        observation: &Observation<'_>,
        is_off: bool,
    ) -> Option<Trip> {
        if is_off {
            self.disabled.check(&config.disabled, observation.count)
        } else {
            self.disabled.restart();
            None
        }
    }

    /// Counts what comes one by one; gives what is too many.
    pub fn count(&mut self, config: &Config, situation: &Situation<'_>) -> Option<Trip> {
        let Situation {
            tick,
            illegal,
            missed_ticks,
            ..
        } = *situation;
        let mut found = None;
        if missed_ticks != 0 && self.missed.add(&config.missed, missed_ticks.into(), tick) {
            let (level, limit) = (self.missed.level(), config.missed.limit);
            found = Some(Trip::counted(Fault::LateTick, level.into(), limit.into()));
        }
        if illegal != 0 && self.illegal.add(&config.illegal, illegal.into(), tick) {
            let (level, limit) = (self.illegal.level(), config.illegal.limit);
            found = Some(Trip::counted(
                Fault::IllegalTransitions,
                level.into(),
                limit.into(),
            ));
        }
        found
    }

    /// Starts anew what counts from the moment at which control begins.
    pub fn restart(&mut self, config: &Config, observation: &Observation<'_>) {
        self.following.restart();
        self.against = against::Against::default();
        self.encoder_loss = encoder_loss::EncoderLoss::default();
        self.overspeed = speed::Overspeed::default();
        self.saturation = saturation::Saturation::default();
        self.index.watch_from(observation.count);
        // An index passed without control is noted; what it shows does not count.
        if let Some(latch) = observation.index() {
            self.index
                .note(&config.index, latch.count, observation.delta);
        }
    }

    /// Forgets what a cleared fault came from.
    pub fn forget(&mut self) {
        self.index.restart();
        self.illegal = leaky::Leaky::default();
        self.missed = leaky::Leaky::default();
        self.readback = readback::Readback::default();
    }

    /// True if nothing was found.
    #[inline]
    pub const fn is_silent(&self) -> bool {
        self.found.is_none() && self.warnings.is_empty()
    }

    /// What was found in this tick.
    pub fn take(&mut self) -> (FaultSet, Option<Trip>) {
        let warnings = core::mem::take(&mut self.warnings);
        (warnings, self.found.take())
    }

    #[cold]
    #[inline(never)]
    fn find(&mut self, trip: Trip) {
        if self.found.is_none() {
            self.found = Some(trip);
        }
    }
}
