//! Nothing that can come in makes it panic or overflow: debug assertions are on.

use leadscrew::tachogenerator::{Config, CrossCheck, TachogeneratorParams};
use leadscrew::units::{AxisScale, Lag, Velocity};
use proptest::prelude::*;

use crate::seeded::seeded;

fn bits() -> impl Strategy<Value = i32> {
    prop_oneof![
        any::<i32>(),
        -200_000_000..200_000_000,
        Just(i32::MIN),
        Just(i32::MAX),
        Just(0),
    ]
}

fn params() -> impl Strategy<Value = TachogeneratorParams> {
    (
        0.001..1e6_f64,
        0.0..1e4_f64,
        0.001..0.5_f64,
        1e-4..1e3_f64,
        0.01..100.0_f64,
        0.0..=1.0_f64,
    )
        .prop_map(
            |(full, floor, tolerance, distance, time, age)| TachogeneratorParams {
                full_feed_mm_per_min: full,
                floor_mm_per_min: floor,
                start_floor_mm_per_min: floor * 2.0,
                tolerance,
                start_tolerance: 0.5,
                distance_mm: distance,
                clear_s: time,
                fit_s: time,
                reading_age_ticks: age,
            },
        )
}

fn steps() -> impl Strategy<Value = Vec<(i32, i32, i32, u8)>> {
    prop::collection::vec((bits(), bits(), bits(), any::<u8>()), 1..40)
}

proptest! {
    #![proptest_config(seeded(400))]

    #[test]
    fn any_inputs_are_survived(
        params in params(),
        counts_per_mm in 0.01..1e5_f64,
        tick_hz in 100.0..40_000.0_f64,
        steps in steps(),
    ) {
        let scale = AxisScale::new(counts_per_mm, tick_hz).unwrap();
        let Ok(config) = Config::new(&params, scale) else { return Ok(()) };
        let mut check = CrossCheck::new(config);
        for (velocity, reading, lag, times) in steps {
            // Ordinary lags as well as any.
            let lag = if times % 2 == 0 { lag } else { lag & 0x001f_ffff };
            for _ in 0..times {
                check.update(
                    Velocity::from_bits(velocity),
                    Lag::from_bits(lag),
                    Velocity::from_bits(reading),
                );
            }
            let gain: f64 = check.gain().to_num();
            prop_assert!((0.0..=1.6).contains(&gain), "{}", gain);
        }
    }

    #[test]
    fn what_agrees_exactly_never_disagrees(
        velocities in prop::collection::vec(-2_000_000_000..2_000_000_000_i32, 2..400),
    ) {
        let scale = AxisScale::new(1000.0, 1000.0).unwrap();
        let params = TachogeneratorParams { reading_age_ticks: 0.0, ..TachogeneratorParams::default() };
        let mut check = CrossCheck::new(Config::new(&params, scale).unwrap());
        for velocity in velocities {
            let velocity = Velocity::from_bits(velocity);
            prop_assert_eq!(check.update(velocity, Lag::ZERO, velocity), None);
            prop_assert_eq!(check.gain().to_num::<f64>(), 1.0);
        }
    }

    #[test]
    fn a_mirror_image_is_judged_alike(
        steps in prop::collection::vec((-200_000_000..200_000_000_i32, -200_000_000..200_000_000_i32), 2..200),
    ) {
        let scale = AxisScale::new(1000.0, 1000.0).unwrap();
        let config = Config::new(&TachogeneratorParams::default(), scale).unwrap();
        let (mut one, mut other) = (CrossCheck::new(config), CrossCheck::new(config));
        for (velocity, reading) in steps {
            let at = |bits: i32| Velocity::from_bits(bits);
            let lag = Lag::from_num(5.06);
            prop_assert_eq!(
                one.update(at(velocity), lag, at(reading)),
                other.update(at(-velocity), lag, at(-reading))
            );
        }
    }
}
