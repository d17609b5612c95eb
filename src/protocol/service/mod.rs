//! The axis's side of the link: takes requests, asks the axis, answers; and stops it when its lease lapses.
//!
//! It runs outside the tick, in any thread that sees the axis's state: [`Service::poll`] at least once a tick or as
//! often as the thread may, [`Service::receive`] with whatever bytes came. What it asks goes through a [`Port`], what it
//! answers through a closure that takes bytes.

mod answer;
mod motion;
mod port;
mod settings;
mod watch;

pub use port::{Order, Passed, Port, Seen, Ticket};

use super::decoder::{Decoder, Dropped};
use super::experiment::Draft;
use super::frame::{Channel, Frame, FrameBuffer, Header};
use super::lease::Lease;
use super::refusal::Refusal;
use super::reply::Reply;
use super::request::Request;
use super::session::{Arrival, Session};
use crate::params::AxisConfig;
use crate::settings::Settings;
use crate::telemetry::Record;
use motion::Mover;
use watch::Watch;

/// What an axis says of itself in its hello.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identity {
    /// Version of the firmware.
    pub firmware: &'static str,
    /// What it was built from.
    pub build: &'static str,
    /// What it runs on.
    pub board: &'static str,
    /// Bits of [`reply`](super::reply): what it can do.
    pub capabilities: u32,
    /// Room for what is recorded, bytes.
    pub work_memory: u32,
    /// Ticks from an order to the start of its plan, 1 or more: as many as planning and the way to the tick take.
    pub lead_ticks: u32,
}

/// What came of a request that does something: for when it comes again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Done {
    Nothing,
    /// It waits for the axis.
    Waits(Header, Ticket),
    Outcome(Result<(), Refusal>),
}

/// The service of a link.
#[derive(Debug)]
pub struct Service {
    decoder: Decoder,
    inner: Inner,
}

/// All but the decoder, whose frames are looked at meanwhile.
#[derive(Debug)]
struct Inner {
    identity: Identity,
    tick_hz: u32,
    settings: Settings,
    /// They are others than those that were saved, or that the axis was switched on with.
    is_unsaved: bool,
    /// The copy of an edit.
    edit: Option<Settings>,
    /// Control rate and edge timer that the axis was switched on with, Hz.
    rates: [f64; 2],
    /// The program of an experiment, as far as it was told.
    draft: Draft,
    session: Session,
    lease: Lease,
    watch: Watch,
    mover: Mover,
    last_done: Done,
    /// A record in so many ticks; 0 for none.
    every: u16,
    until_record: u16,
    next_record: u16,
    next_samples: u16,
    records_lost: u32,
    buffer: FrameBuffer,
}

impl Service {
    /// The service of an axis with `settings`, and the configuration that was made of them.
    #[must_use]
    pub fn new(identity: Identity, settings: &Settings, config: &AxisConfig) -> Self {
        let params = &settings.axis;
        let tick_hz = libm::round(params.tick_hz) as u32;
        let feed = params.motion.max_feed_mm_per_min;
        let rates = [params.tick_hz, params.timer_hz];
        Self {
            decoder: Decoder::new(),
            inner: Inner {
                identity,
                tick_hz,
                settings: *settings,
                is_unsaved: false,
                edit: None,
                rates,
                draft: Draft::default(),
                session: Session::default(),
                lease: Lease::new(tick_hz),
                watch: Watch::default(),
                mover: Mover::new(config, feed, identity.lead_ticks.max(1)),
                last_done: Done::Nothing,
                every: 0,
                until_record: 0,
                next_record: 0,
                next_samples: 0,
                records_lost: 0,
                buffer: FrameBuffer::default(),
            },
        }
    }

    /// What was dropped of what came.
    #[must_use]
    pub const fn dropped(&self) -> &Dropped {
        self.decoder.dropped()
    }

    /// The session that holds the control lease.
    #[must_use]
    pub fn holder(&self) -> Option<u32> {
        self.inner.lease.holder()
    }

    /// Looks at the axis: a lease that has lapsed disables it, which stops it in its own loop.
    pub fn poll(&mut self, seen: &Seen, port: &mut dyn Port) {
        self.inner.poll(seen, port);
    }

    /// Feed override, %.
    #[must_use]
    pub const fn percent(&self) -> u16 {
        self.inner.mover.percent()
    }

    /// True while a feed hold is on.
    #[must_use]
    pub const fn is_held(&self) -> bool {
        self.inner.mover.is_held()
    }

    /// Puts all settings into force, or none, for another line than this one. What is on its way is told to
    /// [`Self::settle`], which has nobody to answer then.
    ///
    /// # Errors
    /// As of [`Request::SetParameter`]; nothing is changed then.
    pub fn set_all(
        &mut self,
        settings: Settings,
        seen: &Seen,
        port: &mut dyn Port,
    ) -> Result<Passed, Refusal> {
        self.inner.set_all(settings, seen, port)
    }

    /// The settings in force.
    #[must_use]
    pub const fn settings(&self) -> &Settings {
        &self.inner.settings
    }

    /// What came of an order that was on its way. The request that it was for is answered by a frame to `send`.
    pub fn settle(
        &mut self,
        ticket: Ticket,
        outcome: Result<(), Refusal>,
        seen: &Seen,
        send: &mut dyn FnMut(&[u8]),
    ) {
        let inner = &mut self.inner;
        inner.mover.settle(ticket, outcome);
        if let Done::Waits(header, waits) = inner.last_done
            && waits == ticket
        {
            inner.last_done = Done::Outcome(outcome);
            inner.answer(header, &Inner::reply(seen, outcome));
            send(inner.buffer.bytes());
        }
    }

    /// Takes bytes that came, any number of them. Each request among them is answered by a frame to `send`.
    pub fn receive(
        &mut self,
        bytes: &[u8],
        seen: &Seen,
        port: &mut dyn Port,
        send: &mut dyn FnMut(&[u8]),
    ) {
        let inner = &mut self.inner;
        inner.poll(seen, port);
        self.decoder.feed_all(bytes, |frame, dropped| {
            inner.take(frame, dropped, seen, port);
            if !inner.buffer.bytes().is_empty() {
                send(inner.buffer.bytes());
            }
        });
    }

    /// The frame of the record of a tick, if it is one that was subscribed to.
    pub fn record(&mut self, record: &Record) -> Option<&[u8]> {
        self.inner.record(record)
    }

    /// The frame of a body of samples.
    pub fn samples(&mut self, body: &[u8]) -> &[u8] {
        self.inner.samples(body)
    }

    /// The session that is open; 0 for none.
    #[must_use]
    pub const fn session(&self) -> u32 {
        self.inner.session.number()
    }

    /// The frame of the last record, or of samples, found no room on its way out.
    pub const fn note_record_lost(&mut self) {
        self.inner.records_lost = self.inner.records_lost.saturating_add(1);
    }
}

impl Inner {
    fn poll(&mut self, seen: &Seen, port: &mut dyn Port) {
        self.mover.look(seen, port);
        let may_move = self.may_move(seen);
        let must_disable = self.watch.look(&mut self.lease, seen.tick, may_move);
        // Asked again until there is a way on.
        if must_disable && port.order(&Order::Enable(false)).is_ok() {
            self.watch.note_disabled();
        }
    }

    /// Takes a frame; the answer, if it has one, is left in the buffer.
    fn take(&mut self, frame: &Frame<'_>, dropped: &mut Dropped, seen: &Seen, port: &mut dyn Port) {
        self.buffer.clear();
        self.watch.note_heard(&mut self.lease, seen.tick);
        let Header {
            channel, session, ..
        } = frame.header;
        if channel != Channel::Request {
            // Our own words, from a line that is connected to itself.
            dropped.count_unknown();
            return;
        }
        let request = frame.message::<Request<'_>>();
        let header = Header {
            channel: Channel::Reply,
            ..frame.header
        };
        if let Some(Request::Hello { nonce, .. }) = request {
            let Some(is_new) = self.session.open(nonce, frame.header.sequence, seen.tick) else {
                dropped.count_late();
                return self.answer(header, &Self::reply(seen, Err(Refusal::Late)));
            };
            if is_new {
                self.begin_session();
            }
            return self.answer(header, &self.hello(seen, nonce));
        }
        let outcome = match self.session.arrive(session, frame.header.sequence) {
            Arrival::NoSession => Err(Refusal::NoSession),
            Arrival::OtherSession => Err(Refusal::OtherSession),
            Arrival::Late => {
                dropped.count_late();
                Err(Refusal::Late)
            }
            Arrival::Repeated => {
                dropped.count_late();
                match (self.last_done, request) {
                    (Done::Outcome(outcome), _) => outcome,
                    // Its answer is still to come.
                    (Done::Waits(..), _) => return,
                    (Done::Nothing, Some(request)) if request.is_query() => {
                        return self.query(header, &request, dropped, seen, port);
                    }
                    _ => Err(Refusal::Late),
                }
            }
            Arrival::Fresh => match request {
                Some(request) if request.is_query() => {
                    self.last_done = Done::Nothing;
                    return self.query(header, &request, dropped, seen, port);
                }
                Some(request) => match self.worked(&request, seen, port) {
                    Ok(Passed::OnItsWay(ticket)) => {
                        self.last_done = Done::Waits(header, ticket);
                        return;
                    }
                    done => self.remember(done.map(|_| ())),
                },
                None => {
                    dropped.count_unknown();
                    self.remember(Err(Refusal::NotUnderstood))
                }
            },
        };
        self.answer(header, &Self::reply(seen, outcome));
    }

    /// Carries it out.
    fn worked(
        &mut self,
        request: &Request<'_>,
        seen: &Seen,
        port: &mut dyn Port,
    ) -> Result<Passed, Refusal> {
        let done = self.carry_out(request, seen, port);
        let is_excused = request.takes_long() && !self.may_move(seen);
        self.watch.note_worked(seen.tick, is_excused);
        done
    }

    fn begin_session(&mut self) {
        self.last_done = Done::Nothing;
        self.every = 0;
        self.next_record = 0;
        self.next_samples = 0;
        self.edit = None;
    }

    fn record(&mut self, record: &Record) -> Option<&[u8]> {
        if self.every == 0 {
            return None;
        }
        self.until_record = self.until_record.saturating_sub(1);
        if self.until_record != 0 {
            return None;
        }
        self.until_record = self.every;
        let header = Header {
            channel: Channel::Telemetry,
            session: self.session.number(),
            sequence: self.next_record,
        };
        self.next_record = self.next_record.wrapping_add(1);
        self.buffer.raw(header, &record.to_bytes()).ok()
    }

    fn samples(&mut self, body: &[u8]) -> &[u8] {
        let header = Header {
            channel: Channel::Samples,
            session: self.session.number(),
            sequence: self.next_samples,
        };
        self.next_samples = self.next_samples.wrapping_add(1);
        self.buffer.raw(header, body).unwrap_or_default()
    }

    fn answer(&mut self, header: Header, reply: &Reply<'_>) {
        // Every reply fits: a test makes the largest one.
        let _ = self.buffer.message(header, reply);
    }
}
