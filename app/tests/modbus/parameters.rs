//! Parameters: read exactly, written while the axis is off, refused with a reason.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::service::Passed;
use leadscrew::supervisor::State;
use leadscrew_app::modbus::Parameter;

use crate::fake::{Panel as _, UNIT, Unit, asking, framed, number, words, writing};
use crate::page::names;

const BUSY: [u8; 2] = [0x90, 6];
const ILLEGAL_ADDRESS: [u8; 2] = [0x90, 2];
const ILLEGAL_VALUE: [u8; 2] = [0x90, 3];
const LAST_REFUSAL: u16 = 81;

/// First register of a parameter.
#[track_caller]
fn place(name: &str) -> u16 {
    let index = names().iter().position(|known| known == name).unwrap();
    1000 + 4 * index as u16
}

/// Refused with that exception for that reason.
#[track_caller]
fn refused(unit: &mut Unit, address: u16, words: &[u16], exception: [u8; 2], reason: Refusal) {
    let before = unit.panel.settings;
    assert_eq!(unit.write(address, words), exception);
    assert_eq!(unit.read(4, LAST_REFUSAL, 1), [reason as u16]);
    assert!(unit.panel.settings == before);
}

#[test]
fn every_parameter_is_read_to_the_last_bit_with_its_range() {
    let mut unit = Unit::default();
    unit.panel.settings.axis.motion.counts_per_mm = 1.0 / 3.0;
    for index in 0..names().len() as u16 {
        let parameter = Parameter::at(unit.panel.settings(), index).unwrap();
        let read = [1000, 2000, 3000, 4000].map(|base| unit.read(3, base + 4 * index, 4));
        let read = read.map(|words| number(&words).to_bits());
        let figures = [
            parameter.value,
            parameter.min,
            parameter.max,
            parameter.default,
        ];
        assert_eq!(
            read,
            figures.map(f64::to_bits),
            "{}",
            names()[usize::from(index)]
        );
    }
    let address = place("motion.counts_per_mm");
    assert_eq!(number(&unit.read(4, address, 4)), 1.0 / 3.0);
}

#[test]
fn a_parameter_is_written_while_the_axis_is_off() {
    let mut unit = Unit::default();
    let address = place("motion.max_feed_mm_per_min");
    assert_eq!(unit.write(address, &words(8000.1)), asking(16, address, 4));
    assert_eq!(unit.panel.settings.axis.motion.max_feed_mm_per_min, 8000.1);
    unit.panel.view.seen.state = State::Fault;
    assert_eq!(unit.write(address, &words(8000.2)), asking(16, address, 4));
    assert_eq!(unit.read(4, LAST_REFUSAL, 1), [0]);
}

#[test]
fn parameters_that_go_together_are_written_in_one_request() {
    let mut unit = Unit::default();
    let low = place("motion.travel_low_mm");
    assert_eq!(low + 4, place("motion.travel_high_mm"));
    // Each alone would be the wrong way round, or both are.
    refused(
        &mut unit,
        low,
        &words(100.0),
        ILLEGAL_VALUE,
        Refusal::Inconsistent,
    );
    let both = [words(100.0), words(200.0)].concat();
    assert_eq!(unit.write(low, &both), asking(16, low, 8));
    let motion = &unit.panel.settings.axis.motion;
    assert_eq!(
        [motion.travel_low_mm, motion.travel_high_mm],
        [100.0, 200.0]
    );
    let reversed = [words(300.0), words(200.0)].concat();
    refused(
        &mut unit,
        low,
        &reversed,
        ILLEGAL_VALUE,
        Refusal::Inconsistent,
    );
}

#[test]
fn an_axis_that_is_on_is_not_set() {
    let mut unit = Unit::default();
    let address = place("motion.max_feed_mm_per_min");
    unit.panel.view.seen.enabled = true;
    refused(&mut unit, address, &words(8000.0), BUSY, Refusal::AxisOn);
    unit.panel.view.seen.enabled = false;
    for state in [
        State::Enabling,
        State::Ready,
        State::Moving,
        State::Stopping,
    ] {
        unit.panel.view.seen.state = state;
        refused(&mut unit, address, &words(8000.0), BUSY, Refusal::AxisOn);
        refused(&mut unit, 5000, &[0x5A5A], BUSY, Refusal::AxisOn);
    }
    assert_eq!(unit.panel.saved, 0);
}

#[test]
fn values_out_of_range_and_what_is_no_number_are_refused() {
    let mut unit = Unit::default();
    let address = place("motion.counts_per_mm");
    for value in [0.0, 1e8, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let reason = Refusal::ParameterOutOfRange;
        refused(&mut unit, address, &words(value), ILLEGAL_VALUE, reason);
    }
    // All or none: the second is out of range.
    let both = [words(500.0), words(-1.0)].concat();
    refused(
        &mut unit,
        address,
        &both,
        ILLEGAL_VALUE,
        Refusal::ParameterOutOfRange,
    );
}

#[test]
fn only_whole_parameters_are_written() {
    let mut unit = Unit::default();
    let address = place("motion.counts_per_mm");
    for count in [1, 2, 3, 5, 123] {
        let words = vec![0; count];
        refused(
            &mut unit,
            address,
            &words,
            ILLEGAL_ADDRESS,
            Refusal::NotUnderstood,
        );
    }
    for offset in 1..4 {
        let words = words(500.0);
        refused(
            &mut unit,
            address + offset,
            &words,
            ILLEGAL_ADDRESS,
            Refusal::NotUnderstood,
        );
    }
    assert_eq!(unit.ask(&asking(6, address, 1)), [0x86, 2]);
    assert_eq!(
        unit.read(4, LAST_REFUSAL, 1),
        [Refusal::NotUnderstood as u16]
    );
}

#[test]
fn nothing_else_is_written() {
    let mut unit = Unit::default();
    let behind = 1000 + 4 * names().len() as u16;
    for address in [
        0, 1, 2, 8, 81, 900, 996, behind, 2000, 3000, 4000, 4996, 5001, 65_532,
    ] {
        let reason = Refusal::UnknownParameter;
        refused(&mut unit, address, &words(1.0), ILLEGAL_ADDRESS, reason);
        assert_eq!(unit.ask(&asking(6, address, 1)), [0x86, 2], "{address}");
    }
    let last = [words(1.0), words(1.0)].concat();
    refused(
        &mut unit,
        behind - 4,
        &last,
        ILLEGAL_ADDRESS,
        Refusal::UnknownParameter,
    );
}

#[test]
fn saving_takes_its_key_and_tells_when_it_failed() {
    let mut unit = Unit::default();
    assert_eq!(unit.ask(&asking(6, 5000, 0x5A5A)), asking(6, 5000, 0x5A5A));
    assert_eq!(unit.write(5000, &[0x5A5A]), asking(16, 5000, 1));
    assert_eq!(unit.panel.saved, 2);
    assert_eq!(unit.read(3, 5000, 1), [0]);
    for key in [0, 1, 0x5A5B, 0xA5A5] {
        assert_eq!(unit.ask(&asking(6, 5000, key)), [0x86, 3]);
    }
    refused(
        &mut unit,
        5000,
        &[0x5A5A; 2],
        ILLEGAL_VALUE,
        Refusal::ParameterOutOfRange,
    );
    unit.panel.store = Err(Refusal::NotSupported);
    refused(&mut unit, 5000, &[0x5A5A], [0x90, 4], Refusal::NotSupported);
    assert_eq!(unit.panel.saved, 2);
}

#[test]
fn a_word_is_its_place_among_the_words() {
    let mut unit = Unit::default();
    let address = place("estimator");
    let names = EstimatorConfig::NAMES;
    for (at, name) in names.iter().enumerate() {
        let value = words(at as f64);
        assert_eq!(unit.write(address, &value), asking(16, address, 4));
        assert_eq!(unit.panel.settings.axis.estimator.name(), *name);
        assert_eq!(unit.read(4, address, 4), value);
    }
    assert_eq!(number(&unit.read(4, address + 1000, 4)), 0.0);
    assert_eq!(
        number(&unit.read(4, address + 2000, 4)),
        names.len() as f64 - 1.0
    );
    assert!(number(&unit.read(4, address + 3000, 4)).is_nan());
    for value in [-1.0, 0.5, names.len() as f64, f64::NAN] {
        refused(
            &mut unit,
            address,
            &words(value),
            ILLEGAL_VALUE,
            Refusal::UnknownWord,
        );
    }
}

#[test]
fn what_is_on_its_way_is_answered_when_the_axis_has_taken_it() {
    let mut unit = Unit::default();
    let address = place("motion.max_feed_mm_per_min");
    let request = framed(UNIT, &writing(address, &words(8000.0)));
    unit.panel.passed = Passed::OnItsWay(7);
    assert!(unit.hear(&request).is_empty());
    assert!(unit.wait_us(100).is_empty());
    unit.panel.outcome = Some(Ok(()));
    let taken = [framed(UNIT, &asking(16, address, 4))];
    assert_eq!(unit.wait_us(100), taken);
    assert!(unit.wait_us(100).is_empty(), "once");

    unit.panel.outcome = None;
    assert!(unit.hear(&request).is_empty());
    unit.panel.outcome = Some(Err(Refusal::AxisOn));
    assert_eq!(unit.wait_us(100), [framed(UNIT, &BUSY)]);
    assert_eq!(unit.read(4, LAST_REFUSAL, 1), [25]);
    // The master does not wait for it any more.
    unit.panel.outcome = None;
    assert!(unit.hear(&request).is_empty());
    assert_eq!(unit.read(4, 0, 1), [1]);
    unit.panel.outcome = Some(Ok(()));
    assert!(unit.wait_us(100).is_empty());
}
