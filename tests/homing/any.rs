//! Homing on any captures and lines: no panic, limits kept, an end.

use leadscrew::axis::{Axis, Inputs};
use leadscrew::hal::{Capture, Latch, Lines};
use leadscrew::homing::HomingParams;
use leadscrew::units::Velocity;
use proptest::prelude::*;

use crate::rig::{Rig, Switches, axis_params, real};
use crate::seeded::seeded;

type Tick = (u32, Option<u32>, Option<u32>, u8, bool);

fn ticks() -> impl Strategy<Value = Vec<Tick>> {
    let step = prop_oneof![8 => 0..200_u32, 1 => any::<u32>(), 1 => (0..200_u32).prop_map(u32::wrapping_neg)];
    let latch = || prop::option::weighted(0.02, any::<u32>());
    prop::collection::vec(
        (
            step,
            latch(),
            latch(),
            any::<u8>(),
            prop::bool::weighted(0.995),
        ),
        1..3000,
    )
}

proptest! {
    #![proptest_config(seeded(40))]

    #[test]
    fn no_input_panics_or_breaks_a_limit(ticks in ticks(), direction in prop_oneof![Just(-1.0), Just(1.0)]) {
        let homing = HomingParams { search_direction: direction, max_time_s: 1.0, ..HomingParams::default() };
        let mut axis = Axis::new(axis_params(&real(), homing).validate().unwrap());
        let limits = axis.config().limits;
        let mut count = 0_u32;
        for (at, (step, home, index, bits, enable)) in ticks.into_iter().enumerate() {
            count = count.wrapping_add(step);
            let bit = |bit: u8| bits >> bit & 1 == 1;
            let latch = |off: Option<u32>| off.map(|off| Latch { count: count.wrapping_sub(off), time: 0 });
            let capture = Capture { count, home: latch(home), index: latch(index), ..Capture::default() };
            let lines = Lines {
                // Now and then, in runs.
                home: bit(0) && bit(1),
                limit_low: bits == 7,
                limit_high: bits == 9,
                ..Lines::default()
            };
            let outputs = *axis.step(&Inputs { lines, ..Inputs::of(capture, enable) });
            prop_assert!(outputs.setpoint.velocity.abs() <= limits.velocity() + Velocity::DELTA);
            prop_assert!(outputs.setpoint.acceleration.abs() <= limits.acceleration());
            if at % 200 == 50 {
                let _ = axis.home();
            }
        }
    }
}

proptest! {
    #![proptest_config(seeded(12))]

    #[test]
    fn from_any_start_the_axis_is_homed_on_the_same_index(offset in -60_000.0..60_000.0_f64, seed in 1..100_u64) {
        // A cam of 20 mm; 40 mm behind it the limit. The switch lies 7 000 d before an index, wherever the start.
        let turn = (offset / 10_000.0).floor() * 10_000.0 + 3_000.0;
        let switches = Switches { home: (turn, turn + 20_000.0), limits: (-500_000.0, turn + 60_000.0) };
        let homing = HomingParams { search_feed_mm_per_min: 3000.0, approach_feed_mm_per_min: 600.0, ..HomingParams::default() };
        let mut rig = Rig::new(&real(), homing, switches, seed);
        rig.home();
        let origin = rig.origin();
        prop_assert!(origin.is_some_and(|origin| (origin - turn - 7_000.0).abs() <= 1.0), "{:?} {:?}", origin, rig.axis.homing().failure());
    }
}
