//! A controlled stop and a hold, ordered by a permit.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::Reference;
use leadscrew::params::AxisParams;
use leadscrew::setpoint::Setpoint;
use leadscrew::setpoint::profile::{Limits, Profile};
use leadscrew::setpoint::sources::Sources;
use leadscrew::supervisor::Permit;
use leadscrew::units::{Position, Velocity};

fn limits() -> Limits {
    Limits::new(50.0, 0.9, 0.1).unwrap()
}

/// Sources in a move of 10 000 d, `ticks` after its start.
fn moving(ticks: u32) -> (Sources, Setpoint) {
    let estimator = EstimatorConfig::by_name("simple").unwrap().unwrap();
    let config = AxisParams::new(estimator).validate().unwrap();
    let mut sources = Sources::new(&limits(), &config.sources);
    sources.hold(Position::from_num(5));
    let profile = Profile::plan(Position::from_num(10_000), &limits()).unwrap();
    sources.trajectory.queue(&profile, 0, u32::MAX).unwrap();
    let mut last = Setpoint::default();
    for tick in 0..=ticks {
        last = sources.step(tick, &Reference::default(), Permit::Follow);
    }
    assert!(sources.is_moving());
    (sources, last)
}

#[test]
fn a_stop_decelerates_within_two_ticks_of_the_order_stands_and_lets_the_next_move_begin() {
    for ordered in [3, 9, 30, 100, 200] {
        let (mut sources, before) = moving(ordered);
        let mut tick = ordered;
        let mut order = |sources: &mut Sources, permit| {
            tick += 1;
            sources.step(tick, &Reference::default(), permit)
        };
        let first = order(&mut sources, Permit::Stop);
        let second = order(&mut sources, Permit::Stop);
        let third = order(&mut sources, Permit::Stop);
        assert!(first.jerk <= before.jerk && first.jerk < 0 || before.acceleration < 0);
        assert!(second.acceleration < first.acceleration || before.acceleration < 0);
        assert!(third.acceleration < first.acceleration || before.acceleration < 0);
        let mut last = third;
        let mut ticks = 0;
        while sources.is_moving() {
            // An order to follow does not take a stop back.
            let permit = if ticks % 2 == 0 {
                Permit::Stop
            } else {
                Permit::Follow
            };
            last = order(&mut sources, permit);
            ticks += 1;
            assert!(ticks < 200, "{last:?}");
        }
        assert_eq!(last.velocity, Velocity::ZERO);
        let place = last.position;
        assert_eq!(order(&mut sources, Permit::Stop).position, place);
        assert_eq!(order(&mut sources, Permit::Follow).position, place);
        assert!(!sources.is_stopping() && !sources.is_moving());

        let profile = Profile::plan(Position::from_num(-40), &limits()).unwrap();
        let now = ordered + 5 + ticks;
        sources.trajectory.queue(&profile, now + 1, now).unwrap();
        let mut last = Setpoint::default();
        for tick in now + 1..=now + 1 + profile.ticks() {
            last = sources.step(tick, &Reference::default(), Permit::Follow);
        }
        assert_eq!(last.position, place - Position::from_num(40));
    }
}

#[test]
fn a_hold_stands_at_once_and_drops_the_move() {
    let (mut sources, before) = moving(60);
    for (tick, permit) in (61..).zip([Permit::Hold, Permit::Hold, Permit::Follow, Permit::Follow]) {
        let setpoint = sources.step(tick, &Reference::default(), permit);
        let standing = Setpoint {
            position: before.position,
            ..Setpoint::default()
        };
        assert_eq!(setpoint, standing);
        assert!(!sources.is_moving());
    }
}
