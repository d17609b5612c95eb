//! What a bad line does to requests of motion: nothing that was not asked, nothing twice.

use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::request::Request;
use leadscrew::supervisor::State;
use proptest::prelude::*;

use crate::rig::{Rig, Said};
use crate::seeded::seeded;

/// What becomes of a frame on its way.
#[derive(Clone, Copy, Debug)]
enum Fate {
    Arrives,
    Lost,
    Torn(prop::sample::Index),
    Flipped(prop::sample::Index),
    Doubled,
    /// It comes after the next one.
    Late,
}

fn fate() -> impl Strategy<Value = Fate> {
    let at = any::<prop::sample::Index>;
    prop_oneof![
        2 => Just(Fate::Arrives),
        1 => Just(Fate::Lost),
        1 => at().prop_map(Fate::Torn),
        2 => at().prop_map(Fate::Flipped),
        1 => Just(Fate::Doubled),
        1 => Just(Fate::Late),
    ]
}

/// The line as it arrives, a zero before each frame as after a pause.
fn line(frames: &[(Vec<u8>, Fate)]) -> Vec<u8> {
    let mut line = Vec::new();
    let mut late: Option<&[u8]> = None;
    for (frame, fate) in frames {
        let mut bytes = frame.clone();
        match fate {
            Fate::Arrives | Fate::Doubled => {}
            Fate::Lost => bytes.clear(),
            // Not the zero at its end: another one follows, so nothing would be lost.
            Fate::Torn(at) => _ = bytes.remove(at.index(frame.len() - 1)),
            Fate::Flipped(bit) => {
                let bit = bit.index((frame.len() - 1) * 8);
                bytes[bit / 8] ^= 1 << (bit % 8);
            }
            Fate::Late => {
                late = Some(frame);
                continue;
            }
        }
        line.push(0);
        line.extend_from_slice(&bytes);
        if matches!(fate, Fate::Doubled) {
            line.extend_from_slice(&bytes);
        }
        line.extend_from_slice(late.take().unwrap_or_default());
    }
    line
}

/// How many of the frames are to be taken, each by itself: what arrives whole, in its order.
fn taken(frames: &[(Vec<u8>, Fate)]) -> usize {
    let whole = |fate: &Fate| matches!(fate, Fate::Arrives | Fate::Doubled);
    let mut count = 0;
    for (index, (_, fate)) in frames.iter().enumerate() {
        count += usize::from(whole(fate));
        // A late one counts if what came before it was no later frame.
        if matches!(fate, Fate::Late) {
            let next = frames[index + 1..]
                .iter()
                .find(|(_, fate)| !matches!(fate, Fate::Late));
            let replaced = matches!(frames.get(index + 1), Some((_, Fate::Late)));
            count += usize::from(!replaced && next.is_some_and(|(_, fate)| !whole(fate)));
        }
    }
    count
}

proptest! {
    #![proptest_config(seeded(60))]

    #[test]
    fn each_request_is_taken_once_or_not_at_all(fates in prop::collection::vec(fate(), 1..40)) {
        let mut rig = Rig::new();
        rig.hello();
        rig.do_(&Request::TakeLease {});
        let frames: Vec<_> = fates
            .iter()
            .map(|fate| (rig.client.request(&Request::Enable {}).unwrap().to_vec(), *fate))
            .collect();
        let before = rig.heard.len();
        rig.to_axis = line(&frames);
        rig.step();
        prop_assert_eq!(rig.way.enables as usize, taken(&frames));
        let heard = rig.heard[before..].to_vec();
        for (sequence, said) in &heard {
            prop_assert!(matches!(said, Said::Ack | Said::Refused(Refusal::Late)), "{sequence}: {said:?}");
        }
        // The next good frame is taken, whatever was before it.
        rig.to_axis.push(0);
        let status = rig.ask(&Request::Status {});
        let is_status = matches!(status, Said::Status { .. });
        prop_assert!(is_status);
    }

    #[test]
    fn damaged_moves_move_nothing(
        targets in prop::collection::vec((-300..300_i64, fate()), 1..12),
    ) {
        let mut rig = Rig::new();
        rig.ready();
        let still = rig.way.axis.outputs().setpoint;
        for (target, fate) in &targets {
            let fate = match *fate {
                Fate::Arrives | Fate::Doubled | Fate::Late => Fate::Lost,
                fate => fate,
            };
            let frame = rig.client.request(&Rig::move_to(*target)).unwrap().to_vec();
            let damaged = line(&[(frame, fate)]);
            rig.to_axis.extend_from_slice(&damaged);
            rig.to_axis.push(0);
            rig.run(3);
        }
        let outputs = rig.run(50);
        prop_assert_eq!(rig.way.motions, 0);
        prop_assert_eq!((outputs.state, outputs.setpoint), (State::Ready, still));
    }
}

#[test]
fn a_move_that_comes_again_is_done_once_and_answered_again() {
    let mut rig = Rig::new();
    rig.ready();
    let mut bytes = rig.post(&Rig::move_to(10));
    let sequence = rig.client.sequence();
    rig.run(10);
    rig.to_axis.append(&mut bytes.clone());
    rig.run(1000);
    let answers = rig.heard.iter().filter(|(of, _)| *of == sequence);
    assert_eq!(
        answers.map(|(_, said)| said.clone()).collect::<Vec<_>>(),
        [Said::Ack, Said::Ack]
    );
    assert_eq!(rig.way.motions, 1);

    // Another one, and then the first again from where it was caught: it does not go back.
    rig.do_(&Rig::move_to(30));
    rig.run(1000);
    rig.to_axis.append(&mut bytes);
    rig.run(1000);
    assert_eq!(
        rig.heard.iter().rfind(|(of, _)| *of == sequence).unwrap().1,
        Said::Refused(Refusal::Late)
    );
    let Said::Status { setpoint_nm, .. } = rig.ask(&Request::Status {}) else {
        panic!()
    };
    assert_eq!((setpoint_nm, rig.way.motions), (30_000_000, 2));
}

#[test]
fn a_session_played_again_from_a_recording_does_nothing() {
    let mut rig = Rig::new();
    let mut tape = Vec::new();
    rig.run(3);
    tape.extend(rig.post(&Request::Hello {
        protocol: 1,
        nonce: 900,
    }));
    rig.step();
    for request in [Request::TakeLease {}, Request::Enable {}] {
        tape.extend(rig.post(&request));
        rig.step();
    }
    let enables = rig.way.enables;
    assert_eq!(enables, 1);
    rig.run(500);
    // Two sessions later, as another tool might have been connected meanwhile.
    rig.hello();
    rig.hello();
    for _ in 0..3 {
        rig.to_axis.extend_from_slice(&tape);
        rig.run(20);
    }
    assert_eq!((rig.way.enables, rig.service.holder()), (enables, None));
    assert_eq!(rig.way.axis.outputs().state, State::Disabled);
}
