//! Every course of a few edges around a sample, in every order with the handler's reads.

use leadscrew::capture::Unwrapper;
use leadscrew_app::edge_ring::EdgeRing;

use crate::model::{Delays, Edge, Model};

const WORDS: usize = 16;
const SKEW: u16 = 2;
/// Clocks between places where an edge may be: more than 2·skew.
const PITCH: i64 = 6;
const PLACES: u32 = 6;
/// Times of the triggers; the first one only takes the origin.
const FIRST: i64 = -40;
const SETTLED: i64 = 400;

/// What is at each place: nothing, an edge up, an edge down.
fn course(mut code: u32, phase: i64) -> Vec<Edge> {
    let mut edges = Vec::new();
    for place in 0..PLACES {
        let step = [0, 1, -1][(code % 3) as usize];
        code /= 3;
        if step != 0 {
            edges.push(Edge {
                at: i64::from(place) * PITCH + phase,
                step,
            });
        }
    }
    edges
}

struct Case {
    code: u32,
    phase: i64,
    delays: Delays,
    /// Clocks from the trigger to the read of the stream's position.
    latency: i64,
    /// The stream's position at the start.
    place: usize,
}

/// Runs the course over three samples and checks that every edge is given in the tick that counted it.
fn check(case: &Case) {
    let edges = course(case.code, case.phase);
    let mut model = Model::<WORDS>::new(case.delays, edges.clone()).starting_at(case.place);
    // Time and count wrap in the middle of it.
    model.time_origin = 0_u32.wrapping_sub(18);
    model.count_origin = model.count_origin.wrapping_add(u32::MAX);
    let mut ring = EdgeRing::<WORDS>::new(SKEW);
    let mut unwrapper = Unwrapper::new();
    let mut known = 0;
    for sampled in [FIRST, 3 * PITCH, SETTLED] {
        let read = sampled + case.latency;
        let ticked = model.tick(&mut ring, sampled, read, read + 100);
        let counted = model.counted_stamps(sampled);
        let is_first = sampled == FIRST;
        let expected = if is_first { &[][..] } else { &counted[known..] };
        let moved: i32 = edges_between(&edges, case, known, counted.len());
        let about = format!(
            "course {} at {}, {:?}, latency {}, place {}, sample {sampled}",
            case.code, case.phase, case.delays, case.latency, case.place
        );
        assert_eq!(ticked.edges, expected, "{about}");
        assert!(!ticked.taken.overrun, "{about}");
        assert_eq!(
            ticked.taken.last_edge_at,
            expected.last().copied(),
            "{about}"
        );
        let slices = [ticked.edges.as_slice(), &[]];
        let capture = ticked.taken.capture(slices);
        let seen = unwrapper.unwrap(&capture);
        if !is_first {
            assert_eq!(seen.delta, moved, "{about}");
            let is_straight = moved.unsigned_abs() as usize == expected.len();
            assert_eq!(seen.edges_complete, is_straight, "{about}");
        }
        // No time lies after the instant that the capture states.
        let late = |edge: &u32| (capture.sampled_at.wrapping_sub(*edge)).cast_signed() < 0;
        assert!(!expected.iter().any(late), "{about}");
        known = counted.len();
    }
}

fn edges_between(edges: &[Edge], case: &Case, from: usize, to: usize) -> i32 {
    let shift = |index: usize| index.saturating_sub(case.place);
    edges[shift(from)..shift(to)]
        .iter()
        .map(|edge| edge.step)
        .sum()
}

/// All pairs of delays whose difference is at most the skew.
fn paths() -> impl Iterator<Item = (i64, i64)> {
    let skew = i64::from(SKEW);
    (-skew..=skew).map(move |ahead| (skew + ahead, skew))
}

#[test]
fn every_edge_is_given_in_the_tick_that_counted_it() {
    let mut cases = 0;
    for code in 0..3_u32.pow(PLACES) {
        for phase in 0..PITCH {
            for (count, stamp) in paths() {
                for latency in [7, 10, 13, 20] {
                    let delays = Delays {
                        count,
                        stamp,
                        dma: 2,
                    };
                    check(&Case {
                        code,
                        phase,
                        delays,
                        latency,
                        place: 13,
                    });
                    cases += 1;
                }
            }
        }
    }
    assert_eq!(cases, 729 * 6 * 5 * 4);
}

#[test]
fn wherever_the_stream_stands_in_the_ring() {
    for place in 0..WORDS {
        for code in 0..3_u32.pow(PLACES) {
            for (count, stamp) in paths() {
                let delays = Delays {
                    count,
                    stamp,
                    dma: 1,
                };
                let phase = i64::from(code) % PITCH;
                check(&Case {
                    code,
                    phase,
                    delays,
                    latency: 9,
                    place,
                });
            }
        }
    }
}

#[test]
fn an_edge_between_any_two_reads_of_the_handler() {
    for latency in 5..40 {
        for code in 0..3_u32.pow(PLACES) {
            let delays = Delays {
                count: 2,
                stamp: 3,
                dma: 1,
            };
            let phase = i64::from(code / 7) % PITCH;
            check(&Case {
                code,
                phase,
                delays,
                latency,
                place: 15,
            });
        }
    }
}
