//! Limits and moves that are refused.

use leadscrew::setpoint::profile::{Limits, MAX_TICKS, PlanError, Profile};
use leadscrew::setpoint::trajectory::Trajectory;
use leadscrew::units::Position;
use proptest::prelude::*;

use crate::moves::{distance, run};
use crate::seeded::seeded;

proptest! {
    #![proptest_config(seeded(256))]

    #[test]
    fn limits_are_rounded_down_to_the_grid(
        velocity in 1e-4..2047.0_f64,
        acceleration in 6e-6..127.0_f64,
        jerk in 2e-9..3.9_f64,
    ) {
        let limits = Limits::new(velocity, acceleration, jerk).unwrap();
        let lsb = |bits: i32| 0.5_f64.powi(bits);
        for (kept, asked, lsb) in [
            (limits.velocity().to_num::<f64>(), velocity, lsb(20)),
            (limits.acceleration().to_num::<f64>(), acceleration, lsb(24)),
            (limits.jerk().to_num::<f64>(), jerk, lsb(29)),
        ] {
            prop_assert!(kept <= asked && kept > asked - lsb, "{} became {}", asked, kept);
        }
    }

    #[test]
    fn planning_neither_fails_nor_overflows_within_the_documented_range(far in any::<i64>(), near in distance()) {
        let limits = Limits::new(100.0, 1.0, 0.1).unwrap();
        let far = Position::from_bits(far);
        let too_far = far.unsigned_abs() > (1 << 31);
        let planned = Profile::plan(far, &limits);
        prop_assert_eq!(planned.err(), too_far.then_some(PlanError::TooFar));
        prop_assert!(Profile::plan(near, &limits).is_ok());
    }
}

#[test]
fn limits_beyond_their_format_are_refused_by_name_value_and_range() {
    let new = |velocity, acceleration, jerk| Limits::new(velocity, acceleration, jerk).unwrap_err();
    for (error, name, value, min, max) in [
        (
            new(9e-5, 1.0, 0.1),
            "max_velocity_d_per_tick",
            9e-5,
            1e-4,
            2047.0,
        ),
        (
            new(2047.5, 1.0, 0.1),
            "max_velocity_d_per_tick",
            2047.5,
            1e-4,
            2047.0,
        ),
        (
            new(1.0, 5e-6, 0.1),
            "max_acceleration_d_per_tick2",
            5e-6,
            6e-6,
            127.0,
        ),
        (
            new(1.0, 128.0, 0.1),
            "max_acceleration_d_per_tick2",
            128.0,
            6e-6,
            127.0,
        ),
        (new(1.0, 1.0, 1e-9), "max_jerk_d_per_tick3", 1e-9, 2e-9, 3.9),
        (new(1.0, 1.0, 4.0), "max_jerk_d_per_tick3", 4.0, 2e-9, 3.9),
    ] {
        assert_eq!(
            (error.name, error.value, error.min, error.max),
            (name, value, min, max)
        );
    }
    for nan in [
        new(f64::NAN, 1.0, 0.1),
        new(1.0, f64::NAN, 0.1),
        new(1.0, 1.0, f64::NAN),
    ] {
        assert!(nan.value.is_nan());
    }
}

#[test]
fn the_longest_distance_is_planned_and_one_lsb_more_is_too_far() {
    let limits = Limits::new(2047.0, 127.0, 3.9).unwrap();
    let longest = Position::from_num(1_i64 << 31);
    for (distance, refused) in [
        (longest, None),
        (-longest, None),
        (longest + Position::DELTA, Some(PlanError::TooFar)),
        (-longest - Position::DELTA, Some(PlanError::TooFar)),
        (Position::MAX, Some(PlanError::TooFar)),
        (Position::MIN, Some(PlanError::TooFar)),
    ] {
        assert_eq!(
            Profile::plan(distance, &limits).err(),
            refused,
            "{distance}"
        );
    }
}

#[test]
fn a_move_beyond_31_bits_of_ticks_is_too_long() {
    let limits = Limits::new(1e-4, 127.0, 3.9).unwrap();
    let velocity = limits.velocity().to_num::<f64>();
    let just_fits = Profile::plan(
        Position::from_num(velocity * (f64::from(MAX_TICKS) - 10.0)),
        &limits,
    )
    .unwrap();
    assert!(just_fits.ticks() <= MAX_TICKS);
    let too_long = Profile::plan(
        Position::from_num(velocity * (f64::from(MAX_TICKS) + 10.0)),
        &limits,
    );
    assert_eq!(too_long, Err(PlanError::TooLong));
}

#[test]
fn ramps_of_any_length_are_planned_and_errors_say_what_to_do() {
    // 2 000 d/tick at 6e-6 d/tick² take 3.3e8 ticks.
    let limits = Limits::new(2000.0, 6e-6, 3.9).unwrap();
    let planned = Profile::plan(Position::from_num(2e9), &limits).unwrap();
    let optimal = 2.0 * (2e9 / limits.acceleration().to_num::<f64>()).sqrt();
    assert!((f64::from(planned.ticks()) - optimal).abs() < 7.0);
    assert!(
        PlanError::TooLong
            .to_string()
            .contains("raise its limits or shorten it")
    );
    assert!(PlanError::TooFar.to_string().contains("2147483648 d"));
}

#[test]
fn a_move_of_no_distance_takes_no_tick_and_moves_nothing() {
    let limits = Limits::new(1.0, 1.0, 1.0).unwrap();
    let profile = Profile::plan(Position::ZERO, &limits).unwrap();
    assert_eq!(profile.ticks(), 0);
    let mut trajectory = Trajectory::new();
    trajectory.hold(Position::from_num(5));
    run(&mut trajectory, &profile, 0, |setpoint| {
        assert_eq!(
            (setpoint.position, setpoint.velocity.to_bits()),
            (Position::from_num(5), 0)
        );
    });
    assert!(!trajectory.is_moving());
}
