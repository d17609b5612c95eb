//! No edges, one edge, few edges.

use leadscrew::estimator::Estimate;
use leadscrew::estimator::polynomial::Answer;

use crate::support::{Bench, CLOCKS, Tick, ticks_of};

fn run(window: u32, answer: Answer, ticks: &[Tick]) -> Vec<Estimate> {
    let mut bench = Bench::new(window, answer);
    ticks
        .iter()
        .map(|tick| tick.with(0, 0, |capture| bench.update(capture)))
        .collect()
}

fn velocity(estimate: &Estimate) -> f64 {
    estimate.velocity.to_num()
}

/// Ticks in which nothing but the edges of `edges` happens: (tick, part of it, count after it).
fn by_hand(ticks: u64, edges: &[(u64, f64, i64)]) -> Vec<Tick> {
    let mut count = 0;
    (1..=ticks)
        .map(|tick| {
            let mut times = Vec::new();
            for &(_, part, after) in edges.iter().filter(|edge| edge.0 == tick) {
                times.push(((tick as f64 - 1.0 + part) * f64::from(CLOCKS)) as u64);
                count = after;
            }
            Tick {
                count,
                sampled_at: tick * u64::from(CLOCKS),
                times,
            }
        })
        .collect()
}

#[test]
fn silence_bounds_the_velocity_and_ends_in_rest() {
    // Half a d/tick, then the shaft stops dead.
    let motion = |t: f64| 0.3 + 0.5 * t.min(100.0);
    let seen = run(15, Answer::Newest, &ticks_of(motion, 500));
    let mut before = f64::INFINITY;
    for (index, estimate) in seen.iter().enumerate().skip(104) {
        let silent = index as f64 + 1.0 - 101.0;
        let speed = velocity(estimate).abs();
        assert!(speed <= 1.5 / silent + 1e-3, "{speed} after {silent} ticks");
        assert!(
            speed <= before + 1e-9,
            "it rises to {speed} after {silent} ticks"
        );
        before = speed;
    }
    for estimate in &seen[352..] {
        assert_eq!(
            (estimate.velocity.to_bits(), estimate.acceleration.to_bits()),
            (0, 0)
        );
    }
}

#[test]
fn an_edge_passed_to_and_fro_is_at_rest() {
    // Once in each of many ticks, close together and far apart, with a hysteresis that nobody told.
    let edges: Vec<_> = (0..200)
        .map(|k| {
            let (tick, part) = (10 + k, if k % 2 == 0 { 0.97 } else { 0.03 });
            (tick, part, i64::from(k % 2 == 0))
        })
        .collect();
    for answer in [Answer::Newest, Answer::Centre] {
        for estimate in run(15, answer, &by_hand(300, &edges)) {
            assert_eq!(
                (estimate.velocity.to_bits(), estimate.acceleration.to_bits()),
                (0, 0)
            );
        }
    }
}

#[test]
fn a_tick_that_goes_to_and_fro_tells_nothing() {
    let edges: Vec<_> = (0..200)
        .flat_map(|k| [(10 + k, 0.2, 1), (10 + k, 0.6, 0)])
        .collect();
    for estimate in run(15, Answer::Newest, &by_hand(300, &edges)) {
        assert_eq!(estimate.velocity.to_bits(), 0);
    }
}

#[test]
fn motion_is_seen_on_the_second_edge() {
    let seen = run(
        15,
        Answer::Newest,
        &by_hand(60, &[(30, 0.5, 1), (34, 0.5, 2), (38, 0.5, 3)]),
    );
    assert!(seen[..33].iter().all(|estimate| estimate.velocity == 0));
    assert!((velocity(&seen[33]) - 0.25).abs() < 0.01, "{:?}", seen[33]);
}

#[test]
fn a_reversal_gives_no_spike() {
    // Through zero at −0.002 and −0.2 d/tick², fast and slow.
    for (start, deceleration) in [(2.0, 0.02), (0.3, 0.002), (20.0, 0.5)] {
        let motion = |t: f64| 0.3 + start * t - 0.5 * deceleration * t * t;
        let ticks = (2.0 * start / deceleration) as u32;
        let seen = run(15, Answer::Newest, &ticks_of(motion, ticks));
        for (index, estimate) in seen.iter().enumerate().skip(40) {
            let exact = start - deceleration * (index as f64 + 1.0);
            let lag: f64 = estimate.lags.velocity.to_num();
            let then = exact + deceleration * lag;
            let error = (velocity(estimate) - then).abs();
            assert!(
                error < 0.1 + 8.0 * deceleration,
                "{start}: {} instead of {then} at tick {index}",
                velocity(estimate)
            );
        }
    }
}

#[test]
fn the_window_widens_to_span_enough_edges_and_says_so() {
    for (speed, widest) in [(0.5, 5.6), (0.2, 12.0), (0.1, 24.0)] {
        let seen = run(8, Answer::Centre, &ticks_of(|t| 0.3 + speed * t, 2000));
        for estimate in &seen[400..] {
            assert!((velocity(estimate) - speed).abs() < 1e-3, "{estimate:?}");
            let lag: f64 = estimate.lags.acceleration.to_num();
            assert!(
                (3.0..=widest + 1.5 / speed).contains(&lag),
                "{speed}: {lag}"
            );
        }
        let mean: f64 = seen[400..]
            .iter()
            .map(|estimate| estimate.lags.acceleration.to_num::<f64>())
            .sum::<f64>()
            / 1600.0;
        assert!(mean <= widest, "{speed}: {mean}");
    }
}

#[test]
fn wider_windows_stop_at_the_set_maximum() {
    // An edge in 40 ticks: two of them in 64.
    let seen = run(8, Answer::Newest, &ticks_of(|t| 0.3 + t / 40.0, 4000));
    for estimate in &seen[400..] {
        assert!(estimate.lags.velocity <= 64, "{estimate:?}");
        assert!(velocity(estimate) < 0.026, "{estimate:?}");
    }
}

#[test]
fn coming_to_rest_is_no_reversal() {
    // A jerk-limited stop: the quadratic of the last edges, extrapolated, would turn round.
    let motion = |t: f64| 0.3 + 40.0 - 0.01 / 6.0 * (40.0 - t.min(40.0)).powi(3);
    for estimate in &run(8, Answer::Newest, &ticks_of(motion, 300))[10..] {
        assert!(velocity(estimate) >= 0.0, "{estimate:?}");
    }
}
