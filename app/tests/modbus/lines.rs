//! Frames: what is taken, what is passed over, how the line is found again.

use leadscrew_app::modbus::line::checksum;
use leadscrew_app::modbus::{Config, ConfigError};

use crate::fake::{UNIT, Unit, asking, crc, framed, writing};

/// Reads the version of the map.
const VERSION: [u8; 5] = [4, 0, 0, 0, 1];
const ANSWER: [u8; 4] = [4, 2, 0, 1];

fn version() -> Vec<u8> {
    framed(UNIT, &VERSION)
}

fn answer() -> Vec<Vec<u8>> {
    vec![framed(UNIT, &ANSWER)]
}

#[test]
fn the_checksum_is_that_of_published_frames() {
    // The specification's own example, and two of tutorials.
    for (content, check) in [
        (&[0x02, 0x07][..], 0x1241),
        (&[0x01, 0x03, 0x00, 0x00, 0x00, 0x0A], 0xCDC5),
        (&[0x11, 0x03, 0x00, 0x6B, 0x00, 0x03], 0x8776),
    ] {
        assert_eq!(checksum(content), check);
        assert_eq!(crc(content), check);
    }
}

#[test]
fn a_silence_is_three_and_a_half_characters_or_its_least() {
    let silence = |baud| Config::serial(1, baud).unwrap().silence_us();
    assert_eq!(silence(9_600), 4_011);
    assert_eq!(silence(19_200), 2_006);
    assert_eq!(silence(115_200), 1_750);
    let refused = |unit, baud| Config::serial(unit, baud).unwrap_err();
    assert_eq!(refused(0, 9_600), ConfigError::Unit(0));
    assert_eq!(refused(248, 9_600), ConfigError::Unit(248));
    assert_eq!(refused(1, 0), ConfigError::Baud(0));
    assert_eq!(
        refused(0, 9_600).to_string(),
        "unit = 0 is out of range: allowed 1 to 247"
    );
}

#[test]
fn a_frame_is_taken_at_once_byte_by_byte_and_with_others() {
    let mut unit = Unit::default();
    assert_eq!(unit.hear(&version()), answer());
    let frame = version();
    let (last, before) = frame.split_last().unwrap();
    for byte in before {
        assert!(unit.hear(&[*byte]).is_empty());
        assert!(unit.wait_us(500).is_empty());
    }
    assert_eq!(unit.hear(&[*last]), answer());
    let merged = [version(), version(), version()].concat();
    assert_eq!(unit.hear(&merged).len(), 3);
}

#[test]
fn a_piece_is_forgotten_after_a_silence_and_the_next_frame_is_taken() {
    let mut unit = Unit::default();
    for length in 1..version().len() {
        assert!(unit.hear(&version()[..length]).is_empty());
        assert!(unit.wait_us(2_006).is_empty());
        assert_eq!(unit.hear(&version()), answer(), "after {length} bytes");
    }
    // Also where nobody looked meanwhile.
    assert!(unit.hear(&version()[..5]).is_empty());
    unit.now_us = unit.now_us.wrapping_add(2_006);
    assert_eq!(unit.hear(&version()), answer());
}

#[test]
fn a_carrier_without_time_may_split_a_frame_anywhere() {
    let mut unit = Unit::default();
    let config = Config::serial(UNIT, 19_200).unwrap();
    let config = config.with_silence_us(100_000);
    unit.modbus = leadscrew_app::modbus::Modbus::new(config, unit.panel.settings);
    for length in 1..version().len() {
        let frame = version();
        let (first, second) = frame.split_at(length);
        assert!(unit.hear(first).is_empty());
        assert!(unit.wait_us(99_999).is_empty());
        assert_eq!(unit.hear(second), answer());
    }
}

#[test]
fn a_frame_behind_garbage_is_answered_at_once_or_with_the_silence() {
    let mut unit = Unit::default();
    for garbage in [
        &[0x00][..],
        &[0xff, 0xff],
        &[0x37],
        &[UNIT],
        &[UNIT, 4],
        &[UNIT, 16, 0, 0, 0, 1],
        &[3, 16, 0, 0, 0, 100, 200, 1],
        &[0; 300],
        &[UNIT; 300],
    ] {
        let mut sent = unit.hear(garbage);
        sent.extend(unit.hear(&version()));
        sent.extend(unit.wait_us(2_006));
        assert_eq!(sent, answer(), "behind {garbage:02x?}");
    }
}

#[test]
fn other_units_and_all_units_are_not_answered() {
    let mut unit = Unit::default();
    for other in (0..=255).filter(|other| *other != UNIT) {
        assert!(unit.hear(&framed(other, &VERSION)).is_empty());
        assert!(
            unit.hear(&framed(other, &writing(5000, &[0x5A5A])))
                .is_empty()
        );
        assert!(unit.wait_us(2_006).is_empty());
    }
    assert_eq!(unit.panel.saved, 0);
}

#[test]
fn what_other_units_carry_is_not_taken_for_a_frame() {
    let mut unit = Unit::default();
    // A request and a reply of unit 3 whose data are frames of ours.
    let inner = version();
    let mut data = inner.clone();
    data.extend([0; 2]);
    let words = data.as_chunks().0.iter().copied().map(u16::from_be_bytes);
    let words: Vec<u16> = words.collect();
    assert!(unit.hear(&framed(3, &writing(0, &words))).is_empty());
    let mut reply = vec![4, data.len() as u8];
    reply.extend(&data);
    assert!(unit.hear(&framed(3, &reply)).is_empty());
    // With our own behind, no time between.
    let merged = [framed(3, &reply), framed(3, &[0x84, 2]), version()].concat();
    assert_eq!(unit.hear(&merged), answer());
}

#[test]
fn every_flipped_bit_makes_it_another_frame_that_is_not_answered() {
    for bit in 0..version().len() * 8 {
        let mut unit = Unit::default();
        let mut frame = version();
        frame[bit / 8] ^= 1 << (bit % 8);
        let mut sent = unit.hear(&frame);
        sent.extend(unit.wait_us(2_006));
        assert!(sent.is_empty(), "bit {bit}: {sent:02x?}");
    }
}

#[test]
fn functions_that_are_not_there_are_refused_those_of_exceptions_are_not_answered() {
    let mut unit = Unit::default();
    // Of any length: it ends with the silence.
    for request in [&[7][..], &[0x2b, 0x0e, 1, 0], &[0x17; 12], &[8, 0, 0, 1, 2]] {
        let mut sent = unit.hear(&framed(UNIT, request));
        sent.extend(unit.wait_us(2_006));
        assert_eq!(sent, [framed(UNIT, &[request[0] | 0x80, 1])]);
    }
    for function in 0x80..=0xff {
        let mut sent = unit.hear(&framed(UNIT, &asking(function, 0, 1)));
        sent.extend(unit.wait_us(2_006));
        assert!(sent.is_empty());
    }
}

#[test]
fn counts_that_are_zero_too_large_or_do_not_go_together_are_refused() {
    let mut unit = Unit::default();
    let illegal_value = |function: u8| vec![function | 0x80, 3];
    for (function, too_many) in [(1, 2001), (2, 2001), (3, 126), (4, 126)] {
        for count in [0, too_many, u16::MAX] {
            let reply = unit.ask(&asking(function, 0, count));
            assert_eq!(reply, illegal_value(function), "{function}, {count}");
        }
    }
    assert_eq!(unit.ask(&[16, 3, 232, 0, 0, 0]), illegal_value(16));
    assert_eq!(
        unit.ask(&[16, 3, 232, 0, 4, 4, 0, 0, 0, 0]),
        illegal_value(16)
    );
    assert_eq!(unit.ask(&[15, 0, 0, 0, 9, 1, 0]), illegal_value(15));
    assert_eq!(unit.ask(&[5, 0, 0, 0x12, 0x34]), illegal_value(5));
    // A length that is not the function's, ended by the silence.
    let mut sent = unit.hear(&framed(UNIT, &[4, 0, 0, 0]));
    sent.extend(unit.wait_us(2_006));
    assert_eq!(sent, [framed(UNIT, &[0x84, 3])]);
}
