//! The tool's side of the link: numbers its requests, and knows what answers them.

use super::decoder::{Decoder, Dropped};
use super::frame::{Channel, Frame, FrameBuffer, Header, TooLarge};
use super::record::{Gaps, record_from_bytes};
use super::reply::Reply;
use super::request::Request;
use super::stream::Samples;
use crate::telemetry::Record;

/// What came from the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer<'a> {
    /// The reply to the request of that sequence.
    Reply(u16, Reply<'a>),
    /// The record of a tick.
    Record(Record),
    /// Samples of signals.
    Samples(Samples<'a>),
}

/// The client of a link.
#[derive(Debug, Default)]
pub struct Client {
    decoder: Decoder,
    inner: Inner,
    buffer: FrameBuffer,
}

#[derive(Debug, Default)]
struct Inner {
    session: u32,
    sequence: u16,
    nonce: u32,
    gaps: Gaps,
    sample_gaps: Gaps,
}

impl Client {
    /// A client before its hello.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The frame of a request with the next sequence, which [`Self::sequence`] then tells. To repeat one whose answer
    /// was lost, send the same bytes again: it is done once.
    ///
    /// # Errors
    /// [`TooLarge`] for one with too long a text.
    pub fn request(&mut self, request: &Request<'_>) -> Result<&[u8], TooLarge> {
        let inner = &mut self.inner;
        if let Request::Hello { nonce, .. } = *request {
            inner.nonce = nonce;
            inner.session = 0;
        }
        inner.sequence = inner.sequence.wrapping_add(1);
        let header = Header {
            channel: Channel::Request,
            session: inner.session,
            sequence: inner.sequence,
        };
        self.buffer.message(header, request)
    }

    /// The sequence of the last request.
    #[must_use]
    pub const fn sequence(&self) -> u16 {
        self.inner.sequence
    }

    /// The session; 0 before the axis has answered a hello.
    #[must_use]
    pub const fn session(&self) -> u32 {
        self.inner.session
    }

    /// Takes bytes that came, any number of them, and gives each answer among them to `take`.
    pub fn receive(&mut self, bytes: &[u8], mut take: impl FnMut(Answer<'_>)) {
        let inner = &mut self.inner;
        self.decoder.feed_all(bytes, |frame, dropped| {
            if let Some(answer) = inner.answer(frame, dropped) {
                take(answer);
            }
        });
    }

    /// What was dropped of what came.
    #[must_use]
    pub const fn dropped(&self) -> &Dropped {
        self.decoder.dropped()
    }

    /// Records of this session that did not arrive.
    #[must_use]
    pub const fn records_lost(&self) -> u32 {
        self.inner.gaps.lost()
    }

    /// Frames of samples of this session that did not arrive.
    #[must_use]
    pub const fn samples_lost(&self) -> u32 {
        self.inner.sample_gaps.lost()
    }
}

impl Inner {
    /// Takes what comes in a sequence of its own; false for what comes late.
    const fn is_in_turn(&mut self, answer: &Answer<'_>, sequence: u16) -> bool {
        match answer {
            Answer::Reply(..) => true,
            Answer::Record(_) => self.gaps.take(sequence),
            Answer::Samples(_) => self.sample_gaps.take(sequence),
        }
    }

    fn answer<'f>(&mut self, frame: &Frame<'f>, dropped: &mut Dropped) -> Option<Answer<'f>> {
        let Header {
            channel,
            session,
            sequence,
        } = frame.header;
        if session != self.session {
            dropped.count_late();
            return None;
        }
        let answer = match channel {
            Channel::Request => None,
            Channel::Reply => frame.message().map(|reply| Answer::Reply(sequence, reply)),
            Channel::Telemetry => record_from_bytes(frame.body).map(Answer::Record),
            Channel::Samples => Samples::of(frame.body).map(Answer::Samples),
        };
        match answer {
            None => dropped.count_unknown(),
            Some(other) if !self.is_in_turn(&other, sequence) => {
                dropped.count_late();
                return None;
            }
            Some(Answer::Reply(_, Reply::Hello { nonce, session, .. })) if nonce == self.nonce => {
                self.session = session;
                self.gaps = Gaps::default();
                self.sample_gaps = Gaps::default();
            }
            Some(_) => {}
        }
        answer
    }
}
