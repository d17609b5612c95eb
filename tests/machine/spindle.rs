//! The spindle of the reference scene: speed, ripple, drop, index, and a cable that is cut.

use leadscrew::hal::Encoder as _;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::spindle::{Spindle, SpindleParams, encoder_1024};

fn spindle(params: &SpindleParams) -> Spindle {
    Spindle::new(params, &encoder_1024(EncoderModel::ideal()), 1000.0, 1).unwrap()
}

/// Least, largest and mean speed over a second, rpm.
fn speeds(spindle: &mut Spindle) -> (f64, f64, f64) {
    let from = spindle.turns();
    let (mut least, mut most) = (f64::MAX, f64::MIN);
    for _ in 0..1000 {
        spindle.step();
        let rpm = spindle.truth().velocity * 60_000.0 / 4096.0;
        (least, most) = (least.min(rpm), most.max(rpm));
    }
    (least, most, (spindle.turns() - from) * 60.0)
}

#[test]
fn its_speed_ripples_by_one_per_cent_and_drops_by_five_under_the_cut() {
    let mut spindle = spindle(&SpindleParams::default());
    let (least, most, mean) = speeds(&mut spindle);
    assert!((least - 495.0).abs() < 0.01 && (most - 505.0).abs() < 0.01);
    assert!((mean - 500.0).abs() < 0.01, "{mean}");
    spindle.load(true);
    for _ in 0..50 {
        spindle.step();
    }
    let (least, most, mean) = speeds(&mut spindle);
    assert!((least - 470.25).abs() < 0.01 && (most - 479.75).abs() < 0.01);
    assert!((mean - 475.0).abs() < 0.01, "{mean}");
    spindle.load(false);
    for _ in 0..50 {
        spindle.step();
    }
    assert!((speeds(&mut spindle).2 - 500.0).abs() < 0.01);
}

#[test]
fn its_count_is_its_angle_and_its_index_comes_once_a_revolution() {
    let mut spindle = spindle(&SpindleParams {
        rpm: 1000.0,
        ..SpindleParams::default()
    });
    let mut indexes = Vec::new();
    for _ in 0..600 {
        spindle.step();
        let capture = spindle.capture();
        let count = f64::from(capture.count.cast_signed());
        assert_eq!(count, spindle.truth().position.floor());
        indexes.extend(capture.index.map(|latch| latch.count));
    }
    assert_eq!(indexes.len(), 10);
    assert!(indexes.iter().all(|count| count % 4096 == 0), "{indexes:?}");
}

#[test]
fn it_turns_back_when_told_and_falls_silent_when_its_cable_is_cut() {
    let mut spindle = spindle(&SpindleParams::default());
    spindle.set_rpm(-200.0);
    for _ in 0..701 {
        spindle.step();
    }
    let (_, _, mean) = speeds(&mut spindle);
    assert!((mean + 200.0).abs() < 0.01, "{mean}");
    spindle.cut_cable();
    spindle.step();
    let count = spindle.capture().count;
    for _ in 0..100 {
        spindle.step();
        assert_eq!(spindle.capture().count, count);
        assert_eq!(spindle.capture().edges, [&[] as &[u32], &[]]);
    }
}
