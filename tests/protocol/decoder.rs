//! The decoder among bytes of which nothing is to be believed.

use leadscrew::protocol::decoder::Decoder;
use leadscrew::protocol::frame::{Channel, FrameBuffer, Header, MAX_BODY, MAX_FRAME, TooLarge};
use proptest::prelude::*;

use crate::any_bytes::crc32;
use crate::seeded::seeded;

type Sent = (u8, u32, u16, Vec<u8>);

fn frame((channel, session, sequence, body): &Sent) -> Vec<u8> {
    let header = Header {
        channel: Channel::from_number(*channel).unwrap(),
        session: *session,
        sequence: *sequence,
    };
    FrameBuffer::default().raw(header, body).unwrap().to_vec()
}

fn sent() -> impl Strategy<Value = Sent> {
    let byte = prop_oneof![3 => Just(0_u8), 1 => Just(255), 6 => any::<u8>()];
    let body = prop_oneof![
        4 => prop::collection::vec(byte.clone(), 0..40),
        1 => prop::collection::vec(byte, MAX_BODY..=MAX_BODY),
    ];
    (1..4_u8, any::<u32>(), any::<u16>(), body)
}

fn found<const N: usize>(decoder: &mut Decoder<N>, bytes: &[u8]) -> Vec<Sent> {
    let mut found = Vec::new();
    decoder.feed_all(bytes, |frame, _| {
        let header = frame.header;
        found.push((
            header.channel as u8,
            header.session,
            header.sequence,
            frame.body.to_vec(),
        ));
    });
    found
}

/// What happens to bytes on a line.
#[derive(Clone, Debug)]
enum Harm {
    Flip(prop::sample::Index, u8),
    Lose(prop::sample::Index, usize),
    Insert(prop::sample::Index, Vec<u8>),
    Repeat(prop::sample::Index, usize),
}

fn harm() -> impl Strategy<Value = Harm> {
    let at = any::<prop::sample::Index>;
    prop_oneof![
        (at(), 1..=255_u8).prop_map(|(at, mask)| Harm::Flip(at, mask)),
        (at(), 1..30_usize).prop_map(|(at, count)| Harm::Lose(at, count)),
        (at(), prop::collection::vec(any::<u8>(), 1..300))
            .prop_map(|(at, bytes)| Harm::Insert(at, bytes)),
        (at(), 1..60_usize).prop_map(|(at, count)| Harm::Repeat(at, count)),
    ]
}

fn suffer(line: &mut Vec<u8>, harm: &Harm) {
    if line.is_empty() {
        return;
    }
    match harm {
        Harm::Flip(at, mask) => {
            let at = at.index(line.len());
            line[at] ^= mask;
        }
        Harm::Lose(at, count) => {
            let at = at.index(line.len());
            line.drain(at..(at + count).min(line.len()));
        }
        Harm::Insert(at, bytes) => {
            let at = at.index(line.len());
            line.splice(at..at, bytes.iter().copied());
        }
        Harm::Repeat(at, count) => {
            let at = at.index(line.len());
            let again = line[at..(at + count).min(line.len())].to_vec();
            line.splice(at..at, again);
        }
    }
}

proptest! {
    #![proptest_config(seeded(2000))]

    #[test]
    fn what_is_sent_is_found_however_it_is_cut(
        frames in prop::collection::vec(sent(), 1..8),
        cuts in prop::collection::vec(1..50_usize, 1..20),
    ) {
        let line: Vec<u8> = frames.iter().flat_map(frame).collect();
        let mut decoder: Decoder = Decoder::new();
        let mut got = Vec::new();
        let (mut rest, mut cuts) = (line.as_slice(), cuts.iter().cycle());
        while !rest.is_empty() {
            let (now, later) = rest.split_at(rest.len().min(*cuts.next().unwrap()));
            got.extend(found(&mut decoder, now));
            rest = later;
        }
        prop_assert_eq!(&got, &frames);
        prop_assert_eq!(decoder.dropped().total(), 0);
        // The same byte by byte.
        let mut decoder: Decoder = Decoder::new();
        let mut count = 0;
        for &byte in &line {
            count += usize::from(decoder.feed(byte).is_some());
        }
        prop_assert_eq!(count, frames.len());
    }

    #[test]
    fn any_bytes_give_no_frame_and_the_next_good_one_is_found(
        noise in prop::collection::vec(prop_oneof![1 => Just(0_u8), 3 => any::<u8>()], 0..1500),
        good in sent(),
    ) {
        let mut decoder: Decoder = Decoder::new();
        prop_assert_eq!(found(&mut decoder, &noise), vec![]);
        // A sender begins with a zero.
        prop_assert_eq!(found(&mut decoder, &[0]), vec![]);
        prop_assert_eq!(found(&mut decoder, &frame(&good)), vec![good]);
    }

    #[test]
    fn a_harmed_line_gives_nothing_that_was_not_sent_and_recovers(
        frames in prop::collection::vec(sent(), 1..8),
        harms in prop::collection::vec(harm(), 1..6),
        good in sent(),
    ) {
        let mut line: Vec<u8> = frames.iter().flat_map(frame).collect();
        harms.iter().for_each(|harm| suffer(&mut line, harm));
        let mut decoder: Decoder = Decoder::new();
        for got in found(&mut decoder, &line) {
            prop_assert!(frames.contains(&got), "{:?}", got);
        }
        found(&mut decoder, &[0]);
        prop_assert_eq!(found(&mut decoder, &frame(&good)), vec![good]);
    }

    #[test]
    fn a_flipped_bit_is_seen_and_counted_once(good in sent(), bit in any::<prop::sample::Index>()) {
        let mut bytes = frame(&good);
        let bit = bit.index((bytes.len() - 1) * 8);
        bytes[bit / 8] ^= 1 << (bit % 8);
        let mut decoder: Decoder = Decoder::new();
        prop_assert_eq!(found(&mut decoder, &bytes), vec![]);
        let dropped = decoder.dropped().total();
        // A zero made of a byte makes two of a frame; a byte of the stuffing may swallow the rest.
        prop_assert!((1..=2).contains(&dropped), "{:?}", decoder.dropped());
    }
}

#[test]
fn each_kind_of_wrong_frame_is_counted_as_what_it_is() {
    let good: Sent = (1, 7, 9, vec![1, 2, 3, 4, 5, 6, 7, 8, 9]);
    let bytes = frame(&good);
    let mut decoder: Decoder<32> = Decoder::new();
    let mut after = |bytes: &[u8]| {
        assert_eq!(found(&mut decoder, bytes), vec![]);
        *decoder.dropped()
    };
    assert_eq!(after(&[0, 0, 0]).total(), 0, "zeros are no frames");
    assert_eq!(after(&[5, 1, 1, 0]).torn, 1);
    assert_eq!(after(&[4, 1, 1, 1, 0]).too_short, 1);
    let mut wrong = bytes.clone();
    wrong[12] ^= 1;
    assert_eq!(after(&wrong).checksum, 1);
    assert_eq!(after(&frame(&(1, 7, 9, vec![1; 40]))).too_long, 1);
    // Channel 9, with the right checksum.
    let mut content = vec![9, 7, 0, 0, 0, 9, 0];
    let sum = crc32(&content);
    content.extend_from_slice(&sum.to_le_bytes());
    let mut stuffed = vec![0; 32];
    let length = cobs::encode(&content, &mut stuffed);
    stuffed.truncate(length + 1);
    let counts = after(&stuffed);
    assert_eq!((counts.unknown, counts.total()), (1, 5));
    assert_eq!(found(&mut decoder, &bytes), vec![good]);
}

#[test]
fn frames_have_a_largest_size() {
    let header = Header {
        channel: Channel::Request,
        session: u32::MAX,
        sequence: u16::MAX,
    };
    let mut buffer = FrameBuffer::default();
    assert_eq!(buffer.raw(header, &[7; MAX_BODY]).unwrap().len(), MAX_FRAME);
    assert_eq!(buffer.raw(header, &[7; MAX_BODY + 1]), Err(TooLarge));
    let name = "x".repeat(MAX_BODY);
    let request = leadscrew::protocol::request::Request::Parameter { name: &name };
    assert_eq!(buffer.message(header, &request), Err(TooLarge));
}
