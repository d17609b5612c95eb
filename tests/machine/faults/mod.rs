//! Faulty encoders do what their faults say, and nothing else.

mod counter;
mod interference;
mod lines;

use leadscrew::hal::{Capture, Encoder, Latch};
use leadscrew_hal_mock::encoder::{EncoderModel, EncoderParams};
use leadscrew_hal_mock::faults::{Bursts, Channel, Fault, FaultyEncoder};
use leadscrew_hal_mock::scene::{Motion, Scene, Swing};

const TIMER_HZ: f64 = 84e6;

/// A capture of its own.
#[derive(Clone, Debug, PartialEq)]
struct Seen {
    count: i32,
    sampled_at: u32,
    edges: Vec<u32>,
    last_edge_at: Option<u32>,
    illegal: u16,
    overrun: bool,
    index: Option<Latch>,
}

fn seen(capture: &Capture<'_>) -> Seen {
    Seen {
        count: capture.count.cast_signed(),
        sampled_at: capture.sampled_at,
        edges: capture.edges.concat(),
        last_edge_at: capture.last_edge_at,
        illegal: capture.illegal,
        overrun: capture.overrun,
        index: capture.index,
    }
}

/// What a good encoder and one with `fault` from tick `from` to tick `to` see, tick for tick.
fn run(
    motion: Motion,
    model: EncoderModel,
    fault: Fault,
    (from, to, ticks): (u32, u32, u32),
) -> Vec<(Seen, Seen)> {
    let mut scene = Scene::new(motion, &model, 1000.0, 0.5, 1).unwrap();
    let mut faulty = FaultyEncoder::new(fault, from..to, &scene.capture()).unwrap();
    let tick = |_| {
        scene.step();
        let good = seen(&scene.capture());
        (good, seen(&faulty.apply(&scene.capture())))
    };
    (0..ticks).map(tick).collect()
}

fn all_faults() -> [Fault; 9] {
    let bursts = Bursts::at(300.0, TIMER_HZ);
    [
        Fault::FalseEdges(bursts),
        Fault::IllegalTransitions(bursts),
        Fault::LostEdges { every: 7 },
        Fault::DoubledEdges { every: 7 },
        Fault::DeadChannel(Channel::A),
        Fault::DeadChannel(Channel::B),
        Fault::DutyDrift { delay_clocks: 40 },
        Fault::LineLoss,
        Fault::Overrun { kept: 3 },
    ]
}

/// Motions with speed, creep, reversals and rest, over the index.
fn motions() -> [Motion; 4] {
    let tremble = Motion::Sine(Swing {
        amplitude: 0.9,
        period_ticks: 37.0,
        phase_turns: 0.0,
    });
    let turns = Motion::Sine(Swing {
        amplitude: 40.0,
        period_ticks: 8.0,
        phase_turns: 0.1,
    });
    [
        Motion::SINE,
        Motion::Steady { velocity: 131.0 },
        tremble,
        turns,
    ]
}

/// The encoder "real", sampled with jitter, so that edges wait for the next capture.
fn jittery() -> EncoderModel {
    let real = EncoderModel::real();
    EncoderModel {
        encoder: EncoderParams {
            sampling_jitter_s: 1e-5,
            ..real.encoder
        },
        ..real
    }
}

#[test]
fn without_its_fault_an_encoder_is_as_good_as_ever() {
    for motion in motions() {
        for fault in all_faults() {
            for (tick, (good, faulty)) in run(motion, jittery(), fault, (900, 900, 900))
                .into_iter()
                .enumerate()
            {
                assert_eq!(good, faulty, "{motion:?}, {fault:?}, tick {tick}");
            }
        }
    }
}

#[test]
fn whatever_the_fault_a_capture_is_consistent() {
    for motion in motions() {
        for fault in all_faults() {
            let (mut count, mut newest, mut different) = (None, 0, 0);
            for (tick, (good, faulty)) in run(motion, jittery(), fault, (100, 700, 900))
                .into_iter()
                .enumerate()
            {
                let at = format!("{motion:?}, {fault:?}, tick {tick}: {faulty:?}");
                let moved = faulty.count - count.unwrap_or(faulty.count);
                count = Some(faulty.count);
                if tick > 0 && !faulty.overrun {
                    let edges = faulty.edges.len() as i32;
                    assert!(moved.abs() <= edges && (edges - moved) % 2 == 0, "{at}");
                }
                for &edge in &faulty.edges {
                    assert!(edge >= newest && edge <= faulty.sampled_at, "{at}");
                    newest = edge;
                }
                assert_eq!(faulty.last_edge_at, faulty.edges.last().copied(), "{at}");
                assert_eq!(faulty.sampled_at, good.sampled_at, "{at}");
                assert!(tick >= 100 || good == faulty, "{at}");
                different += u32::from(good != faulty);
            }
            // Two edges a period tell neither every seventh from the rest nor fill a buffer of three.
            let few = matches!(motion, Motion::Sine(swing) if swing.amplitude < 1.0);
            let unseen = matches!(fault, Fault::Overrun { .. });
            assert!(different > 0 || few && unseen, "{motion:?}, {fault:?}");
        }
    }
}

#[test]
fn a_faulty_encoder_is_an_encoder_and_refuses_what_cannot_be() {
    let mut scene = Scene::new(Motion::SINE, &EncoderModel::real(), 1000.0, 0.5, 1).unwrap();
    let mut faulty = FaultyEncoder::new(Fault::LineLoss, 0..5, &scene.capture()).unwrap();
    scene.step();
    let applied = seen(&faulty.apply(&scene.capture()));
    assert_eq!(seen(&Encoder::capture(&faulty)), applied);
    let message = |fault| {
        FaultyEncoder::new(fault, 0..5, &scene.capture())
            .unwrap_err()
            .to_string()
    };
    let refused = message(Fault::LostEdges { every: 0 });
    assert!(refused.starts_with("every = 0 is out of range"));
    let endless = Bursts {
        period_clocks: 0,
        pulses: 0,
        width_clocks: 1,
    };
    let refused = message(Fault::FalseEdges(endless));
    assert!(refused.starts_with("period_clocks = 0 is out of range"));
    let refused = message(Fault::DutyDrift {
        delay_clocks: 2_000_000,
    });
    assert!(refused.starts_with("delay_clocks = 2000000 is out of range"));
}
