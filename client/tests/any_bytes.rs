//! A tool at a line on which anything may come.

mod support;

use std::io;
use std::time::Duration;

use leadscrew::protocol::VERSION;
use leadscrew::protocol::decoder::Decoder;
use leadscrew::protocol::frame::{Channel, FrameBuffer, Header};
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;
use leadscrew_client::{Axis, Error, Kind, Line, Options, Timing};
use proptest::prelude::*;
use support::seeded::seeded;

/// Exchanges after which the line breaks: whatever an axis says, nobody waits for ever.
const EXCHANGES: u32 = 100_000;

/// Says what it is told to, over and over, whatever it is asked.
struct Babble {
    said: Vec<Vec<u8>>,
    exchanges: u32,
}

impl Line for Babble {
    fn exchange(&mut self, _: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        let said = self
            .said
            .get(self.exchanges as usize % self.said.len().max(1));
        received.extend_from_slice(said.map_or(&[], Vec::as_slice));
        self.exchanges += 1;
        Ok(Duration::from_millis(5) * self.exchanges)
    }

    fn name(&self) -> String {
        "babble".to_owned()
    }
}

/// An axis that opens a session as it should, and answers everything else as it likes.
struct Liar {
    replies: Vec<Reply<'static>>,
    next: usize,
    exchanges: u32,
    protocol: u16,
    decoder: Decoder,
}

impl Liar {
    fn new(replies: Vec<Reply<'static>>) -> Self {
        Self {
            replies,
            next: 0,
            exchanges: 0,
            protocol: VERSION,
            decoder: Decoder::new(),
        }
    }
}

impl Line for Liar {
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        self.exchanges += 1;
        if self.exchanges > EXCHANGES {
            return Err(io::Error::other("worn out"));
        }
        let Self {
            replies,
            next,
            protocol,
            ..
        } = self;
        self.decoder.feed_all(out, |frame, _| {
            let reply = match frame.message() {
                Some(Request::Hello { nonce, .. }) => Reply::Hello {
                    protocol: *protocol,
                    nonce,
                    session: 77,
                    tick_hz: u32::MAX,
                    lease_ticks: 0,
                    tick: u32::MAX,
                    capabilities: 0,
                    work_memory: 0,
                    firmware: "9.9.9",
                    build: "",
                    board: "liar",
                },
                _ if replies.is_empty() => return,
                _ => {
                    *next += 1;
                    replies[*next % replies.len()]
                }
            };
            let header = Header {
                channel: Channel::Reply,
                ..frame.header
            };
            let mut buffer = FrameBuffer::default();
            received.extend_from_slice(buffer.message(header, &reply).unwrap());
        });
        Ok(Duration::from_millis(5) * self.exchanges)
    }

    fn name(&self) -> String {
        "liar".to_owned()
    }
}

fn reply() -> impl Strategy<Value = Reply<'static>> {
    let number = prop_oneof![Just(f64::NAN), Just(f64::INFINITY), any::<f64>()];
    let status = any::<(u32, u8, u8, u32, u16, i64, i64, i32)>();
    prop_oneof![
        2 => any::<u32>().prop_map(|tick| Reply::Ack { tick }),
        1 => (any::<u32>(), 0..60_u16).prop_map(|(tick, reason)| Reply::Refused { tick, reason }),
        3 => status.prop_map(|(tick, state, fault, warnings, flags, at, to, v)| Reply::Status {
            tick,
            state: state % 8,
            fault,
            warnings,
            flags,
            percent: flags,
            position_nm: at,
            setpoint_nm: to,
            velocity_um_per_min: v,
            following_error_nm: v,
        }),
        1 => (any::<u16>(), any::<u16>(), number).prop_map(|(index, count, value)| Reply::Parameter {
            index,
            count: count % 300,
            section: "motion",
            name: "µ",
            unit: "",
            value,
            min: value,
            max: -value,
            default: value,
        }),
        1 => any::<u8>().prop_map(|at| Reply::Word {
            index: 0,
            count: 0,
            section: "",
            name: "",
            word: "",
            at,
            words: 0,
        }),
        1 => any::<u32>().prop_map(|length| Reply::Stored { kind: 1, version: 0, length, crc: 0 }),
        1 => any::<u32>().prop_map(|offset| Reply::Bytes { offset: offset % 4, bytes: b"abc" }),
        1 => any::<u32>().prop_map(|offset| Reply::Words { offset: offset % 4, bytes: b"abcde" }),
    ]
}

fn options() -> Options {
    Options {
        timing: Timing {
            settle: Duration::from_secs(2),
            ..Timing::default()
        },
        ..Options::default()
    }
}

proptest! {
    #![proptest_config(seeded(200))]

    #[test]
    fn no_bytes_make_an_axis(
        said in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..600), 1..20),
    ) {
        let opened = Axis::open(Babble { said, exchanges: 0 }, options());
        let is_lost = matches!(opened, Err(Error::Lost { .. }));
        prop_assert!(is_lost);
    }

    #[test]
    fn no_answer_breaks_the_tool(replies in prop::collection::vec(reply(), 0..20)) {
        // Each may fail, none may panic or go on for ever; told errors are sentences.
        let mut axis = Axis::open(Liar::new(replies), options());
        if let Ok(axis) = &mut axis {
            let outcomes = [
                axis.enable().map(drop),
                axis.move_and_wait(1.0, 100.0).map(drop),
                axis.home().map(drop),
                axis.jog(1.0),
                axis.stop().map(drop),
                axis.wait(Duration::from_millis(100)),
                axis.parameters().map(drop),
                axis.set_parameter("motion.µ", 1.0),
                axis.read_stored(Kind::EncoderMap).map(drop),
                axis.write_stored(Kind::ScrewTable, &[1; 300]),
                axis.read_work(1).map(drop),
                axis.fault_page().map(drop),
                axis.link_statistics().map(drop),
                axis.keep_alive_while(|| ()),
                axis.disable().map(drop),
                axis.reconnect(),
            ];
            for error in outcomes.into_iter().filter_map(Result::err) {
                prop_assert!(error.to_string().len() > 20);
            }
        }
    }
}

#[test]
fn another_version_is_told_with_both_numbers() {
    let liar = Liar {
        protocol: 7,
        ..Liar::new(Vec::new())
    };
    let Err(error) = Axis::open(liar, Options::default()) else {
        panic!("opened");
    };
    let text = error.to_string();
    assert!(matches!(error, Error::ProtocolVersion { axis: 7, .. }));
    assert!(
        text.contains("version 7") && text.contains("9.9.9") && text.contains("tool version 1"),
        "{text}"
    );
}
