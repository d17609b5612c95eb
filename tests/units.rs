//! Conversions at the door of the axis: every worked number of paper P1, the way back, and refusals.

use fixed::traits::Fixed;
use leadscrew::units::{
    Acceleration, AxisScale, Command, Jerk, Lag, Position, RangeError, Velocity, checked,
    discrete_mm, line_frequency_hz, lines_for_feed, lines_for_rotation,
};
use proptest::prelude::*;

#[path = "support/seeded.rs"]
mod seeded;
use seeded::seeded;

/// The paper prints a value rounded to `printed`'s last digit, `unit`: the exact one lies within half of it.
#[track_caller]
fn assert_printed(exact: f64, printed: f64, unit: f64) {
    assert!(
        (exact - printed).abs() <= 0.5 * unit * (1.0 + 1e-9),
        "{exact} is not printed as {printed}"
    );
}

fn lathe(tick_hz: f64) -> AxisScale {
    AxisScale::new(1000.0, tick_hz).unwrap()
}

#[test]
fn formula_3_gives_the_papers_velocities() {
    let scale = lathe(1000.0);
    assert_printed(scale.velocity_from_feed(20_000.0).unwrap(), 333.3, 0.1);
    assert_printed(scale.velocity_from_feed(9_000.0).unwrap(), 150.0, 1e-9);
    assert_printed(scale.velocity_from_feed(6_000.0).unwrap(), 100.0, 1e-9);
    // The direction is kept.
    assert_printed(scale.velocity_from_feed(-9_000.0).unwrap(), -150.0, 1e-9);
}

#[test]
#[expect(
    clippy::approx_constant,
    reason = "the 3.14 d/tick² of the paper are not π"
)]
fn formula_4_gives_the_papers_accelerations() {
    assert_printed(
        lathe(1000.0).acceleration_from_overload(2.0).unwrap(),
        19.6,
        0.1,
    );
    assert_printed(
        lathe(2500.0).acceleration_from_overload(2.0).unwrap(),
        3.14,
        0.01,
    );
    assert_printed(lathe(1000.0).overload_from_acceleration(2.1), 0.214, 0.001);
    assert_printed(lathe(1000.0).overload_from_acceleration(0.9), 0.092, 0.001);
}

#[test]
fn formula_5_turns_formula_7_round_on_the_papers_spindles() {
    assert_printed(
        line_frequency_hz(2_000.0, 9_000.0).unwrap(),
        300_000.0,
        1e-6,
    );
    assert_printed(
        line_frequency_hz(10_000.0, 1_800.0).unwrap(),
        300_000.0,
        1e-6,
    );
}

#[test]
fn formula_6_gives_the_papers_lines_of_a_linear_axis() {
    assert_printed(
        lines_for_feed(300_000.0, 10.0, 7_500.0).unwrap(),
        24_000.0,
        1e-6,
    );
    assert_printed(
        lines_for_feed(300_000.0, 10.0, 60_000.0).unwrap(),
        3_000.0,
        1e-6,
    );
}

#[test]
fn formula_7_gives_the_papers_lines_of_a_spindle() {
    assert_printed(
        lines_for_rotation(300_000.0, 2_000.0).unwrap(),
        9_000.0,
        1e-6,
    );
    assert_printed(
        lines_for_rotation(300_000.0, 10_000.0).unwrap(),
        1_800.0,
        1e-6,
    );
}

#[test]
fn formula_8_gives_the_papers_discretes() {
    assert_printed(discrete_mm(10.0, 24_000.0).unwrap(), 1.04e-4, 0.01e-4);
    assert_printed(1000.0 * discrete_mm(10.0, 3_000.0).unwrap(), 0.83, 0.01);
}

#[test]
fn the_16k20f3_counts_micrometres() {
    let discrete = discrete_mm(10.0, 2_500.0).unwrap();
    assert_printed(discrete, 0.001, 1e-12);
    assert_printed(lathe(1000.0).counts_from_mm(300.0) * discrete, 300.0, 1e-9);
}

#[test]
fn acceleration_and_jerk_in_si_agree_with_the_papers_formula_4() {
    let scale = lathe(2500.0);
    let overload = scale.acceleration_from_overload(0.5).unwrap();
    assert_printed(scale.acceleration_from_m_s2(0.5 * 9.81), overload, 1e-12);
    // A jerk held for a second is an acceleration: f ticks of J d/tick³.
    assert_printed(
        scale.jerk_from_m_s3(3.0) * 2500.0,
        scale.acceleration_from_m_s2(3.0),
        1e-12,
    );
}

proptest! {
    #![proptest_config(seeded(256))]

    #[test]
    fn every_conversion_turns_round(
        counts_per_mm in 1e-3..1e7_f64,
        tick_hz in 100.0..40_000.0_f64,
        share in -1.0..1.0_f64,
        lines in 1.0..1e7_f64,
        rotation_rpm in 1e-3..1e6_f64,
    ) {
        // Three or four roundings of f64 on the way.
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-14 * b.abs();
        let scale = AxisScale::new(counts_per_mm, tick_hz).unwrap();
        prop_assert_eq!((scale.counts_per_mm(), scale.tick_hz()), (counts_per_mm, tick_hz));
        let (feed, overload, mm) = (share * 1e6, share * 1e3, share * 1e4);
        prop_assert!(same(scale.feed_from_velocity(scale.velocity_from_feed(feed).unwrap()), feed));
        prop_assert!(same(scale.overload_from_acceleration(scale.acceleration_from_overload(overload).unwrap()), overload));
        prop_assert!(same(scale.mm_from_counts(scale.counts_from_mm(mm)), mm));
        let line_hz = line_frequency_hz(rotation_rpm, lines).unwrap();
        if (1e-3..=1e9).contains(&line_hz) {
            prop_assert!(same(lines_for_rotation(line_hz, rotation_rpm).unwrap(), lines));
        }
    }

    #[test]
    fn checked_passes_exactly_the_numbers_in_range(value in any::<f64>(), low in -1e6..0.0_f64, high in 0.0..1e6_f64) {
        let passes = value >= low && value <= high;
        prop_assert_eq!(checked("name", value, low, high).is_ok(), passes);
    }
}

/// Every argument of every checked conversion: name, the bounds, and a call with the rest in order.
type Argument = (&'static str, f64, f64, fn(f64) -> Result<f64, RangeError>);
const ARGUMENTS: [Argument; 13] = [
    ("counts_per_mm", 1e-3, 1e7, |value| {
        AxisScale::new(value, 1000.0).map(|_| 0.0)
    }),
    ("tick_hz", 100.0, 40_000.0, |value| {
        AxisScale::new(1000.0, value).map(|_| 0.0)
    }),
    ("feed_mm_per_min", -1e6, 1e6, |value| {
        lathe(1000.0).velocity_from_feed(value)
    }),
    ("overload_g", -1e3, 1e3, |value| {
        lathe(1000.0).acceleration_from_overload(value)
    }),
    ("rotation_rpm", 1e-3, 1e6, |value| {
        line_frequency_hz(value, 2500.0)
    }),
    ("lines", 1.0, 1e7, |value| line_frequency_hz(1000.0, value)),
    ("line_hz", 1e-3, 1e9, |value| {
        lines_for_feed(value, 10.0, 1000.0)
    }),
    ("travel_mm", 1e-6, 1e4, |value| {
        lines_for_feed(3e5, value, 1000.0)
    }),
    ("feed_mm_per_min", 1e-6, 1e6, |value| {
        lines_for_feed(3e5, 10.0, value)
    }),
    ("line_hz", 1e-3, 1e9, |value| {
        lines_for_rotation(value, 1000.0)
    }),
    ("rotation_rpm", 1e-3, 1e6, |value| {
        lines_for_rotation(3e5, value)
    }),
    ("travel_mm", 1e-6, 1e4, |value| discrete_mm(value, 2500.0)),
    ("lines", 1.0, 1e7, |value| discrete_mm(10.0, value)),
];

#[test]
fn every_argument_is_taken_at_its_bounds_and_refused_beyond_by_name_value_and_range() {
    for (name, min, max, call) in ARGUMENTS {
        assert!(
            call(min).is_ok() && call(max).is_ok(),
            "{name} at its bounds"
        );
        for value in [
            min.next_down(),
            max.next_up(),
            f64::NEG_INFINITY,
            f64::INFINITY,
            f64::NAN,
        ] {
            let error = call(value).expect_err(name);
            assert_eq!((error.name, error.min, error.max), (name, min, max));
            let message = error.to_string();
            assert_eq!(
                message,
                format!("{name} = {value} is out of range: allowed {min} to {max}")
            );
        }
    }
}

/// Largest number and LSB of a format.
fn format_of<F: Fixed>() -> (f64, f64) {
    (F::MAX.to_num(), F::DELTA.to_num())
}

#[test]
fn the_formats_have_the_documented_range_and_resolution() {
    for (name, (max, lsb), documented_max, documented_lsb) in [
        ("position", format_of::<Position>(), 1.4e14, 1.5e-5),
        ("velocity", format_of::<Velocity>(), 2048.0, 9.5e-7),
        ("acceleration", format_of::<Acceleration>(), 128.0, 6.0e-8),
        ("jerk", format_of::<Jerk>(), 4.0, 1.9e-9),
        ("lag", format_of::<Lag>(), 32_768.0, 1.5e-5),
        ("command", format_of::<Command>(), 2.0, 9.3e-10),
    ] {
        // Two printed digits.
        assert!(
            (max / documented_max - 1.0).abs() < 0.05,
            "{name}: range {max}"
        );
        assert!(
            (lsb / documented_lsb - 1.0).abs() < 0.05,
            "{name}: LSB {lsb}"
        );
    }
}
