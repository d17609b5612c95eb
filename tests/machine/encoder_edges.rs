//! Edges of the ideal encoder: exact times, exact counts.

use leadscrew_hal_mock::arc::{Arc, State};
use leadscrew_hal_mock::encoder::{Encoder, EncoderModel};
use proptest::prelude::*;

use crate::seeded::seeded;

/// Timer clocks of a tick of 1 kHz.
const CLOCKS: f64 = 84_000.0;

fn ideal(position: f64) -> Encoder {
    Encoder::new(&EncoderModel::ideal(), 1000.0, position, 1).unwrap()
}

/// Edge times of the last tick in clocks since the start of the first, unwrapped near `tick`.
fn edge_clocks(encoder: &Encoder, tick: u32) -> Vec<f64> {
    let start = tick.wrapping_mul(84_000);
    let edges = encoder.capture().edges.concat();
    edges
        .iter()
        .map(|at| f64::from(tick) * CLOCKS + f64::from(at.wrapping_sub(start).cast_signed()))
        .collect()
}

fn assert_within_a_clock(seen: f64, exact: f64, slack: f64) {
    // The timer shows the last whole clock.
    assert!(
        seen <= exact + slack && seen > exact - 1.0 - slack,
        "{seen} instead of {exact}"
    );
}

#[test]
fn at_constant_velocity_edges_come_at_their_exact_times() {
    for velocity in [0.013, 0.37, 1.0, 7.3, 149.99, 2000.0, -0.013, -1.0, -150.0] {
        let start = 0.5;
        let mut encoder = ideal(start);
        let mut state = State {
            position: start,
            velocity,
            acceleration: 0.0,
        };
        let mut edges = 0;
        for tick in 0..300 {
            let arc = Arc {
                start: state,
                jerk: 0.0,
            };
            encoder.advance(&arc);
            state = arc.end();
            for seen in edge_clocks(&encoder, tick) {
                edges += 1;
                let boundary = if velocity > 0.0 {
                    f64::from(edges)
                } else {
                    f64::from(1 - edges)
                };
                let exact = (boundary - start) / velocity * CLOCKS;
                // Positions are kept to 2⁻³² d and times to 2⁻²⁶ of a tick.
                let slack = CLOCKS * (0.5_f64.powi(26) + 0.5_f64.powi(31) / velocity.abs());
                assert_within_a_clock(seen, exact, slack);
            }
        }
        let expected = (start + 300.0 * velocity).floor().abs() as i32;
        assert!((edges - expected).abs() <= 1, "{velocity}: {edges} edges");
    }
}

#[test]
fn on_a_ramp_edges_come_at_the_exact_roots_on_both_sides_of_the_reversal() {
    for (velocity, acceleration) in [(5.0, -0.01), (-20.0, 0.03), (0.0, 0.14147), (100.0, -1.9)] {
        let start = State {
            position: 0.5,
            velocity,
            acceleration,
        };
        let mut encoder = ideal(start.position);
        let mut state = start;
        let (mut count, mut edges) = (0_i32, 0);
        for tick in 0..900 {
            let arc = Arc {
                start: state,
                jerk: 0.0,
            };
            encoder.advance(&arc);
            state = arc.end();
            // Ticks in which the shaft turns round are for the test of counts.
            let forward =
                arc.start.velocity > 0.0 || (arc.start.velocity == 0.0 && acceleration > 0.0);
            if arc.start.velocity * state.velocity < 0.0 {
                count = encoder.capture().count as i32;
                continue;
            }
            for seen in edge_clocks(&encoder, tick) {
                let boundary = if forward { count + 1 } else { count };
                count += if forward { 1 } else { -1 };
                edges += 1;
                let way = f64::from(boundary) - start.position;
                let speed = (velocity * velocity + 2.0 * acceleration * way)
                    .max(0.0)
                    .sqrt();
                let then = if forward { speed } else { -speed };
                let exact = (then - velocity) / acceleration * CLOCKS;
                // What 2⁻³⁰ d of rounding make at this speed.
                assert_within_a_clock(
                    seen,
                    exact,
                    CLOCKS * (0.5_f64.powi(26) + 0.5_f64.powi(30) / speed),
                );
            }
            assert_eq!(count, encoder.capture().count as i32);
        }
        assert!(edges > 500, "{edges}");
    }
}

/// Where the shaft is at the 17 borders of the parts of a tick within which an excursion to and fro may be
/// missed; `None` where one of them is too near a boundary for the rounding.
fn counts_at_parts(arc: &Arc) -> Option<Vec<i64>> {
    (0..=16)
        .map(|part| {
            let position = arc.at(f64::from(part) / 16.0).position;
            ((position - position.round()).abs() > 1e-7).then_some(position.floor() as i64)
        })
        .collect()
}

/// Boundaries passed between one count and another, in order.
fn passed(from: i64, to: i64) -> Vec<i64> {
    if to >= from {
        (from + 1..=to).collect()
    } else {
        (to + 1..=from).rev().collect()
    }
}

/// A walk of cubic arcs that reverses now and then: jerks that are drawn, with a pull back to rest.
fn walk(speed: f64, draws: &[f64]) -> Vec<Arc> {
    let mut state = State {
        position: 0.5,
        ..State::default()
    };
    let draw = |draw: &f64| {
        let jerk = speed * (0.4 * draw) - 0.4 * state.acceleration - 0.05 * state.velocity;
        let arc = Arc { start: state, jerk };
        state = arc.end();
        arc
    };
    draws.iter().map(draw).collect()
}

proptest! {
    #![proptest_config(seeded(200))]

    #[test]
    fn on_any_walk_the_count_is_the_floor_of_the_position_and_each_edge_lies_on_its_boundary(
        speed in (0.01_f64.ln()..300.0_f64.ln()).prop_map(f64::exp),
        draws in prop::collection::vec(-1.0..1.0_f64, 200),
    ) {
        let mut encoder = ideal(0.5);
        let mut last_edge = f64::NEG_INFINITY;
        for (tick, arc) in walk(speed, &draws).iter().enumerate() {
            encoder.advance(arc);
            let seen = edge_clocks(&encoder, tick as u32);
            prop_assert!(seen.iter().is_sorted() && seen.first().is_none_or(|&first| first >= last_edge));
            last_edge = seen.last().copied().unwrap_or(last_edge);
            let Some(counts) = counts_at_parts(arc) else { continue };
            prop_assert_eq!(i64::from(encoder.capture().count as i32), counts[16]);

            // Every boundary between one part and the next gives an edge; a shaft that does not turn passes |Δcount|.
            let boundaries: Vec<i64> = counts.windows(2).flat_map(|pair| passed(pair[0], pair[1])).collect();
            prop_assert_eq!(seen.len(), boundaries.len());
            for (at, boundary) in seen.iter().zip(boundaries) {
                // The boundary is passed between this clock and the next.
                let time = (at - tick as f64 * CLOCKS) / CLOCKS;
                let middle = arc.at(time + 0.5 / CLOCKS);
                let reach = (middle.velocity.abs() + middle.acceleration.abs() / CLOCKS) * 0.51 / CLOCKS;
                let off = (middle.position - boundary as f64).abs();
                // Times to 2⁻²⁶ of a tick at the speed, positions to 2⁻³⁰ d.
                let slack = middle.velocity.abs() * 0.5_f64.powi(25) + 0.5_f64.powi(30);
                prop_assert!(off <= reach + slack, "edge {} d off at {:?}", off, middle);
            }
        }
    }

    #[test]
    fn a_shaft_that_turns_one_way_gives_as_many_edges_as_counts(
        velocity in 0.5..1000.0_f64,
        draws in prop::collection::vec(-0.2..0.2_f64, 100),
        forward in any::<bool>(),
    ) {
        let sign = if forward { 1.0 } else { -1.0 };
        let mut state = State { position: 0.5, velocity: sign * velocity, acceleration: 0.0 };
        let mut encoder = ideal(0.5);
        let mut count = 0_i32;
        for draw in draws {
            // The velocity wanders between 0.4 and 1.6 of its first value.
            let acceleration = 0.5 * (sign * velocity - state.velocity) + draw * velocity;
            let arc = Arc { start: State { acceleration, ..state }, jerk: 0.0 };
            encoder.advance(&arc);
            state = arc.end();
            let capture = encoder.capture();
            let moved = (capture.count as i32).wrapping_sub(count);
            prop_assert_eq!(capture.edges.concat().len(), moved.unsigned_abs() as usize);
            prop_assert!(moved * sign as i32 >= 0);
            count = capture.count as i32;
        }
    }
}
