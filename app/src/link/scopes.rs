//! The scope and the stream of samples.

use embedded_storage::nor_flash::NorFlash;
use leadscrew::calibration::Work;
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;
use leadscrew::protocol::service::Ticket;
use leadscrew::protocol::stream::Batch;
use leadscrew::scope::{
    MOST_INTERRUPTIONS, MOST_SIGNALS, Scope, ScopeError, Setup, Side, Signal, Signals, Slope,
    State, Stream, Trigger,
};
use leadscrew::supervisor::Fault;

use super::bench::{Bench, to_bytes};
use super::memory::Lent;
use crate::axis_control::What;

/// Longest that a sample waits for others to fill its frame, s.
const PATIENCE_S: f64 = 0.02;

/// What kind of trigger it is, for [`Request::ArmScope`].
fn trigger(number: u8, source: u8, level: i64) -> Result<Trigger, Refusal> {
    let signal = || Signal::from_number(source).ok_or(Refusal::UnknownSignal);
    let beyond = |side| {
        signal().map(|signal| Trigger::Level {
            signal,
            level,
            side,
        })
    };
    let through = |slope| {
        signal().map(|signal| Trigger::Edge {
            signal,
            level,
            slope,
        })
    };
    match number {
        0 => Ok(Trigger::Now),
        1 => Ok(Trigger::Force),
        2 => beyond(Side::Above),
        3 => beyond(Side::Below),
        4 => through(Slope::Rising),
        5 => through(Slope::Falling),
        6 => through(Slope::Either),
        7 if source == 0 => Ok(Trigger::Fault(None)),
        7 => Fault::from_number(source)
            .map(|fault| Trigger::Fault(Some(fault)))
            .ok_or(Refusal::WrongScope),
        8 => Ok(Trigger::Warning),
        9 => Ok(Trigger::Command),
        _ => Err(Refusal::WrongScope),
    }
}

fn refusal_of(error: ScopeError) -> Refusal {
    match error {
        ScopeError::NoSignal
        | ScopeError::TooManySignals { .. }
        | ScopeError::UnknownSignal { .. } => Refusal::UnknownSignal,
        ScopeError::NoDecimation
        | ScopeError::NoSamples
        | ScopeError::TooManySamples { .. }
        | ScopeError::PreTooLong { .. } => Refusal::WrongScope,
    }
}

impl<F: NorFlash> Bench<F> {
    #[inline(never)]
    pub fn arm_scope(&mut self, request: &Request<'_>) -> Result<(), Refusal> {
        let Request::ArmScope {
            signals,
            every,
            samples,
            before,
            trigger: number,
            source,
            level,
        } = *request
        else {
            return Err(Refusal::NotUnderstood);
        };
        let setup = Setup {
            signals: Signals::from_numbers(signals).map_err(refusal_of)?,
            every,
            trigger: trigger(number, source, level)?,
            pre: before,
            samples,
        };
        if self.is_recording {
            return Err(Refusal::WorkMemoryLent);
        }
        let Work { sums, mean } = self.lent.reclaim().ok_or(Refusal::WorkMemoryLent)?;
        match Scope::new(sums, &setup) {
            Ok(scope) => {
                self.lent = Lent::ScopeInTick(mean);
                // The tick has none, so there is room; it would come back otherwise.
                if let Err(scope) = self.ends.scopes.enqueue(scope) {
                    self.get_back(scope);
                }
                Ok(())
            }
            Err(refused) => {
                let sums = refused.memory;
                self.lent = Lent::Free(Work { sums, mean });
                Err(refusal_of(refused.error))
            }
        }
    }

    #[inline(never)]
    pub fn end_scope(&mut self) -> Result<(), Refusal> {
        if matches!(self.lent, Lent::ScopeInTick(_)) {
            return self.tell(What::EndScope);
        }
        Err(Refusal::ScopeNotReady)
    }

    /// Takes a scope that is over back from the tick.
    pub fn fetch_scope(&mut self) {
        if let Some(scope) = self.ends.scopes_back.dequeue() {
            self.get_back(scope);
        }
    }

    fn get_back(&mut self, scope: Scope<'static>) {
        if let Lent::ScopeInTick(mean) = core::mem::replace(&mut self.lent, Lent::Nobody) {
            self.lent = Lent::Scope(scope, mean);
        }
    }

    pub fn scope(&self, say: &mut dyn FnMut(&Reply<'_>)) {
        let mut bases = [0; MOST_SIGNALS];
        let mut interruptions = [None; MOST_INTERRUPTIONS];
        let mut numbers = [0; MOST_SIGNALS];
        let mut reply = (0, 1, 0, None, 0, false);
        let mut count = 0;
        match &self.lent {
            Lent::ScopeInTick(_) => reply.0 = 1 + u8::from(self.report.scope_triggered),
            Lent::Scope(scope, _) => {
                let setup = scope.setup();
                let signals = setup.signals.as_slice();
                count = signals.len();
                for (number, signal) in numbers.iter_mut().zip(signals) {
                    *number = *signal as u8;
                }
                if let Some(recording) = scope.recording() {
                    bases = recording.bases();
                    for (place, found) in interruptions.iter_mut().zip(recording.interruptions()) {
                        *place = Some(found);
                    }
                    let is_complete = matches!(scope.state(), State::Complete);
                    reply = (
                        if is_complete { 3 } else { 4 },
                        setup.every,
                        recording.len(),
                        recording.trigger_sample(),
                        recording.first_tick(),
                        recording.is_torn(),
                    );
                }
            }
            _ => {}
        }
        let (phase, every, samples, trigger, tick, is_torn) = reply;
        say(&Reply::Scope {
            phase,
            signals: numbers.get(..count).unwrap_or_default(),
            every,
            samples,
            trigger,
            tick,
            bases,
            interruptions,
            is_torn,
        });
    }

    #[inline(never)]
    pub fn read_scope(&self, index: u32, say: &mut dyn FnMut(&Reply<'_>)) -> Result<(), Refusal> {
        let Lent::Scope(scope, _) = &self.lent else {
            return Err(Refusal::ScopeNotReady);
        };
        let recording = scope.recording().ok_or(Refusal::ScopeNotReady)?;
        let width = scope.setup().signals.len().max(1);
        let whole = super::bench::MOST_BYTES / 4 / width;
        let samples = (index..).map_while(|index| recording.sample(index));
        let bytes = to_bytes(samples.take(whole).flatten());
        say(&Reply::Samples {
            index,
            bytes: &bytes,
        });
        Ok(())
    }

    #[inline(never)]
    pub fn begin_stream(&mut self, every: u16, numbers: &[u8]) -> Result<(), Refusal> {
        if every == 0 {
            self.batch = None;
            return self.tell(What::Stream(None));
        }
        let signals = Signals::from_numbers(numbers).map_err(refusal_of)?;
        let stream = Stream::new(signals, every).map_err(refusal_of)?;
        self.stream_ticket = Some(self.ask(What::Stream(Some(stream)))?);
        let patience = (self.tick_hz * PATIENCE_S) as u32;
        self.batch = Some(Batch::new(numbers.len(), every, patience));
        Ok(())
    }

    /// The tick took what has that ticket: samples of a stream before it are none of this one.
    pub fn settled(&mut self, ticket: Ticket) {
        if self.stream_ticket == Some(ticket) {
            self.stream_ticket = None;
            while self.ends.samples.dequeue().is_some() {}
        }
    }

    /// Ends the stream of a session that is not open any more.
    pub fn end_stream(&mut self) {
        if self.batch.is_some() && self.tell(What::Stream(None)).is_ok() {
            self.batch = None;
        }
    }

    /// Passes the samples that came on, frame by frame.
    pub fn stream(&mut self, send: &mut dyn FnMut(&[u8])) {
        while let Some(sample) = self.ends.samples.dequeue() {
            if let (Some(batch), None) = (&mut self.batch, self.stream_ticket) {
                batch.add(sample.tick, &sample.words, send);
            }
        }
    }
}
