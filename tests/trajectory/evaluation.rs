//! Every tick of a move: within limits, consistent, monotone, and at the target in the end.

use leadscrew::setpoint::profile::Limits;
use leadscrew::setpoint::trajectory::Trajectory;
use leadscrew::setpoint::{Setpoint, Turn};
use leadscrew::units::{Acceleration, Jerk, Position, Velocity};
use proptest::prelude::*;

use crate::moves::{Move, move_within, run};
use crate::seeded::seeded;

/// Moves longer than this are left to the planner's tests: some milliseconds each.
const LONGEST: u32 = 100_000;

/// Velocity that carries the last rest of the distance, as the planner states it, d/tick.
const CREEP: f64 = 5e-7;

fn lsb<F: fixed::traits::Fixed>() -> f64 {
    F::DELTA.to_num()
}

fn numbers(setpoint: &Setpoint) -> (f64, f64, f64, f64) {
    let Setpoint {
        position,
        velocity,
        acceleration,
        jerk,
        ..
    } = *setpoint;
    (
        position.to_num(),
        velocity.to_num(),
        acceleration.to_num(),
        jerk.to_num(),
    )
}

/// The setpoints of a move from 0.
fn setpoints(planned: &Move) -> Vec<Setpoint> {
    let mut seen = Vec::new();
    run(&mut Trajectory::new(), &planned.profile, 0, |setpoint| {
        seen.push(setpoint);
    });
    seen
}

fn assert_within(limits: &Limits, setpoint: &Setpoint) {
    assert!(
        setpoint.velocity.abs() <= limits.velocity(),
        "{setpoint:?} beyond {limits:?}"
    );
    assert!(
        setpoint.acceleration.abs() <= limits.acceleration(),
        "{setpoint:?} beyond {limits:?}"
    );
    assert!(
        setpoint.jerk.abs() <= limits.jerk(),
        "{setpoint:?} beyond {limits:?}"
    );
}

/// Largest change of the acceleration between two phases of a move: twice the step of 6·T₁ units of
/// 2⁻⁴⁸ d/tick² that carries the rounding rest of the jerk. The jerk takes at most a quarter of the move.
fn acceleration_step(planned: &Move) -> f64 {
    3.0 * f64::from(planned.profile.ticks()) * 0.5_f64.powi(48)
}

/// The cubic of a tick, from one setpoint to the next, within the rounding of the outputs: half an LSB
/// of each quantity that takes part.
fn assert_consistent(planned: &Move, from: &Setpoint, to: &Setpoint) {
    let (x0, v0, a0, j0) = numbers(from);
    let (x1, v1, a1, _) = numbers(to);
    let (x, v, a, j) = (
        lsb::<Position>(),
        lsb::<Velocity>(),
        lsb::<Acceleration>(),
        lsb::<Jerk>(),
    );
    let moved = (x1 - x0 - (v0 + a0 / 2.0 + j0 / 6.0)).abs();
    assert!(
        moved <= x + v / 2.0 + a / 4.0 + j / 12.0 + CREEP,
        "position: {from:?} to {to:?}"
    );
    let gained = (v1 - v0 - (a0 + j0 / 2.0)).abs();
    assert!(
        gained <= v + a / 2.0 + j / 4.0,
        "velocity: {from:?} to {to:?}"
    );
    let bent = (a1 - a0 - j0).abs();
    assert!(
        bent <= a + j / 2.0 + acceleration_step(planned),
        "acceleration: {from:?} to {to:?}"
    );
}

/// What is announced of the jerk comes to pass, and no change of it comes unannounced.
fn assert_announced(setpoints: &[Setpoint]) {
    let horizon = Turn::HORIZON as usize;
    for (at, setpoint) in setpoints.iter().enumerate() {
        let following = setpoints[at..].iter().take(horizon + 1);
        let until_change = following
            .take_while(|next| next.jerk == setpoint.jerk)
            .count();
        let turn = setpoint.turn;
        if turn.ticks as usize <= horizon {
            let ticks = turn.ticks as usize;
            // Two segments of a plan may have the same jerk.
            assert!(ticks <= until_change, "tick {at}: {turn:?}");
            if let Some(turned) = setpoints.get(at + ticks) {
                assert_eq!(turned.jerk, turn.jerk, "tick {at}");
            }
        } else {
            let left = setpoints.len() - at;
            assert!(until_change >= horizon.min(left), "tick {at}: {turn:?}");
        }
    }
}

fn assert_arrived(setpoint: &Setpoint, target: Position) {
    let arrived = Setpoint {
        position: target,
        ..Setpoint::default()
    };
    assert_eq!(*setpoint, arrived);
}

/// Distance less the sum of the mean velocities of all ticks, per tick.
fn unexplained_velocity(planned: &Move, setpoints: &[Setpoint]) -> f64 {
    let travelled: f64 = setpoints
        .iter()
        .map(numbers)
        .map(|(_, v, a, j)| v + a / 2.0 + j / 6.0)
        .sum();
    (planned.distance.to_num::<f64>() - travelled).abs() / f64::from(planned.profile.ticks())
}

proptest! {
    #![proptest_config(seeded(400))]

    #[test]
    fn no_output_of_any_tick_passes_its_limit(planned in move_within(LONGEST)) {
        for setpoint in setpoints(&planned) {
            assert_within(&planned.limits, &setpoint);
        }
    }

    #[test]
    fn the_last_setpoint_is_the_target_at_rest_after_the_planned_duration(planned in move_within(LONGEST)) {
        let mut trajectory = Trajectory::new();
        let mut last = Setpoint::default();
        run(&mut trajectory, &planned.profile, 7, |setpoint| last = setpoint);
        assert_arrived(&last, planned.distance);
        assert!(!trajectory.is_moving());

        // A tick earlier it still moves.
        let mut trajectory = Trajectory::new();
        trajectory.queue(&planned.profile, 0, u32::MAX).unwrap();
        for tick in 0..planned.profile.ticks() {
            trajectory.step(tick);
            prop_assert!(trajectory.is_moving());
        }
    }

    #[test]
    fn position_velocity_and_acceleration_belong_together(planned in move_within(LONGEST)) {
        let seen = setpoints(&planned);
        for pair in seen.windows(2) {
            assert_consistent(&planned, &pair[0], &pair[1]);
        }
        // Summed up over the move the rounding of the positions cancels and only that of a mean velocity is left.
        let rounding = lsb::<Velocity>() / 2.0 + lsb::<Acceleration>() / 4.0 + lsb::<Jerk>() / 12.0;
        let unexplained = unexplained_velocity(&planned, &seen);
        prop_assert!(unexplained <= rounding + CREEP, "{} d/tick", unexplained);
    }

    #[test]
    fn changes_of_the_jerk_are_announced(planned in move_within(LONGEST)) {
        assert_announced(&setpoints(&planned));
    }

    #[test]
    fn a_move_never_turns_back(planned in move_within(LONGEST)) {
        let forward = planned.distance > 0;
        for pair in setpoints(&planned).windows(2) {
            let (step, velocity) = (pair[1].position - pair[0].position, pair[1].velocity);
            let onward = if forward { step >= 0 && velocity >= 0 } else { step <= 0 && velocity <= 0 };
            prop_assert!(onward, "{} then {}", step, velocity);
        }
    }

    #[test]
    fn a_chain_of_moves_that_add_up_to_nothing_ends_where_it_began(
        start in any::<i32>(),
        chain in prop::collection::vec(move_within(1000), 1..60),
    ) {
        let start = Position::from_bits(i64::from(start) << 12);
        let mut trajectory = Trajectory::new();
        trajectory.hold(start);
        let (mut tick, mut total) = (0_u32, Position::ZERO);
        let there = chain.iter().map(|planned| (planned.distance, planned.limits));
        let back = chain.iter().rev().map(|planned| (-planned.distance, planned.limits));
        for (distance, limits) in there.chain(back) {
            let planned = Move::plan(distance, limits).unwrap();
            let mut last = Setpoint::default();
            run(&mut trajectory, &planned.profile, tick, |setpoint| last = setpoint);
            total += distance;
            assert_arrived(&last, start + total);
            tick = tick.wrapping_add(planned.profile.ticks() + 1);
        }
        prop_assert_eq!(total, Position::ZERO);
    }
}

/// `moves` random short moves in a row, each of which has to end exactly where the sum of all says.
fn assert_no_drift(moves: u32) {
    let limits = Limits::new(3.7, 0.9, 0.31).unwrap();
    let mut trajectory = Trajectory::new();
    // The tick number wraps on the way.
    let (mut tick, mut total, mut draw) = (u32::MAX - 1_000_000, 0_i64, 1_u64);
    for _ in 0..moves {
        // Knuth's generator: ±4 d on the grid of the positions.
        draw = draw
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let distance = (draw >> 45).cast_signed() - (1 << 18);
        let profile = Move::plan(Position::from_bits(distance), limits)
            .unwrap()
            .profile;
        let mut last = Setpoint::default();
        run(&mut trajectory, &profile, tick, |setpoint| last = setpoint);
        total += distance;
        assert_arrived(&last, Position::from_bits(total));
        tick = tick.wrapping_add(profile.ticks() + 1);
    }
}

#[test]
fn a_million_moves_do_not_drift() {
    assert_no_drift(1_000_000);
}

#[test]
#[ignore = "long: cargo xtask test --long"]
fn fifty_million_moves_do_not_drift() {
    assert_no_drift(50_000_000);
}

#[test]
fn a_metre_at_35_khz_keeps_every_rule_to_the_exact_end() {
    // d/tick, d/tick², d/tick³ and d: the lathe (1 000 d/mm, 9 m/min, 0.9 m/s², 10 m/s³) and a machine to come
    // (100 000 d/mm, 40 m/min, 1 g, 5 000 m/s³).
    let lathe = (4.2857, 7.3469e-4, 2.3324e-7, 1_000_000);
    let machine_to_come = (1904.7, 0.8008, 1.1662e-2, 100_000_000);
    for (velocity, acceleration, jerk, metre) in [lathe, machine_to_come] {
        let limits = Limits::new(velocity, acceleration, jerk).unwrap();
        let planned = Move::plan(Position::from_num(-metre), limits).unwrap();
        let seen = setpoints(&planned);
        assert_eq!(seen.len(), planned.profile.ticks() as usize + 1);
        for pair in seen.windows(2) {
            assert_within(&limits, &pair[1]);
            assert_consistent(&planned, &pair[0], &pair[1]);
        }
        let top = seen
            .iter()
            .map(|setpoint| setpoint.velocity.abs())
            .max()
            .unwrap();
        assert!(
            top.to_num::<f64>() > 0.999 * velocity,
            "it cruises at the limit: {top}"
        );
        assert_arrived(seen.last().unwrap(), planned.distance);
    }
}

#[test]
fn the_rounding_rest_of_the_slowest_ramps_creeps_below_its_bound() {
    // The smallest jerk of the format and limits that it reaches after many thousand ticks: the coarsest
    // quantum of distance, 6·T₁(T₁ + T₂)S units.
    for (velocity, acceleration, distance) in [
        (3.0, 127.0, 1e6),
        (3.0, 2e-5, 1e6),
        (30.0, 1e-4, 5e7),
        (2047.0, 127.0, 2e9),
    ] {
        let limits = Limits::new(velocity, acceleration, 2e-9).unwrap();
        for odd in [1, 12_345, 54_321] {
            let distance = Position::from_num(distance) - Position::from_bits(odd);
            let planned = Move::plan(distance, limits).unwrap();
            let (mut last, mut travelled) = (Setpoint::default(), 0.0);
            run(&mut Trajectory::new(), &planned.profile, 0, |setpoint| {
                assert_within(&limits, &setpoint);
                let (_, v, a, j) = numbers(&setpoint);
                travelled += v + a / 2.0 + j / 6.0;
                last = setpoint;
            });
            let creep = (distance.to_num::<f64>() - travelled) / f64::from(planned.profile.ticks());
            // The rounding of the velocities is unbiased here, over a million ticks.
            assert!(
                creep.abs() < CREEP,
                "{velocity} {acceleration} {distance}: {creep:e} d/tick"
            );
            assert_arrived(&last, distance);
        }
    }
}
