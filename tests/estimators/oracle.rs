//! Fixed point against the papers' formulas in `f64`.

use leadscrew::capture::Unwrapper;
use leadscrew::edges::EdgeReader;
use leadscrew::estimator::{
    Estimate, Estimator, EstimatorConfig, Evidence, exponential, gaussian, simple,
};
use leadscrew::hal::Capture;
use leadscrew::units::Velocity;
use proptest::prelude::*;

use crate::{counting_estimators, edges};

/// Smoothed positions by the formulas of P2 in `f64`, for a shaft that has always stood at the first count.
fn smoothed(config: &EstimatorConfig, counts: &[i64]) -> Vec<f64> {
    let at = |index: usize, age: usize| (counts[index.saturating_sub(age)] - counts[0]) as f64;
    let bell = |age: usize| (-((age * age) as f64) / 72.0).exp();
    let bells: f64 = (0..25).map(bell).sum();
    let mut average = 0.0;
    (0..counts.len())
        .map(|index| match config.name() {
            "difference" => at(index, 0),
            "exponential" => {
                average += 0.18 * (at(index, 0) - average);
                average
            }
            "simple" => (0..15).map(|age| at(index, age)).sum::<f64>() / 15.0,
            _ => (0..25).map(|age| bell(age) / bells * at(index, age)).sum(),
        })
        .collect()
}

/// What an estimator says of a capture.
fn update(estimator: &mut Estimator, unwrapper: &mut Unwrapper, capture: &Capture<'_>) -> Estimate {
    estimator.update(&Evidence::new(
        &unwrapper.unwrap(capture),
        &EdgeReader::new(edges()),
        None,
    ))
}

fn estimates(config: EstimatorConfig, counts: &[i64]) -> Vec<Estimate> {
    let mut unwrapper = Unwrapper::new();
    let mut estimator = Estimator::new(config);
    let capture = |count: i64| Capture {
        count: count as u32,
        ..Capture::default()
    };
    counts
        .iter()
        .map(|&count| update(&mut estimator, &mut unwrapper, &capture(count)))
        .collect()
}

/// Largest error of position, velocity and acceleration beyond half an LSB, for motion up to ±2 047 d/tick.
///
/// The difference and the simple average are exact. Exponential: α = 0.18 is off by 1.7e-10, which acts on
/// x − y ≤ 2 047/α d and, over α once more, on the position. Gaussian: the weights of σ 6, N 25 are off by
/// 7.1e-9 in all, which acts on 2 047 d/tick, and by 3.1e-8 in the sum over their ages, on the position.
/// An acceleration may add the errors of two velocities. What the oracle itself rounds is below 1e-9.
fn bounds(name: &str) -> [f64; 3] {
    match name {
        "exponential" => [1.1e-5, 3.9e-6, 7.8e-6],
        "gaussian" => [6.4e-5, 1.5e-5, 3e-5],
        _ => [1e-9; 3],
    }
}

/// Half an LSB of position, velocity and acceleration.
const HALF_LSB: [f64; 3] = [0.5 / 65_536.0, 0.5 / 1_048_576.0, 0.5 / 16_777_216.0];

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn every_estimator_is_the_formula_of_the_paper(
        start in -1_000_000_000_i64..1_000_000_000,
        deltas in prop::collection::vec(prop_oneof![-150_i64..=150, -2047_i64..=2047, Just(2047_i64)], 2..200),
    ) {
        let counts: Vec<i64> = std::iter::once(start)
            .chain(deltas.iter().scan(start, |count, delta| { *count += delta; Some(*count) }))
            .collect();
        for config in counting_estimators() {
            let oracle = smoothed(&config, &counts);
            let mut previous_velocity = 0.0;
            for (index, estimate) in estimates(config, &counts).iter().enumerate() {
                let velocity = oracle[index] - if index > 0 { oracle[index - 1] } else { 0.0 };
                let acceleration = (velocity - previous_velocity).clamp(-128.0, 128.0 - 2.0 * HALF_LSB[2]);
                previous_velocity = velocity;
                let position = oracle[index] + start as f64 + 0.5;
                let errors = [
                    estimate.position.to_num::<f64>() - position,
                    estimate.velocity.to_num::<f64>() - velocity,
                    estimate.acceleration.to_num::<f64>() - acceleration,
                ];
                for ((error, half), beyond) in errors.iter().zip(HALF_LSB).zip(bounds(config.name())) {
                    prop_assert!(error.abs() <= half + beyond, "{} at tick {index}: {errors:?}", config.name());
                }
            }
        }
    }

    #[test]
    fn estimates_do_not_depend_on_where_the_axis_stands_and_mirror_with_direction(
        shift in -1_000_000_000_000_i64..1_000_000_000_000,
        deltas in prop::collection::vec(-2047_i64..=2047, 2..100),
    ) {
        let walk = |start: i64, sign: i64| -> Vec<i64> {
            let steps = deltas.iter().scan(start, |count, delta| { *count += sign * delta; Some(*count) });
            std::iter::once(start).chain(steps).collect()
        };
        for config in counting_estimators() {
            let here = estimates(config, &walk(0, 1));
            let there = estimates(config, &walk(shift, 1));
            let mirrored = estimates(config, &walk(0, -1));
            for ((here, there), mirrored) in here.iter().zip(&there).zip(&mirrored) {
                prop_assert_eq!(here.velocity, there.velocity);
                prop_assert_eq!(here.acceleration, there.acceleration);
                // Halves round upward in both directions, so the mirror image is right to an LSB.
                prop_assert!((here.velocity.to_bits() + mirrored.velocity.to_bits()).abs() <= 1);
                let sum = i64::from(here.acceleration.to_bits()) + i64::from(mirrored.acceleration.to_bits());
                prop_assert!(sum.abs() <= 1);
            }
        }
    }
}

#[test]
fn the_first_sample_is_rest_wherever_it_is() {
    for config in counting_estimators() {
        let first = estimates(config, &[2_000_000_000, 2_000_000_000])[1];
        assert_eq!(
            first.position.to_num::<f64>(),
            2_000_000_000.5,
            "{}",
            config.name()
        );
        assert_eq!(
            (first.velocity.to_bits(), first.acceleration.to_bits()),
            (0, 0),
            "{}",
            config.name()
        );
    }
}

#[test]
fn a_primed_estimator_goes_on_as_if_it_had_always_been_there() {
    let velocity = Velocity::from_num(149.7);
    for config in counting_estimators() {
        let mut unwrapper = Unwrapper::new();
        let mut estimator = Estimator::new(config);
        unwrapper.unwrap(&Capture::default());
        estimator.prime(velocity);
        let lag: f64 = config.lags().position.to_num();
        for tick in 1..100_u32 {
            let count = (149.7 * f64::from(tick)) as u32;
            let capture = Capture {
                count,
                ..Capture::default()
            };
            let estimate = update(&mut estimator, &mut unwrapper, &capture);
            // What is left is the rounding of the count: up to a discrete of a plain difference.
            let name = config.name();
            assert!(
                (estimate.velocity.to_num::<f64>() - 149.7).abs() <= 0.75,
                "{name}: {estimate:?}"
            );
            assert!(
                estimate.acceleration.to_num::<f64>().abs() <= 1.0,
                "{name}: {estimate:?}"
            );
            let behind = 149.7 * (f64::from(tick) - lag) - estimate.position.to_num::<f64>();
            assert!(
                behind.abs() <= 1.5,
                "{name}: {behind} d behind at tick {tick}"
            );
        }
    }
}

#[test]
fn no_state_drifts_in_a_million_ticks() {
    for config in counting_estimators() {
        let mut unwrapper = Unwrapper::new();
        let mut estimator = Estimator::new(config);
        let mut count = 0_u32;
        let mut step = |delta: i32| {
            count = count.wrapping_add_signed(delta);
            let capture = Capture {
                count,
                ..Capture::default()
            };
            update(&mut estimator, &mut unwrapper, &capture)
        };
        for tick in 0..1_000_000 {
            step(if tick % 7 < 3 { 1999 } else { -1499 });
        }
        let rest = (0..400).map(|_| step(0)).last().unwrap();
        let expected = f64::from(count) + 0.5;
        assert_eq!(
            rest.position.to_num::<f64>() % 4_294_967_296.0,
            expected,
            "{}",
            config.name()
        );
        assert_eq!(
            (rest.velocity.to_bits(), rest.acceleration.to_bits()),
            (0, 0),
            "{}",
            config.name()
        );
    }
}

#[test]
fn parameters_out_of_range_are_refused_by_name() {
    let refused = [
        exponential::Config::new(0.0).unwrap_err(),
        exponential::Config::new(1.0).unwrap_err(),
        exponential::Config::new(f64::NAN).unwrap_err(),
    ];
    assert!(refused.iter().all(|error| error.name == "estimator.alpha"));
    assert_eq!(simple::Config::new(0).unwrap_err().name, "estimator.window");
    assert_eq!(simple::Config::new(65).unwrap_err().value, 65.0);
    assert_eq!(
        gaussian::Config::new(0.0, 25).unwrap_err().name,
        "estimator.sigma_ticks"
    );
    assert_eq!(
        gaussian::Config::new(6.0, 65).unwrap_err().name,
        "estimator.window"
    );
    assert_eq!(EstimatorConfig::by_name("kalman"), Ok(None));
}
