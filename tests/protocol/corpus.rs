//! The fuzzer's corpus, replayed through the function that it runs.

use std::path::Path;

use leadscrew::protocol::Described;
use leadscrew::protocol::client::Client;
use leadscrew::protocol::frame::{Channel, FrameBuffer, Header};
use leadscrew::protocol::request::Request;
use proptest::prelude::*;

use crate::any_bytes::{check, check_bodies, good_frames};
use crate::rig::Rig;
use crate::seeded::seeded;

/// A folder a fuzz target.
const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/fuzz/corpus");

#[test]
fn every_file_of_the_corpus_passes() {
    replay("decoder", &seeds(), check);
    replay("service", &[("session", bodies())], check_bodies);
}

/// Runs all files of a fuzz target, which are at least `seeds`.
#[track_caller]
fn replay(target: &str, seeds: &[(&str, Vec<u8>)], check: fn(&[u8]) -> usize) {
    let folder = Path::new(ROOT).join(target);
    for (name, bytes) in seeds {
        if std::env::var_os("INSTA_UPDATE").is_some_and(|update| update == "always") {
            std::fs::create_dir_all(&folder).unwrap();
            std::fs::write(folder.join(name), bytes).unwrap();
        }
        let kept = std::fs::read(folder.join(name)).unwrap_or_default();
        assert!(
            kept == *bytes,
            "{target}/{name} is not what the code makes: run `cargo xtask golden`"
        );
    }
    for entry in std::fs::read_dir(folder).unwrap() {
        check(&std::fs::read(entry.unwrap().path()).unwrap());
    }
}

/// What the fuzzer begins with: a whole session, and what may become of it.
fn seeds() -> Vec<(&'static str, Vec<u8>)> {
    let session = session();
    let mut doubled = session.clone();
    doubled.extend_from_slice(&session);
    let mut flipped = session.clone();
    flipped[20] ^= 4;
    let mut unknown = FrameBuffer::default();
    let header = Header {
        channel: Channel::Telemetry,
        session: 1,
        sequence: 1,
    };
    vec![
        ("torn", session[7..].to_vec()),
        ("session", session),
        ("doubled", doubled),
        ("flipped", flipped),
        ("zeros", vec![0; 20]),
        ("long", vec![255; 600]),
        ("largest", unknown.raw(header, &[0; 240]).unwrap().to_vec()),
    ]
}

/// A body of each request, after its length.
fn bodies() -> Vec<u8> {
    let body = |request: &Described| {
        let mut body = vec![10, request.number];
        body.extend_from_slice(&[1; 9]);
        body
    };
    Request::ALL.iter().flat_map(body).collect()
}

/// A session of the service in `check`: its number is that of the first hello at tick 0.
fn session() -> Vec<u8> {
    let mut client = Client::new();
    let mut bytes = client
        .request(&Request::Hello {
            protocol: 1,
            nonce: 1,
        })
        .unwrap()
        .to_vec();
    let requests = [
        Request::TakeLease {},
        Request::Enable {},
        Rig::move_to(1),
        Request::Stop {},
        Request::Status {},
        Request::Parameter {
            name: "output.limit",
        },
        Request::SetParameter {
            name: "output.limit",
            value: 0.5,
        },
    ];
    for (sequence, request) in (2..).zip(&requests) {
        let header = Header {
            channel: Channel::Request,
            session: 0x1_0000,
            sequence,
        };
        bytes.extend_from_slice(FrameBuffer::default().message(header, request).unwrap());
    }
    bytes
}

#[test]
fn the_session_of_the_corpus_is_one() {
    assert_eq!(good_frames(&session()).len(), 8);
    // Enabled, moved, and off in time to set; the stop waits for the start of the move, and the axis is off before.
    assert_eq!(check(&session()), 3);
}

proptest! {
    #![proptest_config(seeded(300))]

    #[test]
    fn any_bytes_pass(bytes in prop::collection::vec(prop_oneof![1 => Just(0_u8), 4 => any::<u8>()], 0..800)) {
        check(&bytes);
    }

    #[test]
    fn any_bodies_pass(bodies in prop::collection::vec((0..21_u8, prop::collection::vec(0..5_u8, 0..12)), 0..40)) {
        let mut bytes = Vec::new();
        for (number, fields) in &bodies {
            bytes.extend_from_slice(&[fields.len() as u8 + 1, *number]);
            bytes.extend_from_slice(fields);
        }
        check_bodies(&bytes);
    }

    #[test]
    fn a_session_with_other_bytes_in_it_passes(
        at in any::<prop::sample::Index>(),
        bytes in prop::collection::vec(any::<u8>(), 0..5),
        lost in 0..5_usize,
    ) {
        let mut line = session();
        let at = at.index(line.len());
        let end = (at + lost).min(line.len());
        line.splice(at..end, bytes);
        check(&line);
    }
}
