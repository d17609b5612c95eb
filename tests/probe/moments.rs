//! Wrong moments are results, and what cannot be probed is refused.

use leadscrew::probe::{ProbeEnd, ProbeOrder, ProbeParams, ProbeRefused, Stage};
use leadscrew::setpoint::travel::TravelLimits;
use leadscrew::units::{Position, Velocity};

use crate::follower::Follower;

#[test]
fn wrong_moments_are_results() {
    // No touch.
    let mut follower = Follower::new(ProbeParams::default());
    follower.probe(300.0, 0.0).unwrap();
    follower.finish();
    assert_eq!(follower.end(), Some(ProbeEnd::NoTouch));
    assert!(
        (follower.position - 300.0).abs() < 5.0,
        "{}",
        follower.position
    );
    assert_eq!(follower.axis.probe().report().touch, None);

    // Already touching: nothing moves.
    let mut follower = Follower::new(ProbeParams::default());
    let before = follower.position;
    follower.touching = true;
    follower.probe(300.0, 0.0).unwrap();
    follower.finish();
    assert_eq!(follower.end(), Some(ProbeEnd::AlreadyTouching));
    assert_eq!(follower.position, before);
    follower.run(50);
    assert_eq!(
        follower.end(),
        Some(ProbeEnd::AlreadyTouching),
        "no touch either"
    );

    // Again on the way back.
    let mut follower = Follower::new(ProbeParams::default());
    follower.probe(3000.0, 500.0).unwrap();
    follower.run(400);
    follower.touch();
    follower.touching = true;
    follower.reach(Stage::Retract);
    follower.run(30);
    follower.touching = false;
    follower.run(10);
    follower.touch();
    follower.touching = true;
    follower.finish();
    assert_eq!(follower.end(), Some(ProbeEnd::TouchedOnRetract));
    assert!(follower.axis.probe().report().touch.is_some());

    // It stays deflected.
    let mut follower = Follower::new(ProbeParams::default());
    follower.probe(3000.0, 20.0).unwrap();
    follower.run(400);
    follower.touch();
    follower.touching = true;
    follower.finish();
    assert_eq!(follower.end(), Some(ProbeEnd::StillTouching));

    // The axis is disabled, or its encoder lost.
    for (lost, end) in [
        (false, ProbeEnd::Interrupted),
        (true, ProbeEnd::EncoderLost),
    ] {
        let mut follower = Follower::new(ProbeParams::default());
        follower.probe(3000.0, 20.0).unwrap();
        follower.run(400);
        follower.lines.encoder_lost = lost;
        follower.enable = lost;
        follower.finish();
        assert_eq!(follower.end(), Some(end));
    }
}

#[test]
fn a_touch_that_nobody_sought_is_told_and_stops_the_axis_where_it_shall() {
    for stops in [false, true] {
        let mut follower = Follower::new(ProbeParams {
            stop_on_touch: f64::from(u8::from(stops)),
            ..ProbeParams::default()
        });
        let limits = follower.axis.config().limits;
        let tick = follower.outputs.tick;
        let mut planner = leadscrew::setpoint::planner::Planner::new(
            limits,
            follower.axis.commanded().position,
            tick,
        );
        let planned = planner.move_to(
            Position::from_num(20_000),
            Velocity::from_num(10),
            tick + 10,
        );
        let timed = planned.unwrap().unwrap();
        follower.axis.queue(&timed.plan, timed.start).unwrap();
        follower.run(500);
        let place = follower.touch();
        follower.touching = true;
        follower.run(3000);
        let report = *follower.axis.probe().report();
        assert_eq!((report.end, report.touches), (Some(ProbeEnd::Unasked), 1));
        let touch = report.touch.unwrap();
        let raw: f64 = touch.raw.to_num();
        assert!((raw - place).abs() <= 1.0, "{raw} {place}");
        if stops {
            let beyond = follower.position - place;
            assert!((0.0..=500.0).contains(&beyond), "{beyond}");
            assert!(!follower.outputs.moving);
        } else {
            assert!(
                (follower.position - 20_000.0).abs() < 1.0,
                "{} {:?}",
                follower.position,
                follower.outputs
            );
        }
    }
}

#[test]
fn what_cannot_be_probed_is_refused_with_its_figures() {
    let mut follower = Follower::new(ProbeParams::default());
    let order = |target: f64, feed: f64| ProbeOrder {
        target: Position::from_num(target),
        feed: Velocity::from_num(feed),
        retract: Position::from_num(100),
    };
    let here = follower.position;
    let mut ask = |order| follower.axis.probe_towards(&order);
    assert_eq!(ask(order(here, 1.0)), Err(ProbeRefused::NoWay));
    assert_eq!(ask(order(500.0, 0.0)), Err(ProbeRefused::FeedOutOfRange));
    assert_eq!(ask(order(500.0, 1000.0)), Err(ProbeRefused::FeedOutOfRange));
    let refused = ask(order(500.0, 50.0)).unwrap_err();
    assert!(
        matches!(refused, ProbeRefused::Overtravel { bound, allowed: 1000 } if bound > 1000),
        "{refused}"
    );
    let travel = |low, high| TravelLimits::new(Position::from_num(low), Position::from_num(high));
    follower.axis.set_travel(Some(travel(-1000, 520).unwrap()));
    let mut ask = |order| follower.axis.probe_towards(&order);
    assert_eq!(ask(order(500.0, 1.67)), Err(ProbeRefused::BeyondTravel));
    follower.axis.set_travel(Some(travel(-50, 1000).unwrap()));
    let mut ask = |order| follower.axis.probe_towards(&order);
    assert_eq!(ask(order(500.0, 1.67)), Err(ProbeRefused::BeyondTravel));
    follower.axis.set_travel(None);
    assert!(follower.probe(500.0, 0.0).is_ok());
    follower.step();
    assert_eq!(follower.probe(500.0, 0.0), Err(ProbeRefused::Moving));
    follower.enable = false;
    follower.run(500);
    assert_eq!(follower.probe(500.0, 0.0), Err(ProbeRefused::NotReady));
}
