//! What the edges of a tick come to: every defined case, at every clock and rate.

use leadscrew::capture::{Observation, Unwrapper};
use leadscrew::edges::{EdgeConfig, EdgeReader, EdgeSample, MAX_SPAN_TICKS};
use leadscrew::hal::Capture;
use leadscrew::uncertainty::EdgeErrors;

const CLOCKS: u32 = 84_000;

fn reader(tick_hz: f64, timer_hz: f64) -> EdgeReader<'static> {
    EdgeReader::new(EdgeConfig::new(tick_hz, timer_hz, &EdgeErrors::default()).unwrap())
}

/// The sample of `capture` after one at `count` and `sampled_at`.
fn after(count: u32, sampled_at: u32, capture: &Capture<'_>) -> Option<EdgeSample> {
    let mut unwrapper = Unwrapper::new();
    unwrapper.unwrap(&Capture {
        count,
        sampled_at,
        ..Capture::default()
    });
    let observation: Observation<'_> = unwrapper.unwrap(capture);
    reader(1000.0, 84e6).sample(&observation)
}

fn place_and_age(sample: EdgeSample) -> (f64, f64, u32) {
    (sample.position.to_num(), sample.age.to_num(), sample.edges)
}

#[test]
fn all_edges_make_their_mean_in_either_direction() {
    // Boundaries 11, 12, 13 going up and 10, 9, 8 going down; in two parts, as a ring gives them.
    let times = [CLOCKS / 4, CLOCKS / 2, 3 * (CLOCKS / 4)];
    for (count, place) in [(13, 12.0), (7, 9.0)] {
        let capture = Capture {
            count,
            sampled_at: CLOCKS,
            last_edge_at: Some(times[2]),
            edges: [&times[..1], &times[1..]],
            ..Capture::default()
        };
        let (found, age, edges) = place_and_age(after(10, 0, &capture).unwrap());
        assert_eq!((found, edges), (place, 3));
        assert!((age - 0.5).abs() < 1e-8, "{age}");
    }
}

#[test]
fn a_single_stamp_is_the_last_edge() {
    for (count, place) in [(13, 13.0), (7, 8.0)] {
        let capture = Capture {
            count,
            sampled_at: CLOCKS,
            last_edge_at: Some(CLOCKS - 21_000),
            ..Capture::default()
        };
        let (found, age, edges) = place_and_age(after(10, 0, &capture).unwrap());
        assert_eq!((found, edges), (place, 1));
        assert!((age - 0.25).abs() < 1e-8, "{age}");
    }
}

#[test]
fn what_does_not_explain_the_count_tells_what_is_certain() {
    let times = [1000, 2000, 3000, 4000];
    let capture = |count, edges| Capture {
        count,
        sampled_at: CLOCKS,
        last_edge_at: Some(4000),
        edges: [edges, &[]],
        ..Capture::default()
    };
    // No motion and no edge; a reversal: there and back, or more edges than counts.
    assert_eq!(after(10, 0, &capture(10, &[])), None);
    assert_eq!(after(10, 0, &capture(10, &times)), None);
    assert_eq!(after(10, 0, &capture(12, &times)), None);
    // Times were lost: the last edge stands at the new count.
    let lost = Capture {
        overrun: true,
        ..capture(20, &times)
    };
    let (place, _, edges) = place_and_age(after(10, 0, &lost).unwrap());
    assert_eq!((place, edges), (20.0, 1));
    // The count is in doubt.
    let illegal = Capture {
        illegal: 1,
        ..capture(14, &times)
    };
    assert_eq!(after(10, 0, &illegal), None);
    // More than a velocity can tell: the last edge, if there is a single stamp.
    let stamp = Capture {
        edges: [&[], &[]],
        ..capture(9_000, &[])
    };
    let (place, _, _) = place_and_age(after(10, 0, &stamp).unwrap());
    assert_eq!(place, 9_000.0);
}

#[test]
fn counters_may_wrap_and_edges_share_a_clock() {
    let times = [u32::MAX - 10, u32::MAX - 10, 5];
    let capture = Capture {
        count: 1,
        sampled_at: 10,
        last_edge_at: Some(5),
        edges: [&times, &[]],
        ..Capture::default()
    };
    let (place, age, _) = place_and_age(after(u32::MAX - 1, 10 - CLOCKS % 7, &capture).unwrap());
    // Boundaries −1, 0 and 1: ages 21, 21 and 5 clocks.
    assert_eq!(place, 0.0);
    assert!((age * f64::from(CLOCKS) - 47.0 / 3.0).abs() < 1e-3, "{age}");
}

#[test]
fn ages_are_right_at_every_clock_and_rate() {
    for (tick_hz, timer_hz) in [
        (1000.0, 84e6),
        (2500.0, 84e6),
        (100.0, 250e6),
        (40_000.0, 1e6),
        (40_000.0, 250e6),
        (997.3, 1e6),
    ] {
        let reader = reader(tick_hz, timer_hz);
        let clocks = timer_hz / tick_hz;
        for edges in [1_u32, 2, 7, 150, 2047] {
            let now = 1_000_000_000_u32;
            let times: Vec<u32> = (0..edges)
                .map(|edge| now - (clocks * 0.9 * f64::from(edge) / f64::from(edges)) as u32)
                .collect();
            let exact = times.iter().map(|time| f64::from(now - time)).sum::<f64>()
                / f64::from(edges)
                / clocks;
            let mut unwrapper = Unwrapper::new();
            unwrapper.unwrap(&Capture {
                sampled_at: now - clocks as u32,
                ..Capture::default()
            });
            let capture = Capture {
                count: edges,
                sampled_at: now,
                edges: [&times, &[]],
                ..Capture::default()
            };
            let observation = unwrapper.unwrap(&capture);
            let age: f64 = reader.sample(&observation).unwrap().age.to_num();
            assert!(
                (age - exact).abs() < 2e-8 + 2.0_f64.powi(-20) / clocks,
                "{tick_hz} Hz, {timer_hz} Hz, {edges}: {age} instead of {exact}"
            );
            let elapsed: f64 = reader.elapsed(&observation).to_num();
            assert!(
                (elapsed - (clocks as u32 as f64) / clocks).abs() < 2e-8,
                "{elapsed}"
            );
        }
    }
}

#[test]
fn long_spans_stop_at_the_longest() {
    for age in [8 * CLOCKS, 100 * CLOCKS, u32::MAX / 2, u32::MAX - 1] {
        let now = 7_u32;
        let capture = Capture {
            count: 11,
            sampled_at: now,
            last_edge_at: Some(now.wrapping_sub(age)),
            ..Capture::default()
        };
        let sample = after(10, 0, &capture).unwrap();
        assert_eq!(sample.age, MAX_SPAN_TICKS, "{age}");
    }
}
