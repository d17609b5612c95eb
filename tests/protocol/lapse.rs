//! A lease that lapses stops the axis.

use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::request::Request;
use leadscrew::supervisor::State;

use crate::rig::Rig;

/// So far into a long move that it is at its feed.
fn at_speed() -> Rig {
    let mut rig = Rig::new();
    rig.ready();
    rig.do_(&Rig::move_to(300));
    let outputs = rig.run(500);
    assert_eq!(outputs.state, State::Moving);
    let velocity: f64 = outputs.setpoint.velocity.to_num();
    assert!((velocity - 100.0).abs() < 0.01, "{velocity}");
    rig
}

/// Ticks without a stop, then asserts one that is jerk-limited, as short as the limits allow, and ends with the drive off.
#[track_caller]
fn assert_stops_after(rig: &mut Rig, ticks: u32) {
    for tick in 0..ticks {
        let outputs = rig.step();
        assert_eq!(outputs.state, State::Moving, "tick {tick}");
    }
    // The lapse is seen between two ticks; the stop begins in the next.
    let begin = rig.step();
    assert_eq!((begin.state, begin.fault), (State::Stopping, None));
    let limits = rig.way.axis.config().limits;
    let (v, a, j): (f64, f64, f64) = (
        100.0,
        limits.acceleration().to_num(),
        limits.jerk().to_num(),
    );
    // From constant speed: v/a + a/j ticks, v/2 times as long.
    let planned = v / a + a / j;
    let mut taken = 0;
    let mut last = begin.setpoint;
    let way_from = begin.setpoint.position;
    while last.velocity.to_bits() != 0 {
        let next = rig.step().setpoint;
        assert!(next.velocity <= last.velocity, "never faster");
        assert!((last.velocity - next.velocity).to_num::<f64>() <= a * 1.001);
        last = next;
        taken += 1;
        assert!(f64::from(taken) < planned + 3.0, "planned {planned} ticks");
    }
    assert!(
        f64::from(taken) > planned - 5.0,
        "{taken} ticks, planned {planned}"
    );
    let way: f64 = (last.position - way_from).to_num();
    assert!(way < 0.5 * v * planned + 300.0, "{way} d");
    let end = rig.run(500);
    assert_eq!(
        (end.state, end.enabled, end.fault),
        (State::Disabled, false, None)
    );
    assert!(rig.board.machine.truth().shaft.velocity.abs() < 0.05);
}

#[test]
fn a_tool_that_falls_silent_stops_the_axis_within_its_plan() {
    let mut rig = at_speed();
    rig.do_(&Request::RenewLease {
        seen: rig.told_tick,
    });
    rig.renew_every = None;
    assert_stops_after(&mut rig, 100);
    assert_eq!(rig.service.holder(), None);

    // It does not go on by itself, nor by a late renewal.
    let seen = rig.told_tick;
    rig.refused(&Request::RenewLease { seen }, Refusal::LeaseRequired);
    rig.refused(&Rig::move_to(0), Refusal::LeaseRequired);
    rig.refused(&Request::Enable {}, Refusal::LeaseRequired);
    assert_eq!(rig.run(300).state, State::Disabled);
    rig.ready();
    rig.do_(&Rig::move_to(0));
    assert_eq!(rig.run(100).state, State::Moving);
}

#[test]
fn requests_of_a_tool_that_hears_nothing_hold_no_lease() {
    let mut rig = at_speed();
    // It sends renewals for ever, with the tick that it saw last.
    let seen = rig.told_tick;
    let last_good = 99 - (rig.way.axis.outputs().tick - seen);
    rig.renew_every = None;
    let mut stopped = None;
    for tick in 0..400 {
        rig.post(&Request::RenewLease { seen });
        if rig.step().state != State::Moving {
            stopped = Some(tick);
            break;
        }
    }
    // The last one that counts comes 99 ticks after what it tells of; 100 after it the lease lapses, and a tick shows it.
    assert_eq!(stopped, Some(last_good + 100));
}

#[test]
fn another_session_takes_the_lease_only_after_it_has_lapsed() {
    let mut rig = at_speed();
    rig.renew_every = None;
    rig.hello();
    rig.refused(&Request::TakeLease {}, Refusal::LeaseHeld);
    rig.refused(&Rig::move_to(0), Refusal::LeaseRequired);
    rig.run(100);
    assert_eq!(rig.way.axis.outputs().state, State::Stopping);
    rig.do_(&Request::TakeLease {});
}

#[test]
fn a_stop_by_the_lapse_is_asked_for_until_it_is_heard() {
    let mut rig = at_speed();
    rig.renew_every = None;
    rig.way.is_blocked = true;
    assert_eq!(rig.run(150).state, State::Moving, "no way to the axis");
    rig.way.is_blocked = false;
    rig.run(2);
    assert_eq!(rig.way.axis.outputs().state, State::Stopping);
}

#[test]
fn anybody_may_stop_and_a_lease_is_not_given_back_in_motion() {
    let mut rig = at_speed();
    rig.refused(&Request::ReleaseLease {}, Refusal::StillMoving);
    rig.renew_every = None;
    rig.hello();
    rig.do_(&Request::Stop {});
    rig.run(50);
    let velocity: f64 = rig.way.axis.outputs().setpoint.velocity.to_num();
    assert!(velocity < 90.0, "{velocity}");
}

#[test]
fn a_tool_loses_no_lease_while_the_axis_is_off_and_takes_its_time_for_settings() {
    let mut rig = Rig::new();
    rig.ready();
    rig.do_(&Request::Disable {});
    rig.run(500);
    rig.renew_every = None;
    rig.do_(&Request::SetParameter {
        name: "motion.max_feed_mm_per_min",
        value: 5000.0,
    });
    // As long as the observer takes on a board without double precision.
    rig.run(2000);
    rig.do_(&Request::EditParameters {});
    // From the next request on it counts as ever.
    rig.run(101);
    rig.refused(&Request::DropParameters {}, Refusal::LeaseRequired);
}

#[test]
fn time_that_the_service_did_not_look_at_counts_in_motion_only() {
    let mut rig = Rig::new();
    rig.ready();
    rig.renew_every = None;
    rig.is_busy = true;
    rig.run(1660);
    rig.is_busy = false;
    assert_eq!(rig.run(50).state, State::Ready);
    rig.run(60);
    assert_ne!(
        rig.way.axis.outputs().state,
        State::Ready,
        "from then on it counts"
    );

    let mut rig = at_speed();
    rig.renew_every = None;
    rig.is_busy = true;
    rig.run(101);
    rig.is_busy = false;
    rig.run(3);
    assert_eq!(rig.way.axis.outputs().state, State::Stopping);
}
