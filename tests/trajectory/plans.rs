//! Plans from any state: limits, continuity, exact arrival, duration.

use leadscrew::setpoint::Setpoint;
use leadscrew::setpoint::limits::Limits;
use leadscrew::setpoint::plan::{Plan, State};
use leadscrew::setpoint::trajectory::{QueueError, Trajectory};
use leadscrew::units::Position;
use proptest::prelude::*;

use crate::moves::{distance, format_limits, machine_limits};
use crate::seeded::seeded;

const LONGEST: u32 = 30_000;

fn any_limits() -> impl Strategy<Value = Limits> {
    prop_oneof![machine_limits(), format_limits()]
}

/// The ways and times of a chain of plans: where to, when it is taken over (of its duration), and how fast.
fn legs() -> impl Strategy<Value = Vec<(Position, f64, f64, bool)>> {
    let leg = (distance(), 0.0..1.3_f64, 0.01..1.0_f64, any::<bool>());
    prop::collection::vec(leg, 1..12)
}

fn check_tick(limits: &Limits, fastest: f64, last: &Setpoint, next: &Setpoint) {
    let numbers = |setpoint: &Setpoint| {
        (
            setpoint.position.to_num::<f64>(),
            setpoint.velocity.to_num::<f64>(),
            setpoint.acceleration.to_num::<f64>(),
            setpoint.jerk.to_num::<f64>(),
        )
    };
    let ((x0, v0, a0, j0), (x1, v1, a1, _)) = (numbers(last), numbers(next));
    assert!(v1.abs() <= fastest, "{next:?} beyond {limits:?}");
    assert!(
        next.acceleration.abs() <= limits.acceleration(),
        "{next:?} beyond {limits:?}"
    );
    assert!(
        next.jerk.abs() <= limits.jerk(),
        "{next:?} beyond {limits:?}"
    );
    assert!((a1 - a0 - j0).abs() <= 6.2e-8, "{last:?} {next:?}");
    assert!(
        (v1 - v0 - a0 - j0 / 2.0).abs() <= 1.1e-6,
        "{last:?} {next:?}"
    );
    assert!(
        (x1 - x0 - v0 - a0 / 2.0 - j0 / 6.0).abs() <= 1.7e-5,
        "{last:?} {next:?}"
    );
}

proptest! {
    #![proptest_config(seeded(300))]

    #[test]
    fn any_chain_of_plans_taken_over_at_any_tick_keeps_limits_and_arrives_exactly(
        limits in any_limits(),
        legs in legs(),
    ) {
        let mut trajectory = Trajectory::new();
        let fastest = limits.velocity().to_num::<f64>();
        let mut last = trajectory.step(0);
        let mut now = 0_u32;
        let mut state = State::default();
        let mut target = Position::ZERO;
        for (way, share, speed, halt) in legs {
            let slower = limits.slowed(limits.velocity().saturating_mul_int((speed * 16.0) as i32) / 16);
            target = state.position() + way;
            let plan = if halt { Plan::stop(state, &slower) } else { Plan::to(state, target, &slower) };
            let Ok(plan) = plan else { return Ok(()) };
            if halt {
                target = plan.end().position();
            }
            if plan.ticks() > LONGEST {
                return Ok(());
            }
            trajectory.queue(&plan, now + 1, now).unwrap();
            let ticks = (f64::from(plan.ticks()) * share) as u32;
            for ahead in 0..=ticks {
                let next = trajectory.step(now + 1 + ahead);
                check_tick(&limits, fastest, &last, &next);
                last = next;
            }
            now += 1 + ticks;
            // The next one starts a tick later.
            state = plan.state_at(ticks + 1);
            prop_assert_eq!(plan.state_at(ticks).position(), last.position);
        }
        prop_assert_eq!(trajectory.dropped(), 0);
        let plan = Plan::to(state, target, &limits).unwrap();
        trajectory.queue(&plan, now + 1, now).unwrap();
        if plan.ticks() > LONGEST {
            return Ok(());
        }
        for ahead in 0..=plan.ticks() {
            let next = trajectory.step(now + 1 + ahead);
            check_tick(&limits, fastest, &last, &next);
            last = next;
        }
        prop_assert_eq!(last, Setpoint { position: target, ..Setpoint::default() });
        prop_assert!(!trajectory.is_moving());
    }

    #[test]
    fn any_state_and_limits_are_planned_or_refused_without_a_panic(
        limits in format_limits(),
        bits in any::<(i64, i32, i32, i64)>(),
    ) {
        let start = State::new(
            Position::from_bits(bits.0 >> 8),
            leadscrew::units::Velocity::from_bits(bits.1),
            leadscrew::units::Acceleration::from_bits(bits.2),
        );
        let target = Position::from_bits(bits.3 >> 8);
        for target in [target, start.position(), Position::from_bits(bits.0)] {
            if let Ok(plan) = Plan::to(start, target, &limits) {
                prop_assert_eq!(plan.end(), State::at_rest(target));
                prop_assert_eq!(plan.state_at(0), start);
                prop_assert_eq!(plan.state_at(u32::MAX), plan.end());
            }
        }
        let _ = Plan::stop(start, &limits);
    }
}

#[test]
fn a_plan_from_another_state_is_dropped_and_counted_and_the_old_one_goes_on() {
    let limits = Limits::new(10.0, 1.0, 0.2).unwrap();
    let first = Plan::plan(Position::from_num(500), &limits).unwrap();
    let mut trajectory = Trajectory::new();
    trajectory.queue(&first, 1, 0).unwrap();
    for tick in 1..=30 {
        trajectory.step(tick);
    }
    // Made for tick 33, queued for 34.
    let late = Plan::to(first.state_at(32), Position::ZERO, &limits).unwrap();
    trajectory.queue(&late, 34, 30).unwrap();
    assert_eq!(trajectory.queue(&late, 35, 30), Err(QueueError::Busy));
    let mut last = Setpoint::default();
    for tick in 31..=1 + first.ticks() {
        last = trajectory.step(tick);
    }
    assert_eq!(trajectory.dropped(), 1);
    assert_eq!(last.position, Position::from_num(500));
}
