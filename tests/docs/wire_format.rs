//! `docs/wire-format.md`: its tables are what the code says, and its example is what the code makes.

use std::fmt::Write as _;

use leadscrew::protocol::Described;
use leadscrew::protocol::decoder::Decoder;
use leadscrew::protocol::frame::{
    Channel, FrameBuffer, HEADER, Header, MAX_BODY, MAX_CONTENT, MAX_FRAME,
};
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;

use crate::{reviewed, with};

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/wire-format.md");

/// A text of the code without the marks of its links.
fn plain(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, link)) = rest.split_once('[') {
        let (name, behind) = link.split_once(']').unwrap();
        let target = behind.strip_prefix('(').and_then(|at| at.split_once(')'));
        rest = target.map_or(behind, |(_, behind)| behind);
        plain.push_str(before);
        plain.push_str(name);
    }
    plain + rest
}

fn messages(all: &[Described], note: impl Fn(&Described) -> &'static str) -> String {
    let mut text = String::from("| number | message | fields | |\n| --- | --- | --- | --- |\n");
    for message in all {
        let fields = message.fields.iter().map(|field| {
            let kind = field
                .kind
                .replace("& 'a ", "&")
                .replace("&'a ", "&")
                .replace("crate::", "");
            format!("`{}: {kind}` {}", field.name, plain(field.what))
        });
        let fields = fields.collect::<Vec<_>>().join("<br>");
        let what = plain(&message.what.join(" "));
        let note = note(message);
        let _ = writeln!(
            text,
            "| {} | {} | {fields} | {what}{note} |",
            message.number, message.name
        );
    }
    text
}

/// Requests that need the lease, by number: read from bodies that are zeros but for it.
fn needs_lease(message: &Described) -> &'static str {
    let mut body = [0; 400];
    body[0] = message.number;
    let (request, _) = postcard::take_from_bytes::<Request<'_>>(&body).unwrap();
    if request.needs_lease() {
        " **Lease.**"
    } else {
        ""
    }
}

fn refusals() -> String {
    let mut text =
        String::from("| number | refusal | what | what to do |\n| --- | --- | --- | --- |\n");
    for refusal in Refusal::ALL {
        let (number, name) = (*refusal as u16, refusal.name());
        let (what, remedy) = (refusal.what(), refusal.remedy());
        let _ = writeln!(text, "| {number} | {name} | {what} | {remedy} |");
    }
    text
}

#[test]
fn the_tables_of_the_wire_format_are_what_the_code_says() {
    let page = std::fs::read_to_string(PAGE).unwrap();
    let page = with(&page, "requests", &messages(Request::ALL, needs_lease));
    let page = with(&page, "replies", &messages(Reply::ALL, |_| ""));
    reviewed("wire-format.md", &with(&page, "refusals", &refusals()));
}

/// Made by another program, from the text of the page alone.
const EXAMPLE: [&str; 2] = [
    "03 01 04 02 01 02 03 0e 0b 80 b4 89 13 80 9b ee 02 b1 86 9c a5 00",
    "03 02 04 02 01 02 03 01 07 d2 09 1a 87 96 91 00",
];

fn bytes(hex: &str) -> Vec<u8> {
    let bytes = hex.split(' ').map(|byte| u8::from_str_radix(byte, 16));
    bytes.collect::<Result<_, _>>().unwrap()
}

fn hex(bytes: &[u8]) -> String {
    let words: Vec<_> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    words.join(" ")
}

#[test]
fn the_example_is_what_the_code_makes_and_reads() {
    let page = std::fs::read_to_string(PAGE).unwrap();
    let request = Request::Move {
        target_nm: 20_000_000,
        feed_um_per_min: 6_000_000,
    };
    let reply = Reply::Ack { tick: 1234 };
    let header = Header {
        channel: Channel::Request,
        session: 0x0001_0004,
        sequence: 3,
    };
    let reply_header = Header {
        channel: Channel::Reply,
        ..header
    };
    let mut buffer = FrameBuffer::default();
    assert_eq!(hex(buffer.message(header, &request).unwrap()), EXAMPLE[0]);
    assert_eq!(
        hex(buffer.message(reply_header, &reply).unwrap()),
        EXAMPLE[1]
    );

    let mut decoder: Decoder = Decoder::new();
    let mut channels = Vec::new();
    for example in EXAMPLE {
        assert!(page.contains(&format!("| frame | `{example}` |")));
        decoder.feed_all(&bytes(example), |frame, _| {
            let body = hex(frame.body);
            assert!(page.contains(&format!("`{body}`: number {}", frame.body[0])));
            match frame.header.channel {
                Channel::Request => assert_eq!(frame.message(), Some(request)),
                Channel::Reply => assert_eq!(frame.message(), Some(reply)),
                Channel::Telemetry | Channel::Samples => panic!(),
            }
            channels.push(frame.header);
        });
    }
    assert_eq!(channels, [header, reply_header]);
}

#[test]
fn the_sizes_of_a_frame_are_those_of_the_page() {
    assert_eq!(
        (HEADER, MAX_BODY, MAX_CONTENT, MAX_FRAME),
        (7, 240, 251, 253)
    );
}
