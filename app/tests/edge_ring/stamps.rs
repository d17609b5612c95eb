//! The count at an event of which only the time is known.

use leadscrew_app::edge_ring::{EdgeRing, Taken, count_at};

use crate::model::{Delays, Edge, Model};

const WORDS: usize = 16;

/// A tick from clock 0 to 100 with an edge at each of `places`, with its direction.
fn tick(places: &[(i64, i32)]) -> (Taken<WORDS>, [u32; WORDS]) {
    let edges = places.iter().map(|&(at, step)| Edge { at, step }).collect();
    let mut model = Model::<WORDS>::new(Delays::default(), edges).starting_at(12);
    model.count_origin = model.count_origin.wrapping_sub(2);
    model.time_origin = u32::MAX - 60;
    let mut ring = EdgeRing::new(0);
    model.tick(&mut ring, 0, 1, 1);
    let ticked = model.tick(&mut ring, 100, 101, 102);
    (ticked.taken, model.ring)
}

fn at(places: &[(i64, i32)], time: u32) -> Option<u32> {
    let (taken, ring) = tick(places);
    count_at(
        &taken,
        taken.span.slices(&ring),
        (u32::MAX - 60).wrapping_add(time),
    )
}

const START: u32 = 0_u32.wrapping_sub(2);

#[test]
fn each_edge_after_the_stamp_is_taken_back() {
    let forward: Vec<_> = (1..=7).map(|index| (10 * index, 1)).collect();
    let backward: Vec<_> = (1..=7).map(|index| (10 * index, -1)).collect();
    for time in 0..=100 {
        let passed = (time / 10).min(7);
        assert_eq!(
            at(&forward, time),
            Some(START.wrapping_add(passed)),
            "{time}"
        );
        assert_eq!(
            at(&backward, time),
            Some(START.wrapping_sub(passed)),
            "{time}"
        );
    }
}

#[test]
fn a_reversal_leaves_only_what_is_before_or_after_all_of_it() {
    let turn = [(20, 1), (40, 1), (60, -1)];
    assert_eq!(at(&turn, 19), Some(START));
    assert_eq!(at(&turn, 20), None);
    assert_eq!(at(&turn, 59), None);
    assert_eq!(at(&turn, 60), Some(START.wrapping_add(1)));
}

#[test]
fn a_stamp_after_the_sample_is_the_next_ticks() {
    assert_eq!(at(&[(20, 1)], 100), Some(START.wrapping_add(1)));
    assert_eq!(at(&[(20, 1)], 101), None);
}

#[test]
fn without_all_times_the_count_is_not_known() {
    let (mut taken, ring) = tick(&[(20, 1)]);
    taken.overrun = true;
    assert_eq!(
        count_at(&taken, taken.span.slices(&ring), taken.sampled_at),
        None
    );
}
