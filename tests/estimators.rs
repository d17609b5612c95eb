//! The estimators: against a floating-point oracle, by response, and on the scenes of the papers.

use std::fmt::Write as _;

use leadscrew::capture::Unwrapper;
use leadscrew::estimator::{Estimate, Estimator, EstimatorConfig, exponential, gaussian, simple};
use leadscrew::hal::Capture;
use leadscrew::units::Velocity;
use leadscrew_hal_mock::encoder::{EncoderModel, EncoderParams};
use leadscrew_hal_mock::scene::Motion;
use leadscrew_host::accuracy::{Observed, Trial};
use leadscrew_host::noise::NoiseGain;
use leadscrew_host::simulation::all_estimators;
use proptest::prelude::*;

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

fn estimates(config: EstimatorConfig, counts: &[i64]) -> Vec<Estimate> {
    let mut unwrapper = Unwrapper::new();
    let mut estimator = Estimator::new(config);
    let capture = |count: i64| Capture {
        count: count as u32,
        ..Capture::default()
    };
    counts
        .iter()
        .map(|&count| estimator.update(&unwrapper.unwrap(&capture(count))))
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
        for config in all_estimators() {
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
        for config in all_estimators() {
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
    for config in all_estimators() {
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
    for config in all_estimators() {
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
            let estimate = estimator.update(&unwrapper.unwrap(&capture));
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
fn the_velocity_under_constant_jerk_is_that_of_the_stated_delay() {
    const JERK: f64 = 0.05;
    for config in all_estimators() {
        let delay = config.delay();
        let seen = observe(
            Motion::Jerk { jerk: JERK },
            EncoderModel::ideal(),
            200,
            config,
        );
        let error = seen.mean_now(|estimate, truth| {
            let then = truth.velocity - delay.velocity * truth.acceleration
                + 0.5 * delay.velocity_squared * JERK;
            estimate.velocity.to_num::<f64>() - then
        });
        // The counts' rounding, averaged over 200 ticks; without the spread of the age it would be
        // 0.5·JERK·variance: 0.002 for the difference, 0.6 for the exponential.
        assert!(error.abs() < 0.005, "{}: {error}", config.name());
    }
}

#[test]
fn no_state_drifts_in_a_million_ticks() {
    for config in all_estimators() {
        let mut unwrapper = Unwrapper::new();
        let mut estimator = Estimator::new(config);
        let mut count = 0_u32;
        let mut step = |delta: i32| {
            count = count.wrapping_add_signed(delta);
            estimator.update(&unwrapper.unwrap(&Capture {
                count,
                ..Capture::default()
            }))
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

fn observe(motion: Motion, encoder: EncoderModel, ticks: u32, config: EstimatorConfig) -> Observed {
    Trial {
        motion,
        encoder,
        tick_hz: 1000.0,
        ticks,
        seed: 1,
    }
    .observe(config)
    .unwrap()
}

#[test]
fn stated_lags_are_those_of_the_response() {
    const JERK: f64 = 0.02;
    for config in all_estimators() {
        let ideal = EncoderModel::ideal();
        let lags = config.lags();
        let steady = observe(Motion::Steady { velocity: 50.3 }, ideal, 1000, config);
        let ramp = observe(
            Motion::Ramp {
                velocity: 10.0,
                acceleration: 0.9,
            },
            ideal,
            1000,
            config,
        );
        let jerk = observe(Motion::Jerk { jerk: JERK }, ideal, 300, config);
        let measured = [
            steady.response_lag_x(),
            ramp.response_lag_v(),
            jerk.response_lag_a(JERK),
        ];
        let stated: [f64; 3] = [
            lags.position.to_num(),
            lags.velocity.to_num(),
            lags.acceleration.to_num(),
        ];
        // What is left is the rounding of the counts, averaged over the run.
        let bounds = [0.01, 0.01, 0.2];
        for ((measured, stated), bound) in measured.iter().zip(stated).zip(bounds) {
            assert!(
                (measured - stated).abs() < bound,
                "{}: stated {stated}, measured {measured}",
                config.name()
            );
        }
    }
}

#[test]
fn white_noise_gains_are_those_of_theory() {
    let raw = 6.0_f64.sqrt();
    let theory = [
        ("difference", 1.0),
        ("exponential", 8.79),
        ("simple", 18.4),
        ("gaussian", 13.8),
    ];
    for (name, cut) in theory {
        let config = EstimatorConfig::by_name(name).unwrap().unwrap();
        let found = raw / NoiseGain::of(config).acceleration;
        assert!((found / cut - 1.0).abs() < 0.005, "{name}: {found}");
    }
}

/// An ideal encoder sampled with jitter.
fn jittery(sampling_jitter_s: f64) -> EncoderModel {
    let ideal = EncoderModel::ideal();
    EncoderModel {
        encoder: EncoderParams {
            sampling_jitter_s,
            ..ideal.encoder
        },
        ..ideal
    }
}

/// The scene of P2's Table 1: 130 d/tick, jitter such that the raw σ_a is the paper's 1.695.
fn table_1_jitter(ticks: u32) -> f64 {
    const RAW: f64 = 1.695;
    let raw = EstimatorConfig::by_name("difference").unwrap().unwrap();
    let motion = Motion::Steady { velocity: 130.0 };
    let mut jitter = 5e-6;
    for _ in 0..4 {
        jitter *= RAW
            / observe(motion, jittery(jitter), ticks, raw)
                .acceleration_error()
                .rms();
    }
    jitter
}

/// Method, its σ_a, noise cut, lag and Φ in P2's Table 1.
const TABLE_1: [(&str, f64, f64, f64, f64); 4] = [
    ("difference", 1.695, 1.0, 0.0, 1.644),
    ("exponential", 0.199, 8.5, 8.0, 0.433),
    ("simple", 0.145, 11.7, 8.0, 0.381),
    ("gaussian", 0.133, 12.74, 8.0, 0.369),
];

#[test]
fn table_1_of_the_paper() {
    const TICKS: u32 = 40_000;
    let jitter = table_1_jitter(TICKS);
    let mut table = format!(
        "P2, Table 1: ideal encoder, 130 d/tick, 1 kHz, sampling jitter {:.2} us, so that raw sigma_a = 1.695 d/tick2\n\
         Phi = 0.03 t_z + 0.97 sigma_a; here t_z is the computed lag of the acceleration, in the paper it is read off\n\
         transients (8 for all three), 0 for raw data by its convention. Its weights are rounded: 0.97 and 0.03.\n\
         Theory is white noise of position, which this scene is. The paper's cuts of the exponential (8.5) and the\n\
         weighted average (12.74) are those of a real encoder, whose line errors are not white; its 11.7 of the\n\
         simple average no white noise gives. With computed lags Phi is least near alpha 0.16, sigma 5.5, N 9.\n\n\
         method       sigma_a  paper |   cut  theory  paper | lag_x  lag_v  lag_a  paper |   Phi  paper\n",
        jitter * 1e6
    );
    let mut raw = f64::NAN;
    for (name, paper_sigma, paper_cut, paper_lag, paper_phi) in TABLE_1 {
        let config = EstimatorConfig::by_name(name).unwrap().unwrap();
        let motion = Motion::Steady { velocity: 130.0 };
        let sigma = observe(motion, jittery(jitter), TICKS, config)
            .acceleration_error()
            .rms();
        if name == "difference" {
            raw = sigma;
        }
        let (cut, theory) = (
            raw / sigma,
            6.0_f64.sqrt() / NoiseGain::of(config).acceleration,
        );
        assert!(
            (cut / theory - 1.0).abs() < 0.03,
            "{name}: cut {cut}, theory {theory}"
        );
        let lags = config.lags();
        let lag_a: f64 = if name == "difference" {
            0.0
        } else {
            lags.acceleration.to_num()
        };
        writeln!(
            table,
            "{name:12} {sigma:7.3} {paper_sigma:6.3} | {cut:5.2} {theory:7.2} {paper_cut:6.2} | {:5.2} {:6.2} {:6.2} {paper_lag:6.1} | {:5.3} {paper_phi:6.3}",
            lags.position,
            lags.velocity,
            lags.acceleration,
            0.03 * lag_a + 0.97 * sigma,
        )
        .unwrap();
    }
    assert!((raw - 1.695).abs() < 0.005, "raw sigma_a is {raw}");
    golden("table_1", &table);
}

#[test]
fn flywheel_of_the_paper() {
    let mut table = String::from(
        "P1: flywheel coasting from 20 d/tick at -0.006 d/tick2, ideal encoder, 1 kHz\n\n\
         method       -1, 0, +1, % of ticks   peak a, d/tick2   sigma_a, d/tick2   mean a, d/tick2\n",
    );
    for config in all_estimators() {
        let seen = observe(Motion::FLYWHEEL, EncoderModel::ideal(), 3_000, config);
        let whole = |estimate: &&Estimate| {
            let acceleration: f64 = estimate.acceleration.to_num();
            [-1.0, 0.0, 1.0].contains(&acceleration)
        };
        let jumps = |estimate: &&Estimate| estimate.acceleration.to_num::<f64>().abs() >= 1.0;
        let ticks = seen.estimates.len() as f64;
        let share = 100.0 * seen.estimates.iter().filter(whole).count() as f64 / ticks;
        let mean = seen
            .estimates
            .iter()
            .map(|estimate| estimate.acceleration.to_num::<f64>())
            .sum::<f64>()
            / ticks;
        let peak = seen
            .estimates
            .iter()
            .map(|estimate| estimate.acceleration.to_num::<f64>().abs())
            .fold(0.0, f64::max);
        if config.name() == "difference" {
            assert!(share >= 99.9, "counting gives -1, 0, +1 in {share} %");
        } else {
            // The simple average stands at 0 for most of the time, but never jumps by a whole discrete.
            assert_eq!(
                seen.estimates.iter().filter(jumps).count(),
                0,
                "{}",
                config.name()
            );
            assert!(
                peak < 0.25 && share < 70.0,
                "{}: {peak}, {share}",
                config.name()
            );
        }
        assert!((mean + 0.006).abs() < 0.001, "{}: {mean}", config.name());
        let sigma = seen.acceleration_error().rms();
        writeln!(
            table,
            "{:12} {share:22.2} {peak:17.3} {sigma:18.4} {mean:17.5}",
            config.name()
        )
        .unwrap();
    }
    golden("flywheel", &table);
}

/// Compares with the reviewed table under `tests/golden`; `cargo xtask golden` writes it anew.
fn golden(name: &str, table: &str) {
    insta::with_settings!({ snapshot_path => "golden", prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!(name, table);
    });
}
