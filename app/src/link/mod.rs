//! Thread mode's side of the link: the service with everything that a board has besides the axis.
//!
//! ```text
//!             bytes ─► Service ─► requests, configurations ─► (tick)
//!               ▲         │ │
//!               └─ frames ┘ └─ Bench: store, work memory, scope, experiments, learning
//!                                 ▲
//!  (tick) ─► Report, outcomes, faults, samples, captures, scopes that are over
//! ```
//!
//! Nothing here waits. A board calls [`Link::report`] for every report of a tick, in order, [`Link::poll`] when it has
//! none left, and [`Link::receive`] with whatever bytes came; frames go out through a closure, which says whether there
//! was room. Requests whose outcome the tick tells are answered then.

mod bench;
mod boot;
mod counters;
mod experiments;
mod learning;
mod memory;
mod panel;
mod scopes;
mod storage;

pub use boot::{Boot, Loaded};
pub use memory::{MAP_BYTES, MapPlaces, Maps, WORDS, WorkMemory};

use embedded_storage::nor_flash::NorFlash;
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::service::{Service, Ticket};

use crate::input_filter::InputsInForce;
use crate::report::Report;
use crate::safe_state::record::Record as ResetRecord;
use bench::Bench;

/// What passes a frame on; false where there was no room for it.
pub type Send<'s> = dyn FnMut(&[u8]) -> bool + 's;

/// The link of an axis.
pub struct Link<F: NorFlash> {
    service: Service,
    bench: Bench<F>,
    /// The last order of another line that was on its way, and what came of it.
    asked: Option<(Ticket, Option<Result<(), Refusal>>)>,
}

impl<F: NorFlash> Link<F> {
    /// Takes what a board found of the last reset; who asks for it is told.
    pub const fn set_reset(&mut self, reset: ResetRecord) {
        self.bench.reset = reset;
    }

    /// Takes what the board's inputs can follow: settings that they cannot are refused from now on, and no axis is enabled on such.
    pub const fn set_inputs(&mut self, inputs: InputsInForce) {
        self.bench.inputs = Some(inputs);
    }

    /// Takes the report of a tick.
    pub fn report(&mut self, report: &Report, send: &mut Send<'_>) {
        let Self { service, bench, .. } = self;
        if report.is_missed {
            // The next one tells by its count of missed ticks.
            return;
        }
        bench.take(report);
        bench.ends.beat(report.seen.tick);
        if let Some(frame) = service.record(&report.record)
            && !send(frame)
        {
            service.note_record_lost();
        }
        service.poll(&report.seen, bench);
    }

    /// Takes what else the tick has left.
    pub fn poll(&mut self, send: &mut Send<'_>) {
        let Self {
            service,
            bench,
            asked,
        } = self;
        bench.fetch();
        while let Some(outcome) = bench.ends.outcomes.dequeue() {
            bench.settled(outcome.ticket);
            if let Some((ticket, result)) = asked
                && *ticket == outcome.ticket
            {
                *result = Some(outcome.result);
            }
            // A reply that finds no room is asked for again.
            service.settle(outcome.ticket, outcome.result, &bench.seen, &mut |frame| {
                send(frame);
            });
        }
        bench.stream(&mut |body| {
            if !send(service.samples(body)) {
                service.note_record_lost();
            }
        });
    }

    /// Takes bytes that came, any number of them.
    pub fn receive(&mut self, bytes: &[u8], send: &mut Send<'_>) {
        let Self { service, bench, .. } = self;
        let seen = bench.seen;
        service.receive(bytes, &seen, bench, &mut |frame| {
            send(frame);
        });
        // Before anything can be asked in it: who asks knows its number by a frame that went out just now.
        bench.enter(service.session());
    }

    /// True once a restart was asked for, and acknowledged: when what was sent is out, start the firmware anew.
    pub const fn wants_restart(&self) -> bool {
        self.bench.wants_restart
    }

    /// Puts the axis out of control, whoever has it: for a board that cannot go on with it.
    pub fn disable(&mut self) {
        self.bench.disable();
    }
}
