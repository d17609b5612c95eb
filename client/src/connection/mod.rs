//! A session with an axis: one request at a time, each answered or the axis lost.

mod control;
mod hello;
mod kept;
mod wait;

use std::time::Duration;

use leadscrew::protocol::client::{Answer, Client};
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;
use leadscrew::telemetry::Record;

use crate::error::{Error, Refused};
use crate::identity::Identity;
use crate::line::Line;
use crate::options::Options;
use control::Lease;
use kept::Kept;
pub use kept::Sample;

/// How many times longer an axis may take over what it computes or writes: gains of a commissioned observer take an STM32F4
/// some 5 s, an erasure 2 s.
const LONGER: u32 = 10;

/// A session with an axis.
///
/// Requests of any kind go through [`Self::query`] and [`Self::order`]; [`Axis`](crate::Axis) says the usual ones in
/// millimetres. A request that is not answered is sent again, the same bytes: the axis does it once.
///
/// The control lease is taken with the first order that needs it, and renewed in whatever waits. A connection that is
/// dropped gives it back if the axis stands, which leaves an enabled axis enabled; if it moves, the lease
/// lapses, and the axis makes a controlled stop and switches its drive off.
pub struct Connection {
    line: Box<dyn Line>,
    options: Options,
    client: Client,
    identity: Identity,
    nonce: u32,
    /// The line's clock.
    now: Duration,
    /// The latest tick that the axis told of.
    seen: u32,
    lease: Lease,
    is_stopping: bool,
    records: Kept<Record>,
    samples: Kept<Sample>,
    frame: Vec<u8>,
    received: Vec<u8>,
}

impl std::fmt::Debug for Connection {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Connection")
            .field("line", &self.line.name())
            .field("identity", &self.identity)
            .field("now", &self.now)
            .field("lease", &self.lease)
            .finish_non_exhaustive()
    }
}

/// What the axis says to a request.
enum Said<T> {
    Asked(T),
    Refused(u16),
    Other,
}

impl Connection {
    /// What the axis said of itself.
    #[must_use]
    pub const fn identity(&self) -> &Identity {
        &self.identity
    }

    /// The line's name.
    #[must_use]
    pub fn port(&self) -> String {
        self.line.name()
    }

    /// Time on the line's clock.
    #[must_use]
    pub const fn now(&self) -> Duration {
        self.now
    }

    /// The latest tick that the axis told of.
    #[must_use]
    pub const fn seen(&self) -> u32 {
        self.seen
    }

    /// How it talks.
    #[must_use]
    pub const fn options(&self) -> &Options {
        &self.options
    }

    /// Frames from the axis that were dropped here, by why.
    #[must_use]
    pub const fn dropped(&self) -> &leadscrew::protocol::decoder::Dropped {
        self.client.dropped()
    }

    /// Asks; `take` makes what is wanted of the reply that it expects, and `None` of any other one.
    ///
    /// # Errors
    /// [`Error::Lost`] and the others of a session that is over; [`Error::Refused`]; [`Error::Unexpected`] for a reply
    /// that `take` does not know.
    pub fn query<T>(
        &mut self,
        request: &Request<'_>,
        take: impl FnMut(&Reply<'_>) -> Option<T>,
    ) -> Result<T, Error> {
        self.renew_if_due()?;
        match self.transact(request, take)? {
            Said::Asked(answer) => Ok(answer),
            Said::Refused(number) => Err(self.refused(request, number)),
            Said::Other => Err(Error::Unexpected {
                asked: request.name().to_owned(),
            }),
        }
    }

    /// What a refusal means to the session.
    fn refused(&mut self, request: &Request<'_>, number: u16) -> Error {
        match Refusal::from_number(number) {
            Some(Refusal::NoSession) => Error::Restarted,
            Some(Refusal::OtherSession) => Error::SessionTaken,
            Some(Refusal::LeaseRequired) if self.lease.is_held() => {
                self.lease = Lease::Lapsed { is_told: false };
                Error::LeaseLapsed
            }
            _ => Error::Refused(Refused {
                asked: request.name().to_owned(),
                number,
                detail: String::new(),
            }),
        }
    }

    /// Sends a request, again and again, until it is answered.
    fn transact<T>(
        &mut self,
        request: &Request<'_>,
        mut take: impl FnMut(&Reply<'_>) -> Option<T>,
    ) -> Result<Said<T>, Error> {
        let asked = || request.name().to_owned();
        // A zero before it ends whatever the line invented since the last one.
        let mut frame = std::mem::take(&mut self.frame);
        frame.clear();
        frame.push(0);
        let made = self.client.request(request);
        frame.extend_from_slice(made.map_err(|_| Error::TooLong { asked: asked() })?);
        let begin = self.now;
        let patience = self.patience_for(request);
        let mut sent: Option<Duration> = None;
        let answer = loop {
            let is_due =
                sent.is_none_or(|sent| self.now.saturating_sub(sent) >= self.options.timing.repeat);
            if is_due {
                sent = Some(self.now);
            }
            let out: &[u8] = if is_due { &frame } else { &[] };
            match self.exchange(out, &mut take) {
                Ok(None) => {}
                Ok(Some(said)) => break Ok(said),
                Err(error) => break Err(error),
            }
            let after = self.now.saturating_sub(begin);
            if after >= patience {
                break Err(Error::Lost {
                    port: self.line.name(),
                    asked: asked(),
                    after,
                });
            }
        };
        self.frame = frame;
        answer
    }

    fn patience_for(&self, request: &Request<'_>) -> Duration {
        let lost = self.options.timing.lost;
        match request {
            Request::Hello { .. } => self.options.timing.greeting,
            request if request.takes_long() => lost.saturating_mul(LONGER),
            _ => lost,
        }
    }

    /// One exchange of the line; what is said to the last request, if it came.
    fn exchange<T>(
        &mut self,
        out: &[u8],
        take: &mut dyn FnMut(&Reply<'_>) -> Option<T>,
    ) -> Result<Option<Said<T>>, Error> {
        self.received.clear();
        let now = self.line.exchange(out, &mut self.received);
        let now = now.map_err(|source| Error::Line {
            port: self.line.name(),
            source,
        })?;
        self.now = self.now.max(now);
        let (seen, nonce) = (&mut self.seen, self.nonce);
        let (records, samples) = (&mut self.records, &mut self.samples);
        let sequence = self.client.sequence();
        let mut said = None;
        self.client.receive(&self.received, |answer| match answer {
            Answer::Record(record) => {
                note(seen, record.tick);
                records.keep(record);
            }
            Answer::Samples(frame) => frame.iter().for_each(|sample| {
                note(seen, sample.0);
                samples.keep(sample);
            }),
            // An answer to a hello of before, out of some buffer.
            Answer::Reply(_, Reply::Hello { nonce: of, .. }) if of != nonce => {}
            Answer::Reply(of, reply) => {
                if let Some(tick) = tick_of(&reply) {
                    note(seen, tick);
                }
                if of == sequence && said.is_none() {
                    said = Some(match reply {
                        Reply::Refused { reason, .. } => Said::Refused(reason),
                        _ => take(&reply).map_or(Said::Other, Said::Asked),
                    });
                }
            }
        });
        Ok(said)
    }

    /// The oldest record that came and that nobody has taken yet.
    pub fn take_record(&mut self) -> Option<Record> {
        self.records.take()
    }

    /// The same of samples of signals.
    pub fn take_sample(&mut self) -> Option<Sample> {
        self.samples.take()
    }

    /// Records of this session that were lost: on the line, or because nobody took them.
    #[must_use]
    pub const fn records_lost(&self) -> u32 {
        let lost = self.client.records_lost();
        lost.saturating_add(self.records.dropped())
    }

    /// Frames of samples that were lost on the line, and samples that nobody took.
    #[must_use]
    pub const fn samples_lost(&self) -> u32 {
        let lost = self.client.samples_lost();
        lost.saturating_add(self.samples.dropped())
    }
}

impl Drop for Connection {
    fn drop(&mut self) {
        // A tool that falls over says nothing more. Who listens no more cannot be told of an error. The lease lapses then.
        if !std::thread::panicking() {
            let _ = self.release_shortly();
        }
    }
}

/// Keeps the later of two ticks, which wrap.
const fn note(seen: &mut u32, tick: u32) {
    if tick.wrapping_sub(*seen).cast_signed() > 0 {
        *seen = tick;
    }
}

/// The tick that a reply tells of.
const fn tick_of(reply: &Reply<'_>) -> Option<u32> {
    match *reply {
        Reply::Ack { tick }
        | Reply::Refused { tick, .. }
        | Reply::Status { tick, .. }
        | Reply::Experiment { tick, .. } => Some(tick),
        _ => None,
    }
}
