//! Unwrapping of counts, times and latches against totals kept in 64 bits.

use leadscrew::capture::{MAX_DELTA, Unwrapper};
use leadscrew::hal::{Capture, Latch};
use leadscrew::units::Position;
use proptest::prelude::*;

#[path = "support/seeded.rs"]
mod seeded;
use seeded::seeded;

/// What happens between two samples.
#[derive(Clone, Copy, Debug)]
struct Leg {
    moved: i32,
    elapsed: u32,
    /// Edge times that the hardware kept, and how many of them stand in the older part of its ring.
    edges: (usize, usize),
    overrun: bool,
    illegal: u16,
    /// Counts and clocks by which the latches lie before the sample.
    index: Option<(i32, u32)>,
    probe: Option<(i32, u32)>,
}

/// Motions of a real tick and the largest that the 32-bit counter can tell.
fn moved() -> impl Strategy<Value = i32> {
    prop_oneof![-200..=200_i32, -3000..=3000_i32, -i32::MAX..=i32::MAX]
}

fn latch() -> impl Strategy<Value = Option<(i32, u32)>> {
    prop::option::of((-i32::MAX..=i32::MAX, any::<u32>()))
}

fn leg() -> impl Strategy<Value = Leg> {
    let edges = (0..=250_usize, 0..=250_usize).prop_map(|(count, older)| (count, older.min(count)));
    (
        moved(),
        any::<u32>(),
        edges,
        any::<bool>(),
        any::<u16>(),
        latch(),
        latch(),
        any::<bool>(),
    )
        .prop_map(
            |(moved, elapsed, edges, overrun, illegal, index, probe, explained)| {
                // Every other leg has as many edge times as counts, where that many are kept at all.
                let count = moved.unsigned_abs() as usize;
                let edges = if explained && count <= 250 {
                    (count, edges.1.min(count))
                } else {
                    edges
                };
                Leg {
                    moved,
                    elapsed,
                    edges,
                    overrun,
                    illegal,
                    index,
                    probe,
                }
            },
        )
}

/// The words that hardware with these 64-bit totals would show.
fn wrapped(count: i64, time: i64, before: Option<(i32, u32)>) -> Option<Latch> {
    before.map(|(back, age)| Latch {
        count: (count - i64::from(back)) as u32,
        time: (time - i64::from(age)) as u32,
    })
}

proptest! {
    #![proptest_config(seeded(256))]

    #[test]
    fn any_walk_unwraps_to_its_64_bit_totals(
        origin in any::<i32>(),
        start in any::<u32>(),
        legs in prop::collection::vec(leg(), 1..100),
    ) {
        let (mut count, mut time) = (i64::from(origin), i64::from(start));
        let mut unwrapper = Unwrapper::new();
        unwrapper.unwrap(&Capture { count: count as u32, sampled_at: start, ..Capture::default() });
        let times: Vec<u32> = (0..250).collect();
        let (mut illegal, mut overruns, mut ambiguous, mut overspeeds) = (0, 0, 0, 0);
        for leg in legs {
            count += i64::from(leg.moved);
            time += i64::from(leg.elapsed);
            let (edges, older) = leg.edges;
            let capture = Capture {
                count: count as u32,
                sampled_at: time as u32,
                last_edge_at: (edges > 0).then_some((time - 7) as u32),
                edges: [&times[..older], &times[older..edges]],
                illegal: leg.illegal,
                overrun: leg.overrun,
                index: wrapped(count, time, leg.index),
                probe: wrapped(count, time, leg.probe),
                touching: false,
                home: None,
            };
            let seen = unwrapper.unwrap(&capture);
            prop_assert_eq!((seen.count, seen.sampled_at, seen.elapsed), (count, time, leg.elapsed));
            prop_assert_eq!(seen.delta, leg.moved.clamp(-MAX_DELTA, MAX_DELTA));
            prop_assert_eq!(seen.since_last_edge(), (edges > 0).then_some(7));
            prop_assert_eq!(seen.edges(), capture.edges);
            prop_assert_eq!(seen.position(), Position::from_num(count) + Position::lit("0.5"));
            for (latch, before) in [(seen.index(), leg.index), (seen.probe(), leg.probe)] {
                let truth = before.map(|(back, age)| (count - i64::from(back), time - i64::from(age)));
                prop_assert_eq!(latch.map(|latch| (latch.count, latch.time)), truth);
            }

            let explained = edges == leg.moved.unsigned_abs() as usize;
            prop_assert_eq!(seen.edges_complete, explained && !leg.overrun && leg.illegal == 0);
            illegal += u32::from(leg.illegal);
            overruns += u32::from(leg.overrun);
            ambiguous += u32::from(edges > 0 && !explained);
            overspeeds += u32::from(leg.moved.unsigned_abs() > MAX_DELTA.unsigned_abs());
        }
        let health = unwrapper.health();
        prop_assert_eq!((health.illegal, health.overrun_ticks), (illegal, overruns));
        prop_assert_eq!((health.ambiguous_ticks, health.overspeed_ticks), (ambiguous, overspeeds));
    }
}

#[test]
fn the_first_capture_is_the_origin_whatever_it_shows() {
    for (count, expected) in [
        (0, 0),
        (5, 5),
        (0x7fff_ffff, 0x7fff_ffff),
        (0x8000_0000, -0x8000_0000),
        (u32::MAX, -1),
    ] {
        let mut unwrapper = Unwrapper::new();
        let capture = Capture {
            count,
            sampled_at: u32::MAX,
            ..Capture::default()
        };
        let first = unwrapper.unwrap(&capture);
        assert_eq!(
            (first.count, first.sampled_at),
            (expected, i64::from(u32::MAX))
        );
        assert_eq!(
            (first.delta, first.elapsed, first.since_last_edge()),
            (0, 0, None)
        );
        assert_eq!((first.index(), first.probe()), (None, None));
    }
}

#[test]
fn totals_of_faults_stop_at_their_maximum() {
    let mut unwrapper = Unwrapper::new();
    // 65 538 · 65 535 is the first multiple beyond 32 bits.
    for _ in 0..65_538 {
        unwrapper.unwrap(&Capture {
            illegal: u16::MAX,
            ..Capture::default()
        });
    }
    assert_eq!(unwrapper.health().illegal, u32::MAX);
}
