//! Every refusal that a tool can bring about, and the numbers.

use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::request::Request;
use leadscrew::supervisor::Fault;

use crate::rig::{Rig, Said};

#[test]
fn numbers_are_in_order_without_a_gap_and_each_says_what_to_do() {
    for (number, &refusal) in (1..).zip(Refusal::ALL) {
        assert_eq!(refusal as u16, number);
        assert_eq!(Refusal::from_number(number), Some(refusal));
        for text in [refusal.what(), refusal.remedy()] {
            assert!(
                text.ends_with('.') && text.trim() == text,
                "{refusal:?}: {text:?}"
            );
        }
    }
    assert_eq!(Refusal::from_number(0), None);
    assert_eq!(Refusal::from_number(u16::MAX), None);
}

#[test]
fn without_a_session_or_a_lease_nothing_is_done() {
    let mut rig = Rig::new();
    rig.refused(&Request::Status {}, Refusal::NoSession);
    rig.hello();
    let motions = [
        Request::Enable {},
        Request::Home {},
        Rig::move_to(1),
        Request::Jog { feed_um_per_min: 1 },
        Request::Resume {},
        Request::Override { percent: 10 },
        Request::ClearFault {},
        Request::ClearWarnings {},
        Request::ReleaseLease {},
        Request::RenewLease { seen: 0 },
        Request::SetParameter {
            name: "output.limit",
            value: 0.5,
        },
    ];
    for request in &motions {
        rig.refused(request, Refusal::LeaseRequired);
    }
    assert_eq!((rig.way.motions, rig.way.enables), (0, 0));
    rig.do_(&Request::Stop {});
    rig.do_(&Request::Disable {});
    rig.refused(&Request::Hold {}, Refusal::NotEnabled);
}

#[test]
fn orders_that_the_axis_cannot_follow_are_refused_and_it_goes_on() {
    let mut rig = Rig::new();
    rig.hello();
    rig.do_(&Request::TakeLease {});
    rig.renew_every = Some(30);
    rig.refused(&Rig::move_to(1), Refusal::NotEnabled);
    rig.refused(&Request::Home {}, Refusal::NotReady);
    rig.enabled();
    let with_feed = |feed_um_per_min| Request::Move {
        target_nm: 1_000_000,
        feed_um_per_min,
    };
    for (request, refusal) in [
        (with_feed(0), Refusal::FeedOutOfRange),
        (with_feed(9_000_001), Refusal::FeedOutOfRange),
        (with_feed(u32::MAX), Refusal::FeedOutOfRange),
        (
            Request::Jog {
                feed_um_per_min: i32::MIN,
            },
            Refusal::FeedOutOfRange,
        ),
        (
            Request::Move {
                target_nm: i64::MIN,
                feed_um_per_min: 1,
            },
            Refusal::TargetOutOfRange,
        ),
        (
            Request::Move {
                target_nm: 1_000_000_000_001,
                feed_um_per_min: 1,
            },
            Refusal::TargetOutOfRange,
        ),
        (
            Request::Move {
                target_nm: 900_000_000_000,
                feed_um_per_min: 1,
            },
            Refusal::MoveTooLong,
        ),
        (
            Request::Override { percent: 201 },
            Refusal::OverrideOutOfRange,
        ),
        (
            Request::SetParameter {
                name: "output.limit",
                value: 0.5,
            },
            Refusal::AxisOn,
        ),
    ] {
        rig.refused(&request, refusal);
    }
    assert_eq!(rig.way.motions, 0);
    rig.do_(&with_feed(9_000_000));
    rig.run(200);
    assert_eq!(rig.way.motions, 1);

    rig.way.axis.supervisor_mut().report(Fault::SoftLimit);
    rig.run(500);
    rig.refused(&Rig::move_to(1), Refusal::FaultLatched);
    rig.refused(&Request::Enable {}, Refusal::FaultLatched);
    rig.refused(&Request::ClearFault {}, Refusal::EnableRequested);
    rig.do_(&Request::Disable {});
    rig.step();
    rig.do_(&Request::ClearFault {});
    rig.enabled();
}

#[test]
fn a_message_that_is_not_known_is_refused_once_and_its_session_goes_on() {
    use leadscrew::protocol::frame::{Channel, FrameBuffer, Header};
    let mut rig = Rig::new();
    rig.hello();
    let header = Header {
        channel: Channel::Request,
        session: rig.client.session(),
        sequence: rig.client.sequence() + 1,
    };
    // A number of a later version; one that is known, with a byte too many; one cut off; nothing.
    for (step, body) in [&[200][..], &[1, 0], &[11, 2], &[]].into_iter().enumerate() {
        let header = Header {
            sequence: header.sequence + step as u16,
            ..header
        };
        let mut frame = FrameBuffer::default();
        rig.to_axis
            .extend_from_slice(frame.raw(header, body).unwrap());
        rig.step();
        let last = rig.heard.last().unwrap();
        assert_eq!(
            *last,
            (header.sequence, Said::Refused(Refusal::NotUnderstood))
        );
    }
    assert_eq!(rig.service.dropped().unknown, 4);
    (0..4).for_each(|_| _ = rig.client.request(&Request::Status {}));
    assert!(matches!(rig.ask(&Request::Status {}), Said::Status { .. }));
}
