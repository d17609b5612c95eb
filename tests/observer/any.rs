//! Any captures and commands whatever; where the axis stands and which way it goes.

use leadscrew::estimator::observer::{Config, ObserverParams};
use leadscrew::estimator::{Estimate, Variances};
use leadscrew::hal::Capture;
use leadscrew::units::{AxisScale, Command};
use proptest::prelude::*;

use crate::evidence::{CLOCKS, Listener};
use crate::seeded::seeded;

/// Without offset, so that directions are alike.
fn config() -> Config {
    let params = ObserverParams {
        offset: 0.0,
        ..ObserverParams::default()
    };
    Config::new(&params, AxisScale::new(1000.0, 1000.0).unwrap()).unwrap()
}

#[derive(Clone, Debug)]
struct Wild {
    count: u32,
    sampled_at: u32,
    last_edge_at: Option<u32>,
    times: Vec<u32>,
    split: usize,
    illegal: u16,
    overrun: bool,
    command: Option<i32>,
    repeats: u32,
}

fn wild() -> impl Strategy<Value = Wild> {
    let count = prop_oneof![any::<u32>(), 0..5000_u32, Just(0_u32), Just(u32::MAX)];
    let time = || prop_oneof![any::<u32>(), 0..200_000_u32];
    let times = prop::collection::vec(time(), 0..8);
    let command = prop::option::of(prop_oneof![
        any::<i32>(),
        Just(i32::MIN),
        Just(i32::MAX),
        Just(0)
    ]);
    let trouble = (
        prop_oneof![3 => Just(0_u16), 1 => any::<u16>()],
        prop::bool::weighted(0.2),
    );
    (
        count,
        time(),
        prop::option::of(time()),
        times,
        0..8_usize,
        trouble,
        command,
        1..200_u32,
    )
        .prop_map(
            |(
                count,
                sampled_at,
                last_edge_at,
                times,
                split,
                (illegal, overrun),
                command,
                repeats,
            )| Wild {
                count,
                sampled_at,
                last_edge_at,
                split: split.min(times.len()),
                times,
                illegal,
                overrun,
                command,
                repeats,
            },
        )
}

proptest! {
    #![proptest_config(seeded(400))]

    // Overflow checks are on in this profile: an overflow is a panic.
    #[test]
    fn it_takes_any_captures_whatever(ticks in prop::collection::vec(wild(), 1..40)) {
        let mut listener = Listener::new(config());
        for tick in &ticks {
            let (older, newer) = tick.times.split_at(tick.split);
            let mut capture = Capture {
                count: tick.count,
                sampled_at: tick.sampled_at,
                last_edge_at: tick.last_edge_at,
                edges: [older, newer],
                illegal: tick.illegal,
                overrun: tick.overrun,
                ..Capture::default()
            };
            // The same speed for a while: states grow as far as they can.
            for _ in 0..tick.repeats {
                capture.count = capture.count.wrapping_add(tick.count % 4096);
                capture.sampled_at = capture.sampled_at.wrapping_add(CLOCKS);
                let heard = listener.hear(&capture, tick.command.map(Command::from_bits));
                let Estimate { position, velocity, .. } = heard.estimate;
                let apart = position.to_num::<f64>() - heard.count as f64;
                prop_assert!(apart.abs() <= 4097.0, "{apart} d from the count");
                prop_assert!(velocity.to_num::<f64>().abs() <= 2047.0);
            }
        }
    }
}

/// A walk: counts moved, and where in the tick, with the command.
type Walk = Vec<(i32, u32, i32)>;

fn walk() -> impl Strategy<Value = Walk> {
    let step = prop_oneof![3 => -3..=3_i32, 2 => 40..60_i32, 1 => -2047..=2047_i32];
    prop::collection::vec((step, 0..CLOCKS, -(1 << 29)..(1 << 29)), 2..150)
}

/// Estimates of a walk, relative to its count, from `start` in direction `sign`.
fn estimates(walk: &Walk, start: i64, sign: i32) -> Vec<(Estimate, f64, Variances)> {
    let mut listener = Listener::new(config());
    let (mut count, mut now) = (start as u32, 0_u32);
    listener.hear(
        &Capture {
            count,
            sampled_at: now,
            ..Capture::default()
        },
        None,
    );
    let mut heard = Vec::new();
    for (steps, late, command) in walk {
        let end = now.wrapping_add(CLOCKS);
        count = count.wrapping_add_signed(sign * steps);
        let all: Vec<u32> = (0..steps.unsigned_abs())
            .map(|edge| now.wrapping_add((late + edge) % CLOCKS))
            .collect();
        let capture = Capture {
            count,
            sampled_at: end,
            last_edge_at: all.last().copied(),
            edges: [&all, &[]],
            ..Capture::default()
        };
        now = end;
        let next = listener.hear(&capture, Some(Command::from_bits(sign * command)));
        let apart = next.estimate.position.to_num::<f64>() - next.count as f64 - 0.5;
        heard.push((next.estimate, apart, next.variances));
    }
    heard
}

proptest! {
    #![proptest_config(seeded(200))]

    #[test]
    fn it_is_the_same_anywhere_and_mirrors_with_direction(
        walk in walk(),
        start in -2_000_000_000_i64..2_000_000_000,
    ) {
        let here = estimates(&walk, 0, 1);
        let there = estimates(&walk, start, 1);
        let mirrored = estimates(&walk, 0, -1);
        for ((here, there), mirrored) in here.iter().zip(&there).zip(&mirrored) {
            prop_assert_eq!(here.0.velocity, there.0.velocity);
            prop_assert_eq!(here.0.acceleration, there.0.acceleration);
            prop_assert_eq!(here.2, there.2);
            prop_assert_eq!(here.1, there.1);
            // Products are cut downward in both directions.
            let apart = (here.1 + mirrored.1).abs();
            let velocity = here.0.velocity.to_num::<f64>() + mirrored.0.velocity.to_num::<f64>();
            let acceleration = here.0.acceleration.to_num::<f64>() + mirrored.0.acceleration.to_num::<f64>();
            prop_assert!(apart < 1e-3, "{apart} d");
            prop_assert!(velocity.abs() < 1e-3, "{velocity} d/tick");
            prop_assert!(acceleration.abs() < 1e-3, "{acceleration} d/tick²");
        }
    }
}
