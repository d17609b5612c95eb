//! What thread mode asks for.

use leadscrew::axis;
use leadscrew::encoder_map::EncoderMap;
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::service::Ticket;
use leadscrew::scope::Stream;

use super::AxisControl;
use crate::queues::{Outcome, Prepared, dequeue, enqueue};

/// What thread mode asks for, and when.
#[derive(Debug)]
pub struct Request {
    /// The tick that is to be the first to see it, counted from 0; one that has passed is the next.
    pub at: u32,
    /// Tells it from others, in its outcome.
    pub ticket: Ticket,
    /// What.
    pub what: What,
}

impl Request {
    /// One that the next tick is to see.
    #[must_use]
    pub const fn now(what: What) -> Self {
        Self {
            at: 0,
            ticket: 0,
            what,
        }
    }
}

/// What thread mode asks for.
#[derive(Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "a queue of them is a static, and there is no heap"
)]
pub enum What {
    /// Puts the axis under control, or takes it out.
    Enable(bool),
    /// A request to the axis.
    Axis(axis::Request),
    /// Takes a map of the encoder, or does without.
    SetMap(Option<EncoderMap<'static>>),
    /// The parameter store cannot be trusted, or can again.
    StoreCorrupt(bool),
    /// Hands captures to thread mode, or does not any more.
    Captures(bool),
    /// Gives samples of signals, or does not any more.
    Stream(Option<Stream>),
    /// Triggers the scope.
    TriggerScope,
    /// Ends the scope, which comes back.
    EndScope,
}

impl<B> AxisControl<B> {
    /// Takes what is due; the queues bound how much that can be.
    pub(super) fn take_requests(&mut self) {
        while self.ends.configs.ready() {
            self.take_config();
        }
        if let Some(scope) = dequeue(&mut self.ends.scopes) {
            self.scope = Some(scope);
        }
        while let Some(next) = self.ends.requests.peek()
            && next.at.wrapping_sub(self.tick).cast_signed() <= 0
        {
            let ticket = next.ticket;
            // In place until it is done: a plan is large.
            let result = match &next.what {
                What::Axis(request) => self.axis.take(request).map_err(Refusal::from),
                What::Enable(enable) => {
                    self.enable = *enable;
                    Ok(())
                }
                What::SetMap(map) => {
                    self.axis.set_map(*map);
                    Ok(())
                }
                What::StoreCorrupt(corrupt) => {
                    self.axis.supervisor_mut().set_store_corrupt(*corrupt);
                    Ok(())
                }
                What::Captures(is_open) => {
                    self.captures.open(*is_open);
                    Ok(())
                }
                What::Stream(stream) => {
                    self.stream.clone_from(stream);
                    Ok(())
                }
                What::TriggerScope => {
                    if let Some(scope) = &mut self.scope {
                        scope.trigger();
                    }
                    Ok(())
                }
                What::EndScope => {
                    if let Some(scope) = &mut self.scope {
                        scope.stop();
                    }
                    Ok(())
                }
            };
            let _ = dequeue(&mut self.ends.requests);
            self.answer(ticket, result);
        }
    }

    /// On a frame of its own, which other ticks do without.
    #[inline(never)]
    fn take_config(&mut self) {
        let Some((ticket, place)) = dequeue(&mut self.ends.configs) else {
            return;
        };
        if let Some(Prepared { config, gains }) = place.first() {
            let result = self.axis.reconfigure_with(config, gains);
            self.answer(ticket, result.map_err(Refusal::from));
        }
        // There is one place, so there is room.
        let _ = enqueue(&mut self.ends.configs_back, place);
    }

    fn answer(&mut self, ticket: Ticket, result: Result<(), Refusal>) {
        let outcome = Outcome { ticket, result };
        if enqueue(&mut self.ends.outcomes, outcome).is_err() {
            self.ends.note_lost_outcome(result);
        }
    }
}
