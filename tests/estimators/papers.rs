//! The experiments of the papers: Table 1 of P2 and the flywheel of P1.

use std::fmt::Write as _;

use crate::impulse::NoiseGain;
use leadscrew::estimator::{Estimate, EstimatorConfig};
use leadscrew_hal_mock::encoder::{EncoderModel, EncoderParams};
use leadscrew_hal_mock::scene::Motion;
use leadscrew_host::simulation::all_estimators;

use crate::observe;

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
            "{:12} {share:22.2} {peak:17.3} {sigma:18.6} {mean:17.5}",
            config.name()
        )
        .unwrap();
    }
    golden("flywheel", &table);
}

/// Compares with the reviewed table under `tests/golden`; `cargo xtask golden` writes it anew.
fn golden(name: &str, table: &str) {
    insta::with_settings!({ snapshot_path => "../golden", prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!(name, table);
    });
}
