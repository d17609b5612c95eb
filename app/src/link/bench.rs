//! What the service passes on: to the tick what is the axis's, to the others what is theirs.

use embedded_storage::nor_flash::NorFlash;
use heapless::Vec;
use leadscrew::axis;
use leadscrew::capture::Unwrapper;
use leadscrew::params::AxisConfig;
use leadscrew::probe;
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;
use leadscrew::protocol::service::{Order, Passed, Port, Seen, Ticket};
use leadscrew::protocol::stream::Batch;
use leadscrew::settings::Settings;
use leadscrew::supervisor::FirstFault;
use leadscrew::units::AxisScale;

use super::learning::Learning;
use super::memory::{Lent, MapPlaces};
use crate::axis_control::{self, What};
use crate::captures::CaptureReceiver;
use crate::input_filter::InputsInForce;
use crate::modbus::ProbeLatch;
use crate::queues::LinkEnds;
use crate::report::Report;
use crate::safe_state::record::Record;
use crate::store::{Interlock, Store};
use crate::tick::Counters;

/// Everything besides the axis.
pub(super) struct Bench<F: NorFlash> {
    pub ends: LinkEnds,
    pub captures: CaptureReceiver,
    pub counters: &'static Counters,
    pub interlock: &'static Interlock,
    /// None if its flash cannot be used.
    pub store: Option<Store<F>>,
    pub lent: Lent,
    pub map_places: MapPlaces,
    pub learning: Learning,
    pub unwrapper: Unwrapper,
    /// The map in use.
    pub map: Option<&'static [u8]>,
    pub timer_hz: f64,
    pub tick_hz: f64,
    /// Counts and ticks of the configuration in force.
    pub scale: AxisScale,
    pub capabilities: u32,
    pub seen: Seen,
    pub report: Report,
    pub first_fault: Option<FirstFault>,
    /// What the probe came to.
    pub probe: probe::Report,
    /// The last touch of it, whatever came after.
    pub latch: Option<ProbeLatch>,
    /// A tick was lost on the way while an experiment was recorded.
    pub is_torn: bool,
    /// An experiment was ordered, and its first tick not seen yet; or it is being recorded.
    pub is_recording: bool,
    pub batch: Option<Batch>,
    /// The session that is open.
    pub session: u32,
    /// The stream is on its way to the tick.
    pub stream_ticket: Option<Ticket>,
    pub next_ticket: Ticket,
    pub wants_restart: bool,
    /// Why the firmware runs anew.
    pub reset: Record,
    /// What the board's inputs can follow; none of a board whose inputs follow everything.
    pub inputs: Option<InputsInForce>,
}

impl<F: NorFlash> Bench<F> {
    /// Takes the report of a tick.
    pub fn take(&mut self, report: &Report) {
        let expected = self.seen.tick.wrapping_add(1);
        let is_next = report.seen.tick == expected && report.missed == 0;
        self.is_torn |= self.is_recording && !is_next;
        self.seen = report.seen;
        self.report = *report;
        self.record_experiment(report);
        if report.seen.fault.is_none() {
            self.first_fault = None;
        }
    }

    /// Takes what else the tick has left.
    pub fn fetch(&mut self) {
        while let Some(fault) = self.ends.faults.dequeue() {
            self.first_fault = Some(fault);
        }
        while let Some(report) = self.ends.touches.dequeue() {
            self.latch = report
                .touch
                .map(|touch| self.latch_of(&report, &touch))
                .or(self.latch);
            self.probe = report;
        }
        self.fetch_scope();
        self.learn();
    }

    /// Another session begins without what the one before left behind: its stream, and an experiment that has ended on an
    /// axis that is off by now.
    pub fn enter(&mut self, session: u32) {
        if self.session == session {
            return;
        }
        self.session = session;
        self.end_stream();
        let experiment = self.report.experiment;
        let has_ended = experiment.is_some_and(|experiment| experiment.ending.is_some());
        if has_ended && !self.seen.enabled {
            // With a full queue the tool ends it itself.
            let _ = self.tell(What::Axis(axis::Request::ReleaseExperiment));
        }
    }

    /// Asks the tick for something of which no outcome is waited for.
    pub fn tell(&mut self, what: What) -> Result<(), Refusal> {
        self.ask(what).map(|_| ())
    }

    /// The same, with the ticket of its outcome.
    pub fn ask(&mut self, what: What) -> Result<Ticket, Refusal> {
        let ticket = self.next_ticket;
        let request = axis_control::Request {
            ticket,
            // In the past: the next tick is to see it.
            at: self.seen.tick,
            what,
        };
        let passed = self.ends.requests.enqueue(request);
        passed.map_err(|_| Refusal::QueueFull)?;
        self.next_ticket = self.next_ticket.wrapping_add(1);
        Ok(ticket)
    }

    pub fn disable(&mut self) {
        // With a full queue it is asked again: the lease lapses.
        let _ = self.tell(What::Enable(false));
    }
}

impl<F: NorFlash> Port for Bench<F> {
    fn order(&mut self, order: &Order) -> Result<Passed, Refusal> {
        let what = match order {
            Order::Enable(enable) => What::Enable(*enable),
            Order::Axis(request) => What::Axis(*request),
        };
        self.ask(what).map(Passed::OnItsWay)
    }

    fn reconfigure(&mut self, config: &AxisConfig) -> Result<Passed, Refusal> {
        let ticket = self.next_ticket;
        self.ends.configure(ticket, config)?;
        self.scale = config.scale;
        self.next_ticket = self.next_ticket.wrapping_add(1);
        Ok(Passed::OnItsWay(ticket))
    }

    fn check(&self, settings: &Settings) -> Result<(), Refusal> {
        match &self.inputs {
            Some(inputs) => inputs.check(settings),
            None => Ok(()),
        }
    }

    fn serve(
        &mut self,
        request: &Request<'_>,
        settings: &Settings,
        say: &mut dyn FnMut(&Reply<'_>),
    ) -> Result<(), Refusal> {
        match *request {
            Request::FaultPage {} => say(&self.fault_page()),
            Request::Counters {} => say(&self.counts()),
            Request::Touch {} => say(&self.touch()),
            Request::LastReset {} => say(&self.last_reset()),
            Request::Restart {} => self.wants_restart = true,
            Request::SaveParameters {} => self.save_parameters(settings)?,
            Request::Stored { kind } => say(&self.stored(kind)?),
            Request::ReadStored { kind, offset } => self.read_stored(kind, offset, say)?,
            Request::WriteBytes { offset, bytes } => self.write_bytes(offset, bytes)?,
            Request::SaveBytes { kind, length, crc } => self.save_bytes(kind, length, crc)?,
            Request::Erase { kind } => self.erase(kind)?,
            Request::StartExperiment { record_ticks } => self.begin_record(record_ticks)?,
            Request::Experiment {} => say(&self.experiment()),
            Request::ReadWork { offset } => self.read_work(offset, say)?,
            Request::ArmScope { .. } => self.arm_scope(request)?,
            Request::TriggerScope {} => self.tell(What::TriggerScope)?,
            Request::EndScope {} => self.end_scope()?,
            Request::Scope {} => self.scope(say),
            Request::ReadScope { index } => self.read_scope(index, say)?,
            Request::Stream { every, signals } => self.begin_stream(every, signals)?,
            Request::Learn { edges } => self.begin_learning(edges)?,
            Request::LearnRun { revolutions } => self.begin_run(revolutions)?,
            Request::EndRun {} => self.end_run()?,
            Request::Learning {} => say(&self.learning_reply()),
            Request::FinishLearning {} => self.finish_learning()?,
            Request::Learned {} => say(&self.learned()?),
            Request::TakeMap {} => self.take_map()?,
            Request::SaveMap {} => self.save_map()?,
            Request::EndLearning {} => self.end_learning()?,
            _ => return Err(Refusal::NotSupported),
        }
        Ok(())
    }
}

/// Words as bytes, the low one first, as many as a reply holds.
pub(super) fn to_bytes<'w>(words: impl Iterator<Item = &'w i32>) -> Vec<u8, MOST_BYTES> {
    let mut bytes = Vec::new();
    for word in words.take(MOST_BYTES / 4) {
        // There is room for that many.
        let _ = bytes.extend_from_slice(&word.to_le_bytes());
    }
    bytes
}

/// Bytes of a reply that is full of them.
pub(super) const MOST_BYTES: usize = 224;
