//! What the link costs: in the tick what hangs on the axis's step, in thread mode reports, requests and samples.
//!
//! `tick` is that of an axis of which nothing is asked; `tick_scope` with eight signals on the scope and eight streamed;
//! `tick_captures` with eight streamed and every edge handed to the learner. A request is counted from its first byte
//! to its reply; a `move` at rest, and a `replan` on the way, to the plan in the queue to the tick, and `settle` is its
//! reply. `learn_end` is the end of a run of the learner.

mod rig;

use leadscrew::protocol::decoder::Decoder;
use leadscrew::protocol::frame::{Channel, FrameBuffer, Header};
use leadscrew::protocol::request::Request;
use leadscrew::scope::Signal;
use leadscrew_hal_mock::scenario::ScenarioError;

use board_mps2_an386::instructions::Counter;

use crate::scope::USUAL;
use rig::{Of, PLAIN, Rig};

const FEED_UM_PER_MIN: u32 = 9_000_000;
/// Edges of a revolution.
const EDGES: u32 = 10_000;
/// Body of a full frame of samples of eight signals: seven of them.
const SAMPLES_BODY: usize = 7 + 7 * 32;

pub fn run(counter: &mut Counter) -> Result<(), ScenarioError> {
    let mut rig = Rig::new(counter)?;
    (0..30).for_each(|nonce| _ = rig.ask(Of::Hello, &Request::Hello { protocol: 1, nonce }));
    let name = "motion.max_feed_mm_per_min";
    (0..30).for_each(|_| _ = rig.ask(Of::Parameter, &Request::Parameter { name }));
    rig.ask(Of::Other, &Request::TakeLease {});
    for _ in 0..30 {
        let refused = rig.order(Of::Refused, 1, FEED_UM_PER_MIN);
        assert!(refused.is_some(), "the axis is off");
    }
    rig.enable();
    rig.go(100, PLAIN);
    rig.ask(Of::Other, &Request::Subscribe { every: 1 });
    rig.go(0, [Of::Tick, Of::ReportRecord, Of::Poll]);
    rig.ask(Of::Other, &Request::Subscribe { every: 0 });
    instruments(&mut rig);
    // New targets on the way.
    for turn in 0..40 {
        let refused = rig.order(Of::Replan, 20 + 7 * (turn % 9), FEED_UM_PER_MIN);
        assert!(refused.is_none(), "the axis is ready");
        rig.ticks(60);
    }
    frames(&mut rig);
    let told = rig.table.split_last_mut().map(|(_, told)| told);
    told.into_iter()
        .flatten()
        .for_each(|samples| samples.log("link"));
    Ok(())
}

/// Scope, stream and learner.
fn instruments(rig: &mut Rig<'_>) {
    let signals = &USUAL.map(|signal| signal as u8);
    rig.ask(Of::Other, &Request::Stream { every: 1, signals });
    // Never there: it looks on and on.
    let arm = Request::ArmScope {
        signals,
        every: 1,
        samples: 1000,
        before: 999,
        trigger: 4,
        source: Signal::Position as u8,
        level: i64::MAX,
    };
    rig.ask(Of::Other, &arm);
    rig.go(100, [Of::TickScope, Of::Report, Of::PollStream]);
    rig.ask(Of::Other, &Request::EndScope {});
    rig.ticks(20);
    rig.ask(Of::Other, &Request::Learn { edges: EDGES });
    rig.ask(Of::Other, &Request::LearnRun { revolutions: 100 });
    rig.go(0, [Of::TickCaptures, Of::Report, Of::PollLearn]);
    // A whole run, to its end.
    rig.ask(Of::Other, &Request::Learn { edges: EDGES });
    let refused = rig.order(Of::Move, 300, FEED_UM_PER_MIN / 3);
    assert!(refused.is_none(), "the axis is ready");
    rig.ticks(500);
    rig.ask(Of::Other, &Request::LearnRun { revolutions: 12 });
    rig.ticks(6500);
    let refused = rig.ask(Of::LearnEnd, &Request::EndRun {});
    assert!(
        refused.is_none(),
        "the run is complete, and the axis stands"
    );
    rig.ask(Of::Other, &Request::EndLearning {});
    let signals = &[];
    rig.ask(Of::Other, &Request::Stream { every: 0, signals });
}

/// Frames alone.
fn frames(rig: &mut Rig<'_>) {
    let mut buffer = FrameBuffer::default();
    let mut decoder: Decoder = Decoder::new();
    let header = Header {
        channel: Channel::Samples,
        session: 0x0001_0001,
        sequence: 7,
    };
    let mut body = [0; SAMPLES_BODY];
    for turn in 0..100_u8 {
        for (place, byte) in (0_u8..).zip(&mut body) {
            *byte = place.wrapping_mul(turn);
        }
        let cost = rig.counter.count(|| buffer.raw(header, &body).is_ok());
        rig.push(Of::SamplesFrame, cost);
        let bytes = buffer.bytes();
        let mut frames = 0;
        let cost = rig
            .counter
            .count(|| decoder.feed_all(bytes, |_, _| frames += 1));
        assert!(frames == 1, "the decoder takes what was made");
        rig.push(Of::DecodeFrame, cost);
        // SAMPLES_BODY is below 2¹⁶.
        rig.push(Of::DecodeByte, cost / bytes.len() as u32);
    }
}
