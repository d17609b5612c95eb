//! Whatever the captures: no panic, an end, and a place that is no later than the first edge of the touch.

use leadscrew::hal::Latch;
use leadscrew::probe::{ProbeEnd, ProbeParams};
use proptest::prelude::*;

use crate::follower::Follower;

fn cases() -> u32 {
    if std::env::var_os("LEADSCREW_LONG").is_some() {
        2000
    } else {
        48
    }
}

#[derive(Clone, Debug)]
struct Tick {
    level: bool,
    latch: Option<(i32, i32)>,
}

fn ticks() -> impl Strategy<Value = Vec<Tick>> {
    let latch = prop::option::weighted(0.1, (-100_000_i32..100_000, -200_000_i32..200_000));
    let tick = (any::<bool>(), latch).prop_map(|(level, latch)| Tick { level, latch });
    prop::collection::vec(tick, 1..400)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases()))]

    #[test]
    fn any_levels_and_latches_come_to_an_end(
        ticks in ticks(),
        debounce_s in 0.0..0.01,
        trigger_delay_s in 0.0..0.01,
        target in prop::sample::select(vec![-700.0, 150.0, 900.0]),
        retract in 0.0..300.0,
    ) {
        let mut follower = Follower::new(ProbeParams {
            debounce_s,
            trigger_delay_s,
            ..ProbeParams::default()
        });
        follower.probe(target, retract).unwrap();
        for tick in &ticks {
            follower.touching = tick.level;
            follower.latch = tick.latch.map(|(count, time)| Latch {
                count: (follower.position as i32).wrapping_add(count).cast_unsigned(),
                time: follower.now.wrapping_add_signed(time),
            });
            follower.step();
        }
        follower.touching = false;
        follower.latch = None;
        follower.finish();
        let report = follower.axis.probe().report();
        prop_assert!(report.end.is_some());
        if let Some(touch) = report.touch {
            prop_assert!(touch.overtravel >= 0);
        }
    }

    #[test]
    fn a_touch_is_where_its_first_edge_was_at_any_feed_and_debounce(
        debounce_s in 0.0..0.02,
        after in 80_usize..400,
        bounce in prop::collection::vec(any::<bool>(), 0..12),
        up in any::<bool>(),
    ) {
        let mut follower = Follower::new(ProbeParams {
            debounce_s,
            max_overtravel_mm: 10.0,
            ..ProbeParams::default()
        });
        let target = if up { 30_000.0 } else { -30_000.0 };
        let bound: f64 = follower.probe(target, 0.0).unwrap().to_num();
        follower.run(after);
        let place = follower.touch();
        follower.touching = true;
        follower.step();
        for level in bounce {
            follower.touching = level;
            if level {
                follower.touch();
            }
            follower.step();
        }
        follower.touching = true;
        follower.finish();
        let report = follower.axis.probe().report();
        // A pulse with a pause as long as the debounce is a glitch, and one of those after it the touch.
        if report.glitches == 0 {
            prop_assert_eq!(report.end, Some(ProbeEnd::Touched));
            let touch = report.touch.unwrap();
            let raw: f64 = touch.raw.to_num();
            prop_assert!((raw - place).abs() < 0.05, "{} {}", raw, place);
            let overtravel: f64 = touch.overtravel.to_num();
            prop_assert!(overtravel <= bound, "{} {}", overtravel, bound);
        }
    }
}
