//! Any captures whatever: no panic, no overflow, and after them the estimates are right again.

use leadscrew::estimator::polynomial::Answer;
use leadscrew::hal::Capture;
use proptest::prelude::*;

use crate::support::{Bench, CLOCKS};

/// A capture that no machine gives.
#[derive(Clone, Debug)]
struct Wild {
    count: u32,
    sampled_at: u32,
    last_edge_at: Option<u32>,
    times: Vec<u32>,
    illegal: bool,
    overrun: bool,
}

fn extreme() -> impl Strategy<Value = u32> {
    prop_oneof![
        any::<u32>(),
        Just(0),
        Just(u32::MAX),
        Just(1 << 31),
        0..5000_u32
    ]
}

fn wild() -> impl Strategy<Value = Wild> {
    (
        extreme(),
        extreme(),
        proptest::option::of(extreme()),
        proptest::collection::vec(extreme(), 0..12),
        any::<bool>(),
        any::<bool>(),
    )
        .prop_map(
            |(count, sampled_at, last_edge_at, times, illegal, overrun)| Wild {
                count,
                sampled_at,
                last_edge_at,
                times,
                illegal,
                overrun,
            },
        )
}

/// Small steps of count and time: what gets deep into the fit.
fn plausible() -> impl Strategy<Value = Vec<Wild>> {
    let step = (-6..7_i32, 1..200_000_u32, 0..84_000_u32, any::<bool>());
    proptest::collection::vec(step, 1..200).prop_map(|steps| {
        let (mut count, mut now) = (0_u32, 0_u32);
        steps
            .into_iter()
            .map(|(delta, elapsed, age, stamped)| {
                count = count.wrapping_add_signed(delta);
                now = now.wrapping_add(elapsed);
                let times = (0..delta.unsigned_abs())
                    .map(|edge| now.wrapping_sub(age / (edge + 1)))
                    .collect();
                Wild {
                    count,
                    sampled_at: now,
                    last_edge_at: Some(now.wrapping_sub(age)),
                    times: if stamped { Vec::new() } else { times },
                    illegal: false,
                    overrun: false,
                }
            })
            .collect()
    })
}

/// Runs them, then a steady motion, which must be found again.
fn survives(window: u32, captures: &[Wild]) -> Result<(), TestCaseError> {
    let mut bench = Bench::new(window, Answer::Newest);
    let (mut count, mut now) = (0, 0);
    for wild in captures {
        bench.update(&Capture {
            count: wild.count,
            sampled_at: wild.sampled_at,
            last_edge_at: wild.last_edge_at,
            edges: [&wild.times, &[]],
            illegal: u16::from(wild.illegal),
            overrun: wild.overrun,
            ..Capture::default()
        });
        (count, now) = (wild.count, wild.sampled_at);
    }
    let mut velocity = 0.0;
    // A window to be rid of them, and some for the velocity that bridges its samples to settle.
    for _ in 0..4 * window + 70 {
        count = count.wrapping_add(30);
        now = now.wrapping_add(CLOCKS);
        let times: Vec<u32> = (0..30)
            .rev()
            .map(|edge| now.wrapping_sub(edge * (CLOCKS / 30)))
            .collect();
        let estimate = bench.update(&Capture {
            count,
            sampled_at: now,
            last_edge_at: Some(now),
            edges: [&times, &[]],
            ..Capture::default()
        });
        velocity = estimate.velocity.to_num();
    }
    prop_assert!((velocity - 30.0_f64).abs() < 1e-3, "{} d/tick", velocity);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, ..ProptestConfig::default() })]

    #[test]
    fn any_sequence_of_captures(
        window in prop_oneof![Just(4_u32), Just(8), Just(15), Just(64)],
        captures in proptest::collection::vec(wild(), 1..120),
    ) {
        survives(window, &captures)?;
    }

    #[test]
    fn any_plausible_sequence(
        window in prop_oneof![Just(4_u32), Just(8), Just(15), Just(64)],
        captures in plausible(),
    ) {
        survives(window, &captures)?;
    }
}
