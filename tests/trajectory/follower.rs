//! The follower of velocities: limits, exact landing, and how far a stop goes.

use leadscrew::setpoint::follower::{Config, Follower};
use leadscrew::setpoint::profile::Limits;
use leadscrew::setpoint::{Setpoint, Turn};
use leadscrew::units::{Acceleration, Jerk, Position, Velocity};
use proptest::prelude::*;

use crate::moves::{format_limits, machine_limits};
use crate::seeded::seeded;

/// Half an LSB of an acceleration, d/tick².
const HALF_LSB: f64 = 0.5 / (1 << 24) as f64;

/// Change of velocity until an acceleration is back at zero: it holds for the tick for which a jerk of zero was
/// announced, and steps of j take up to a tick more than a steady jerk.
fn swing(acceleration: f64, jerk: f64) -> f64 {
    acceleration * (acceleration.abs() / (2.0 * jerk) + 2.0)
}

/// A state within `limits`, by fractions of them: an acceleration that comes back to zero within the velocity limit.
fn state(limits: &Limits, velocity: f64, acceleration: f64) -> Setpoint {
    let top = limits.velocity().to_num::<f64>();
    let jerk = limits.jerk().to_num::<f64>();
    let useful = (2.0 * jerk * top).sqrt().min(top / 4.0);
    let acceleration = limits.acceleration().to_num::<f64>().min(useful) * acceleration;
    let swing = swing(acceleration, jerk);
    let velocity = (top * velocity)
        .max(-top - swing.min(0.0))
        .min(top - swing.max(0.0));
    Setpoint {
        position: Position::from_num(1000),
        velocity: Velocity::from_num(velocity),
        acceleration: Acceleration::from_num(acceleration),
        jerk: Jerk::ZERO,
        turn: Turn::NONE,
    }
}

/// Ticks that a change by `change` d/tick from `acceleration` takes at the most: the way back to zero acceleration,
/// then a ramp up, a hold and a ramp down, with a few ticks of rounding.
fn bound(limits: &Limits, change: f64, acceleration: f64) -> f64 {
    let (a, j) = (
        limits.acceleration().to_num::<f64>(),
        limits.jerk().to_num::<f64>(),
    );
    let change = change.abs() + acceleration * acceleration / (2.0 * j);
    let ramps = if change * j >= a * a {
        change / a + a / j
    } else {
        2.0 * (change / j).sqrt()
    };
    acceleration.abs() / j + ramps + 6.0
}

fn numbers(setpoint: &Setpoint) -> (f64, f64, f64, f64) {
    (
        setpoint.position.to_num(),
        setpoint.velocity.to_num(),
        setpoint.acceleration.to_num(),
        setpoint.jerk.to_num(),
    )
}

/// Steps to `target` and checks every tick; the setpoints.
fn follow(limits: &Limits, start: Setpoint, target: Velocity) -> Vec<Setpoint> {
    let mut follower = Follower::new(Config::new(limits));
    follower.take_over(&start);
    let (_, v0, a0, _) = numbers(&start);
    let longest = bound(limits, target.to_num::<f64>() - v0, a0);
    let mut seen = vec![start];
    while !follower.is_settled(target) {
        let next = follower.step(target);
        let last = *seen.last().unwrap();
        check_tick(limits, &last, &next);
        seen.push(next);
        assert!(
            (seen.len() as f64) < longest + 2.0,
            "{limits:?} {start:?} to {target}: more than {longest} ticks, at {next:?}"
        );
    }
    assert_eq!(follower.step(target).velocity, target);
    assert!(follower.is_settled(target), "it stays");
    seen
}

fn check_tick(limits: &Limits, last: &Setpoint, next: &Setpoint) {
    let (x0, v0, a0, j0) = numbers(last);
    let (x1, v1, a1, _) = numbers(next);
    assert!(
        next.acceleration.abs() <= limits.acceleration().max(last.acceleration.abs()),
        "{limits:?} {last:?} {next:?}"
    );
    assert!(next.jerk.abs() <= limits.jerk(), "{limits:?} {next:?}");
    assert!(
        (a1 - a0).abs() <= limits.jerk().to_num::<f64>() + 2.0 * HALF_LSB,
        "a step in acceleration: {last:?} {next:?}"
    );
    let (v, x) = (1e-6, 2e-5);
    assert!((v1 - v0 - (a0 + j0 / 2.0)).abs() <= v, "{last:?} {next:?}");
    assert!(
        (x1 - x0 - (v0 + a0 / 2.0 + j0 / 6.0)).abs() <= x,
        "{last:?} {next:?}"
    );
}

/// No velocity of the way lies beyond both the target and what the first acceleration makes unavoidable.
fn assert_no_overshoot(limits: &Limits, seen: &[Setpoint], target: Velocity) {
    let (_, v0, a0, _) = numbers(&seen[0]);
    let j = limits.jerk().to_num::<f64>();
    let swing = swing(a0, j);
    let target = target.to_num::<f64>();
    let (low, high) = (
        target.min(v0).min(v0 + swing),
        target.max(v0).max(v0 + swing),
    );
    for setpoint in seen {
        let velocity = setpoint.velocity.to_num::<f64>();
        assert!(
            velocity >= low - 2e-6 && velocity <= high + 2e-6,
            "{velocity} is outside {low} to {high}"
        );
    }
}

fn any_limits() -> impl Strategy<Value = Limits> {
    prop_oneof![machine_limits(), format_limits()].prop_filter(
        "too long to evaluate here",
        |limits| {
            bound(
                limits,
                2.0 * limits.velocity().to_num::<f64>(),
                limits.acceleration().to_num::<f64>(),
            ) < 20_000.0
        },
    )
}

proptest! {
    #![proptest_config(seeded(1500))]

    #[test]
    fn any_velocity_is_reached_exactly_within_limits_and_time(
        limits in any_limits(),
        (from, bend, to) in (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64),
    ) {
        let target = state(&limits, to, 0.0).velocity;
        let seen = follow(&limits, state(&limits, from, bend), target);
        assert_no_overshoot(&limits, &seen, target);
    }

    #[test]
    fn a_stop_stays_within_its_stated_distance_which_is_not_much_more(
        limits in any_limits(),
        (from, bend) in (-1.0..1.0_f64, prop_oneof![Just(0.0), -1.0..1.0_f64]),
    ) {
        let start = state(&limits, from, bend);
        let stated = Config::new(&limits).stopping_distance(&start).to_num::<f64>();
        let seen = follow(&limits, start, Velocity::ZERO);
        let gone = (seen.last().unwrap().position - start.position).to_num::<f64>();
        let (_, v0, a0, _) = numbers(&start);
        let end = v0 + a0 * (a0.abs() / (2.0 * limits.jerk().to_num::<f64>()) + 1.0);
        let spare = if end < 0.0 { gone - stated } else { stated - gone };
        prop_assert!(spare >= 0.0, "{} beyond {}", gone, stated);
        let (a, v) = (limits.acceleration().to_num::<f64>(), limits.velocity().to_num::<f64>());
        prop_assert!(
            spare <= 3.0 + 2.0 * a + 2e-3 * v + 2e-4 * gone.abs(),
            "{} for {}: {:?}", stated, gone, limits
        );
    }

    #[test]
    fn a_target_that_changes_at_any_tick_is_followed_within_limits(
        limits in any_limits(),
        targets in prop::collection::vec((-1.0..1.0_f64, 1..40_u32), 1..60),
    ) {
        let mut follower = Follower::new(Config::new(&limits));
        let mut last = follower.step(Velocity::ZERO);
        for (target, ticks) in targets {
            let target = state(&limits, target, 0.0).velocity;
            for _ in 0..ticks {
                let next = follower.step(target);
                check_tick(&limits, &last, &next);
                last = next;
            }
        }
        follow(&limits, last, Velocity::ZERO);
    }

    #[test]
    fn the_jerk_that_was_announced_is_kept_by_who_takes_over(
        limits in any_limits(),
        (from, bend, ticks) in (-1.0..1.0_f64, -0.9..0.9_f64, 1..30_u32),
    ) {
        let mut first = Follower::new(Config::new(&limits));
        first.take_over(&state(&limits, from, bend));
        let mut last = Setpoint::default();
        for _ in 0..ticks {
            last = first.step(limits.velocity());
        }
        let seen = follow(&limits, last, Velocity::ZERO);
        let (_, _, a0, j0) = numbers(&last);
        let (_, _, a1, _) = numbers(&seen[seen.len().min(2) - 1]);
        prop_assert!((a1 - a0 - j0).abs() <= 3.0 * HALF_LSB, "{:?} then {:?}", last, seen[1]);
    }

    #[test]
    fn any_bits_and_limits_neither_panic_nor_leave_the_formats(
        limits in format_limits(),
        bits in any::<(i64, i32, i32, i32)>(),
        targets in prop::collection::vec(any::<i32>(), 1..50),
    ) {
        let start = Setpoint {
            position: Position::from_bits(bits.0),
            velocity: Velocity::from_bits(bits.1),
            acceleration: Acceleration::from_bits(bits.2),
            jerk: Jerk::from_bits(bits.3),
            turn: Turn::NONE,
        };
        let mut follower = Follower::new(Config::new(&limits));
        follower.take_over(&start);
        let _ = follower.stopping_distance(&start);
        let mut sign_of_speed = i64::from(bits.1.signum());
        for target in targets {
            let next = follower.step(Velocity::from_bits(target));
            let sign = i64::from(next.velocity.to_bits().signum());
            prop_assert!(next.velocity.abs() <= 2047, "{:?}", next);
            // No wrap from one end of the format to the other.
            prop_assert!(sign * sign_of_speed >= 0 || next.velocity.abs() < 300, "{:?}", next);
            sign_of_speed = sign;
            let _ = follower.stopping_distance(&next);
        }
    }
}

#[test]
fn an_acceleration_beyond_the_limits_comes_back_by_their_jerk() {
    let limits = Limits::new(100.0, 1.0, 0.25).unwrap();
    let mut follower = Follower::new(Config::new(&limits));
    follower.take_over(&Setpoint {
        acceleration: Acceleration::from_num(3),
        ..Setpoint::default()
    });
    let accelerations: Vec<f64> = (0..12)
        .map(|_| follower.step(Velocity::from_num(90)).acceleration.to_num())
        .collect();
    let way: Vec<f64> = (1..=12)
        .map(|tick| (3.0 - 0.25 * f64::from(tick)).max(1.0))
        .collect();
    assert_eq!(accelerations, way);
}

#[test]
fn at_its_velocity_it_is_still() {
    let limits = Limits::new(100.0, 0.9, 0.07).unwrap();
    let mut follower = Follower::new(Config::new(&limits));
    let target = Velocity::from_bits(12_345_677);
    while !follower.is_settled(target) {
        follower.step(target);
    }
    let mut last = follower.step(target);
    for _ in 0..1000 {
        let next = follower.step(target);
        assert_eq!(
            (next.velocity, next.acceleration, next.jerk),
            (target, Acceleration::ZERO, Jerk::ZERO)
        );
        let moved = (next.position - last.position).to_num::<f64>() - target.to_num::<f64>();
        assert!(moved.abs() <= 1.6e-5, "{moved}");
        last = next;
    }
}
