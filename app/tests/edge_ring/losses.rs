//! Edges that the ring lost, and what is told of them.

use leadscrew::capture::{EdgeTimes, Unwrapper};
use leadscrew_app::edge_ring::{EdgeRing, Progress, Sample};

use crate::model::{Delays, Edge, Model};

const WORDS: usize = 64;
const DELAYS: Delays = Delays {
    count: 2,
    stamp: 2,
    dma: 3,
};

/// `count` edges 20 clocks apart from clock 100 on; every `turn` of them the motion turns round.
fn edges(count: usize, turn: usize) -> Vec<Edge> {
    (0..count)
        .map(|index| Edge {
            at: 100 + 20 * index as i64,
            step: if (index / turn).is_multiple_of(2) {
                1
            } else {
                -1
            },
        })
        .collect()
}

/// Ticks before the edges, after `count` of them, and after 10 more.
fn overruns(count: usize, turn: usize) -> [bool; 2] {
    let mut model = Model::<WORDS>::new(DELAYS, edges(count + 10, turn)).starting_at(50);
    let mut ring = EdgeRing::<WORDS>::new(4);
    model.tick(&mut ring, 0, 20, 60);
    let after = 100 + 20 * count as i64 - 10;
    let first = model.tick(&mut ring, after, after + 8, after + 9);
    let last = model.counted_stamps(after);
    if first.taken.overrun {
        assert!(first.edges.is_empty());
        assert!(
            first
                .taken
                .last_edge_at
                .is_none_or(|at| Some(&at) == last.last())
        );
    } else {
        assert_eq!(first.edges.len(), count);
    }
    let second = model.tick(&mut ring, after + 400, after + 430, after + 440);
    assert_eq!(second.edges.len(), 10);
    [first.taken.overrun, second.taken.overrun]
}

#[test]
fn more_than_half_the_ring_and_any_number_of_laps_are_told_and_the_next_tick_is_well() {
    for turn in [usize::MAX, 1, 7] {
        for count in 1..WORDS * 4 {
            let is_overrun = count > WORDS / 2;
            assert_eq!(overruns(count, turn), [is_overrun, false], "{count} {turn}");
        }
    }
}

#[test]
fn after_an_overrun_the_newest_edge_still_stands_at_the_count() {
    let mut model = Model::<WORDS>::new(DELAYS, edges(WORDS + 20, usize::MAX));
    let mut ring = EdgeRing::<WORDS>::new(4);
    let mut unwrapper = Unwrapper::new();
    let at = |model: &mut Model<WORDS>, ring: &mut EdgeRing<WORDS>, sampled: i64| {
        model.tick(ring, sampled, sampled + 8, sampled + 9)
    };
    let first = at(&mut model, &mut ring, 0);
    unwrapper.unwrap(&first.taken.capture([&[], &[]]));
    let all = 100 + 20 * (WORDS as i64 + 20);
    let ticked = at(&mut model, &mut ring, all);
    let capture = ticked.taken.capture([&[], &[]]);
    let seen = unwrapper.unwrap(&capture);
    assert_eq!(seen.delta, WORDS as i32 + 20);
    // The sample is 18 clocks after the last stamp, and stated by the skew of 4 later.
    assert_eq!(seen.edge_times(), EdgeTimes::Last { age: 22 });
    assert_eq!(unwrapper.health().overrun_ticks, 1);
}

/// A ring of which 10 words are written, 100 clocks apart from 1 000 on.
fn ten_edges(index: usize) -> u32 {
    if index < 10 {
        1000 + 100 * index as u32
    } else {
        0
    }
}

fn progress(written: u16) -> Progress {
    Progress {
        remaining: WORDS as u16 - written,
        ..Progress::default()
    }
}

fn started() -> EdgeRing<WORDS> {
    let mut ring = EdgeRing::new(4);
    let sample = Sample {
        count: 0,
        time: 500,
    };
    ring.take(sample, progress(0), ten_edges);
    ring
}

#[test]
fn a_time_that_never_came_is_told() {
    let after = |count| Sample { count, time: 3000 };
    assert!(!started().take(after(10), progress(10), ten_edges).overrun);
    assert!(
        !started().take(after(8), progress(10), ten_edges).overrun,
        "a reversal"
    );
    for count in [9, 11, 12, 0_u32.wrapping_sub(12)] {
        assert!(
            started()
                .take(after(count), progress(10), ten_edges)
                .overrun
        );
    }
}

#[test]
fn an_overcapture_is_told() {
    let lossy = Progress {
        is_lossy: true,
        ..progress(10)
    };
    let sample = Sample {
        count: 10,
        time: 3000,
    };
    assert!(started().take(sample, lossy, ten_edges).overrun);
}

#[test]
fn a_word_that_is_not_written_yet_waits_for_the_next_tick() {
    let mut ring = started();
    let sample = Sample {
        count: 10,
        time: 3000,
    };
    // The position is a word ahead of memory: the word is an old one.
    let taken = ring.take(sample, progress(11), ten_edges);
    assert_eq!((taken.span.len(), taken.overrun), (10, false));
    let sample = Sample {
        count: 11,
        time: 4000,
    };
    let taken = ring.take(sample, progress(11), |index| {
        if index == 10 { 3050 } else { ten_edges(index) }
    });
    assert_eq!((taken.span.len(), taken.last_edge_at), (1, Some(3050)));
    assert!(!taken.overrun);
}

#[test]
fn no_edges_is_a_tick_like_any_other() {
    let mut ring = started();
    for time in [3000, 4000, 0x9000_0000, 0xffff_ffff, 10] {
        let sample = Sample { count: 10, time };
        let taken = ring.take(sample, progress(10), ten_edges);
        assert_eq!(taken.last_edge_at.is_some(), time == 3000);
        assert!(!taken.overrun);
    }
}

#[test]
fn a_burst_in_doubt_is_taken_as_far_as_it_explains_the_count() {
    // Words 7 to 9 lie within the skew.
    let burst = |index: usize| match index {
        7 => 2998,
        8 => 3000,
        9 => 3003,
        _ => ten_edges(index),
    };
    for (count, edges) in [(7, 7), (8, 8), (9, 9), (10, 10), (5, 9), (4, 10)] {
        let sample = Sample { count, time: 3000 };
        let taken = started().take(sample, progress(10), burst);
        assert_eq!((taken.span.len(), taken.overrun), (edges, false), "{count}");
    }
}
