//! Any bytes into a link, against a reading of them that shares nothing with the decoder. For the tests and for the fuzzer.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::params::AxisConfig;
use leadscrew::protocol::decoder::Decoder;
use leadscrew::protocol::frame::{Channel, FrameBuffer, Header, MAX_BODY, MAX_CONTENT};
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::CAN_SET;
use leadscrew::protocol::service::{Identity, Order, Passed, Port, Seen, Service};
use leadscrew::settings::Settings;
use leadscrew::supervisor::State;

/// CRC-32 as of zip, bit by bit.
pub fn crc32(bytes: &[u8]) -> u32 {
    let mut sum = u32::MAX;
    for byte in bytes {
        sum ^= u32::from(*byte);
        for _ in 0..8 {
            sum = (sum >> 1) ^ (0xedb8_8320 * (sum & 1));
        }
    }
    !sum
}

/// The content of a stuffed stretch without zeros, by the book.
fn unstuffed(stretch: &[u8]) -> Option<Vec<u8>> {
    let mut content = Vec::new();
    let mut rest = stretch;
    while let Some((&code, behind)) = rest.split_first() {
        let run = usize::from(code) - 1;
        content.extend_from_slice(behind.get(..run)?);
        rest = &behind[run..];
        if code != 255 && !rest.is_empty() {
            content.push(0);
        }
    }
    Some(content)
}

/// Contents of all good frames: header and body.
pub fn good_frames(bytes: &[u8]) -> Vec<Vec<u8>> {
    let ended = bytes.iter().rposition(|byte| *byte == 0).unwrap_or(0);
    let stretches = bytes[..ended].split(|byte| *byte == 0);
    let good = |stretch: &[u8]| {
        let mut content = unstuffed(stretch)?;
        let covered = content
            .len()
            .checked_sub(4)
            .filter(|covered| *covered >= 7)?;
        let sum = content.split_off(covered);
        let is_good = content.len() + 4 <= MAX_CONTENT
            && sum == crc32(&content).to_le_bytes()
            && (1..=4).contains(&content[0]);
        is_good.then_some(content)
    };
    stretches.filter_map(good).collect()
}

/// An axis that takes everything and counts what could move it.
#[derive(Default)]
struct Willing {
    orders: usize,
}

impl Port for Willing {
    fn order(&mut self, order: &Order) -> Result<Passed, Refusal> {
        self.orders += usize::from(*order != Order::Enable(false));
        Ok(Passed::Taken)
    }

    fn reconfigure(&mut self, _: &AxisConfig) -> Result<Passed, Refusal> {
        self.orders += 1;
        Ok(Passed::Taken)
    }
}

/// Fails if the decoder finds other frames than a reading by the book, or the service asks for more than was asked of it.
/// Gives what it asked for that could move the axis.
pub fn check(bytes: &[u8]) -> usize {
    let expected = good_frames(bytes);
    let mut decoder: Decoder = Decoder::new();
    let mut found = Vec::new();
    decoder.feed_all(bytes, |frame, _| {
        let mut content = vec![frame.header.channel as u8];
        content.extend_from_slice(&frame.header.session.to_le_bytes());
        content.extend_from_slice(&frame.header.sequence.to_le_bytes());
        content.extend_from_slice(frame.body);
        found.push(content);
    });
    assert_eq!(found, expected);

    let estimator = EstimatorConfig::by_name("simple").unwrap().unwrap();
    let identity = Identity {
        firmware: "",
        build: "",
        board: "",
        capabilities: CAN_SET,
        work_memory: 0,
        lead_ticks: 4,
    };
    let mut settings = Settings::new(estimator);
    let config = settings.validate().unwrap();
    let mut service = Service::new(identity, &settings, &config);
    let mut axis = Willing::default();
    let mut answers = 0;
    for (tick, part) in (0..).zip(bytes.chunks(50)) {
        let seen = Seen {
            tick,
            // Now on, now off, so that either kind of request may be taken.
            state: if tick % 4 == 3 {
                State::Disabled
            } else {
                State::Ready
            },
            enabled: tick % 4 != 3,
            is_planned: tick % 4 != 3,
            ..Seen::default()
        };
        service.receive(part, &seen, &mut axis, &mut |frame| {
            assert_eq!(good_frames(frame).len(), 1, "an answer is a good frame");
            answers += 1;
        });
    }
    let requests = expected.iter().filter(|content| content[0] == 1).count();
    assert_eq!(answers, requests);
    // A stop may be carried out later, once.
    assert!(axis.orders <= requests, "{} of {requests}", axis.orders);
    axis.orders
}

/// The same with bodies, each after its length, in good frames of a session: what a checksum keeps a fuzzer from.
pub fn check_bodies(bytes: &[u8]) -> usize {
    let mut sequence = 0;
    let mut line = framed(0, sequence, &[0, 1, 1]);
    let mut rest = bytes;
    while let Some((&length, behind)) = rest.split_first() {
        let (body, behind) = behind.split_at(behind.len().min(usize::from(length)));
        // Some come again.
        sequence += u16::from(length & 0x80 == 0);
        line.extend(framed(0x1_0000, sequence, body));
        rest = behind;
    }
    check(&line)
}

fn framed(session: u32, sequence: u16, body: &[u8]) -> Vec<u8> {
    let header = Header {
        channel: Channel::Request,
        session,
        sequence,
    };
    let body = &body[..body.len().min(MAX_BODY)];
    FrameBuffer::default().raw(header, body).unwrap().to_vec()
}
