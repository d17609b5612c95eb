//! 1.2 M edges a second, forwards, backwards and turning round, at 1 and 2.5 kHz with a timer of 84 MHz.

use leadscrew::capture::Unwrapper;
use leadscrew_app::edge_ring::EdgeRing;

use crate::model::{Delays, Edge, Model};

const WORDS: usize = 8192;
const DELAYS: Delays = Delays {
    count: 33,
    stamp: 30,
    dma: 12,
};

/// Edges 70 clocks apart, alternately earlier and later by `jitter`; they turn after `turn`.
fn edges(count: i64, jitter: i64, turn: i64) -> Vec<Edge> {
    (0..count)
        .map(|index| Edge {
            at: 70 * index + if index % 2 == 0 { jitter } else { -jitter },
            step: if index < turn { 1 } else { -1 },
        })
        .collect()
}

fn run(tick_clocks: i64, edges: Vec<Edge>) -> (Vec<i32>, Vec<bool>) {
    let ticks = edges.last().map_or(0, |edge| edge.at) / tick_clocks;
    let mut model = Model::<WORDS>::new(DELAYS, edges);
    model.time_origin = u32::MAX - 300_000;
    let mut ring = EdgeRing::<WORDS>::new(6);
    let mut unwrapper = Unwrapper::new();
    let (mut moves, mut complete) = (Vec::new(), Vec::new());
    let mut given = Vec::new();
    let mut start = 0;
    for tick in 0..=ticks {
        let sampled = tick * tick_clocks;
        // A handler that starts 0.5 to 20 µs after its sample, slices that live for nine tenths of a tick.
        let read = sampled + 42 + (tick * 37 % 1640);
        let ticked = model.tick(&mut ring, sampled, read, sampled + tick_clocks * 9 / 10);
        assert!(!ticked.taken.overrun, "tick {tick}");
        let slices = [ticked.edges.as_slice(), &[]];
        let capture = ticked.taken.capture(slices);
        let seen = unwrapper.unwrap(&capture);
        if tick == 0 {
            start = model.counted_stamps(sampled).len();
        } else {
            moves.push(seen.delta);
            complete.push(seen.edges_complete);
        }
        given.extend(ticked.edges);
    }
    let counted = model.counted_stamps(ticks * tick_clocks);
    assert_eq!(given, counted[start..], "every edge once and in order");
    (moves, complete)
}

#[test]
fn straight_motion_is_explained_in_every_tick() {
    for (tick_clocks, edges_a_tick) in [(84_000, 1200), (33_600, 480)] {
        for jitter in [0, 25] {
            let (moves, complete) = run(tick_clocks, edges(48_000, jitter, i64::MAX));
            assert!(moves.len() >= 39);
            assert!(complete.iter().all(|is_complete| *is_complete));
            assert!(moves.iter().all(|moved| (moved - edges_a_tick).abs() <= 1));
        }
    }
}

#[test]
fn a_reversal_costs_one_tick() {
    let (moves, complete) = run(33_600, edges(48_000, 10, 24_117));
    assert_eq!(
        complete.iter().filter(|is_complete| !**is_complete).count(),
        1
    );
    assert!(moves.first() > Some(&470) && moves.last() < Some(&-470));
}
