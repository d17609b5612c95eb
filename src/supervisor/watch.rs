//! All monitors together.

use super::Review;
use super::config::Config;
use super::fault::Fault;
use super::io::Judged;
use super::monitor::following::{Following, Verdict};
use super::monitor::{
    against, disabled, encoder_loss, index, leaky, readback, saturation, speed, travel,
};
use super::record::Trip;
use crate::capture::Observation;

/// The monitors.
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
    /// A monitor is in the middle of a run.
    busy: bool,
}

/// What was found in a tick.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// The following error is above its warning level.
    pub is_warning: bool,
    /// The first fault, in the order of [`Watch::look`].
    pub trip: Option<Trip>,
}

impl Watch {
    /// Looks at a tick in which the loop is closed; true if there is nothing to be said about it.
    ///
    /// Most ticks need no more than this: a few comparisons, and none of the monitors in the middle of a run.
    #[inline(always)]
    pub fn is_quiet(&mut self, config: &Config, review: &Review<'_>) -> bool {
        let Review {
            observation,
            lines,
            active,
            ..
        } = *review;
        let velocity = review.estimate.velocity.to_bits();
        let told = review.told.to_bits();
        let delta = observation.delta;
        let is_at_rest = !review.moving && review.setpoint.velocity.to_bits() == 0;
        let error = review.following_error;
        let loss = &config.encoder_loss;
        // One after the other: a comparison and a jump each.
        self.following
            .is_quiet(&config.following, error, is_at_rest, review.tick)
            && (delta == 0 || delta ^ told >= 0)
            && (delta.unsigned_abs() >= loss.counts
                || told.unsigned_abs() <= loss.level.cast_unsigned())
            && velocity.unsigned_abs() <= config.overspeed.cast_unsigned()
            && self.index.way(observation.count).unsigned_abs() <= config.index.within
            && !(self.busy | lines.is_at_limit() | active.is_limited())
            && !observation.has_index()
    }

    /// Looks at it in full.
    pub fn look(&mut self, config: &Config, review: &Judged<'_>) -> Found {
        let Judged {
            observation,
            velocity,
            commanded,
            told,
            ..
        } = *review;
        let (count, delta) = (observation.count, observation.delta);
        let index = observation.index();
        let error = review.following_error;
        let verdict = self
            .following
            .judge(&config.following, error, commanded, review.tick);
        let against = if review.open_loop {
            self.against = against::Against::default();
            None
        } else {
            self.against.check(&config.against, told, delta, velocity)
        };
        let found = [
            against,
            self.encoder_loss
                .check(&config.encoder_loss, told, count as u32, delta),
            index.and_then(|latch| self.index.note(&config.index, latch.count, delta)),
            self.index.check(&config.index, count),
            travel::check(review.lines, commanded, velocity, config.still),
            self.overspeed.check(config.overspeed, velocity),
            self.saturation.check(config.saturated_ticks, review.active),
            match verdict {
                Verdict::Fault(trip) => Some(trip),
                Verdict::Good | Verdict::Warning => None,
            },
        ];
        self.busy = self.against.is_busy()
            || self.encoder_loss.is_busy()
            || self.overspeed.is_busy()
            || self.saturation.is_busy();
        Found {
            is_warning: verdict == Verdict::Warning,
            trip: found.into_iter().flatten().next(),
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

    /// Counts what comes one by one, illegal transitions and missed ticks; gives what is too many.
    pub fn count(
        &mut self,
        config: &Config,
        tick: u32,
        [illegal, missed_ticks]: [u16; 2],
    ) -> Option<Trip> {
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
    pub fn restart(&mut self, config: &Config, observation: &Observation<'_>, tick: u32) {
        self.following.restart(tick);
        self.busy = false;
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
}
