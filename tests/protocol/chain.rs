//! The whole chain, from a tool's requests over bytes to the axis on its machine and back.

use leadscrew::protocol::client::{Answer, Client};
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::{ENABLED, HELD, LEASED, LEASED_HERE, MOVING, PLANNED, Reply};
use leadscrew::protocol::request::Request;
use leadscrew::protocol::service::Seen;
use leadscrew::supervisor::State;

use crate::rig::{IDENTITY, Rig, Said};

#[test]
fn a_hello_tells_what_the_axis_is() {
    let mut rig = Rig::new();
    rig.run(5);
    let mut client = Client::new();
    let hello = Request::Hello {
        protocol: 1,
        nonce: 77,
    };
    let bytes = client.request(&hello).unwrap().to_vec();
    let seen = Seen::of(&rig.way.axis);
    let mut answer = Vec::new();
    rig.service
        .receive(&bytes, &seen, &mut rig.way, &mut |frame| {
            answer.extend_from_slice(frame);
        });
    let mut heard = 0;
    client.receive(&answer, |answer| {
        let Answer::Reply(
            1,
            Reply::Hello {
                protocol,
                nonce,
                session,
                tick_hz,
                lease_ticks,
                tick,
                capabilities,
                work_memory,
                firmware,
                build,
                board,
            },
        ) = answer
        else {
            panic!("{answer:?}");
        };
        assert_eq!(
            (protocol, nonce, tick_hz, lease_ticks, tick),
            (1, 77, 1000, 100, 4)
        );
        assert_eq!(
            (capabilities, work_memory),
            (IDENTITY.capabilities, IDENTITY.work_memory)
        );
        assert_eq!(
            (firmware, build, board),
            (IDENTITY.firmware, IDENTITY.build, IDENTITY.board)
        );
        assert_ne!(session, 0);
        heard += 1;
    });
    assert_eq!(heard, 1);
}

#[test]
fn the_axis_is_enabled_moved_and_asked_over_the_line() {
    let mut rig = Rig::new();
    rig.ready();
    rig.do_(&Rig::move_to(20));
    rig.run(150);
    let Said::Status {
        flags,
        state,
        position_nm,
        ..
    } = rig.ask(&Request::Status {})
    else {
        panic!()
    };
    assert_eq!(flags, ENABLED | MOVING | LEASED | LEASED_HERE | PLANNED);
    assert_eq!(state, State::Moving as u8);
    assert!(
        (1_000_000..19_000_000).contains(&position_nm),
        "{position_nm}"
    );
    rig.run(700);
    let Said::Status {
        flags,
        state,
        position_nm,
        setpoint_nm,
    } = rig.ask(&Request::Status {})
    else {
        panic!()
    };
    assert_eq!((flags & MOVING, state), (0, State::Ready as u8));
    assert_eq!(setpoint_nm, 20_000_000, "exactly");
    // The loop is not tuned against friction: 60 d, as in the other runs of this machine.
    assert!((position_nm - 20_000_000).abs() < 60_000, "{position_nm}");
    rig.do_(&Request::Disable {});
    rig.run(500);
    assert_eq!(rig.way.axis.outputs().state, State::Disabled);
    assert!(!rig.way.axis.outputs().enabled);
}

#[test]
fn a_motion_is_held_overridden_resumed_turned_and_stopped() {
    let mut rig = Rig::new();
    rig.ready();
    rig.do_(&Rig::move_to(200));
    rig.run(150);
    rig.do_(&Request::Hold {});
    let held = rig.run(300);
    assert_eq!(held.setpoint.velocity.to_bits(), 0);
    let Said::Status { flags, .. } = rig.ask(&Request::Status {}) else {
        panic!()
    };
    assert_eq!(flags & (HELD | MOVING), HELD);
    rig.do_(&Request::Override { percent: 50 });
    rig.run(10);
    rig.do_(&Request::Resume {});
    let slow: f64 = rig.run(300).setpoint.velocity.to_num();
    // A plan cruises for whole ticks, so at most as fast.
    assert!((49.0..=50.0).contains(&slow), "half of 100 d/tick: {slow}");
    rig.do_(&Request::Override { percent: 100 });
    let full: f64 = rig.run(200).setpoint.velocity.to_num();
    assert!((98.0..=100.0).contains(&full), "{full}");
    rig.do_(&Request::Jog {
        feed_um_per_min: -600_000,
    });
    let back: f64 = rig.run(400).setpoint.velocity.to_num();
    assert!((back + 10.0).abs() < 0.01, "{back}");
    rig.do_(&Request::Stop {});
    let end = rig.run(200);
    assert_eq!(
        (end.setpoint.velocity.to_bits(), end.state),
        (0, State::Ready)
    );
    rig.do_(&Request::ReleaseLease {});
    rig.renew_every = None;
    assert_eq!(
        rig.run(300).state,
        State::Ready,
        "given back at rest, it stays enabled"
    );
}

#[test]
fn homing_is_begun_over_the_line_and_a_stop_ends_it_with_the_drive_off() {
    let mut rig = Rig::new();
    rig.ready();
    rig.do_(&Request::Home {});
    rig.run(300);
    assert_eq!(rig.way.axis.outputs().state, State::Moving);
    for request in [
        Rig::move_to(1),
        Request::Hold {},
        Request::Jog { feed_um_per_min: 1 },
    ] {
        rig.refused(&request, Refusal::Busy);
    }
    rig.refused(&Request::ReleaseLease {}, Refusal::StillMoving);
    rig.do_(&Request::Stop {});
    rig.step();
    assert_eq!(rig.way.axis.outputs().state, State::Stopping);
    assert_eq!(rig.run(500).state, State::Disabled);
}

#[test]
fn a_stop_that_comes_before_its_move_has_begun_is_done_as_soon_as_it_has() {
    for stop in [Request::Stop {}, Request::Hold {}] {
        let mut rig = Rig::new();
        rig.ready();
        rig.post(&Rig::move_to(50));
        rig.post(&stop);
        rig.post(&Rig::move_to(-50));
        let from = rig.heard.len();
        rig.step();
        let said: Vec<_> = rig.heard[from..]
            .iter()
            .map(|(_, said)| said.clone())
            .collect();
        assert_eq!(
            said[..3],
            [Said::Ack, Said::Ack, Said::Refused(Refusal::Busy)]
        );
        let end = rig.run(300);
        assert_eq!(end.state, State::Ready, "{stop:?}");
        let way: f64 = end.setpoint.position.to_num();
        assert!((0.0..100.0).contains(&way), "{way} d of 50 000");
        assert_eq!(rig.way.motions, 2);
    }
}
