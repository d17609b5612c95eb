//! Symmetries, jitter, and the bound of white noise.

use leadscrew::estimator::polynomial::{Answer, Config};
use leadscrew::estimator::{Estimate, EstimatorConfig, Variances};
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::Motion;
use leadscrew_host::accuracy::Trial;

use crate::support::{Bench, Tick, ticks_of};

fn run(ticks: &[Tick], start: i64, shift: u64) -> Vec<(Estimate, Variances)> {
    let mut bench = Bench::new(15, Answer::Newest);
    ticks
        .iter()
        .map(|tick| {
            let estimate = tick.with(start, shift, |capture| bench.update(capture));
            (estimate, bench.variances())
        })
        .collect()
}

/// A swing with a reversal in it.
fn swing() -> Vec<Tick> {
    ticks_of(|t| 0.3 + 40.0 * (t / 50.0).sin() * 5.0 + 0.4 * t, 300)
}

#[test]
fn it_matters_neither_where_nor_when() {
    let here = run(&swing(), 0, 0);
    for (start, shift) in [
        (1_000_000, 0),
        (-77, 5),
        (0, u64::from(u32::MAX) - 2_000_000),
    ] {
        for (index, (there, here)) in run(&swing(), start, shift).iter().zip(&here).enumerate() {
            let moved = there.0.position.to_bits() - (start << 16);
            assert_eq!(moved, here.0.position.to_bits(), "tick {index}");
            let rest = |(estimate, variances): &(Estimate, Variances)| {
                (
                    estimate.velocity,
                    estimate.acceleration,
                    estimate.lags,
                    *variances,
                )
            };
            assert_eq!(rest(there), rest(here), "tick {index}");
        }
    }
}

#[test]
fn the_mirrored_motion_has_the_mirrored_estimates() {
    let mirrored: Vec<_> = swing()
        .into_iter()
        .map(|tick| Tick {
            count: -1 - tick.count,
            ..tick
        })
        .collect();
    for (index, ((there, _), (here, _))) in run(&mirrored, 0, 0)
        .iter()
        .zip(run(&swing(), 0, 0))
        .enumerate()
    {
        // Halves are rounded up on either side, of a place to 2⁻¹³ d: 128 LSB of a velocity over one tick.
        let apart = |one: i32, other: i32| (i64::from(one) + i64::from(other)).abs();
        let lsb = [
            apart(there.velocity.to_bits(), here.velocity.to_bits()),
            apart(there.acceleration.to_bits(), here.acceleration.to_bits()),
            (there.position.to_bits() + here.position.to_bits()).abs(),
        ];
        assert!(
            lsb[0] <= 256 && lsb[1] <= 2048 && lsb[2] <= 32,
            "tick {index}: {lsb:?}"
        );
    }
}

#[test]
fn white_noise_comes_to_the_bound() {
    const NOISE_D: f64 = 0.005;
    for (velocity, ticks) in [(150.0, 4000), (20.0, 4000), (5.0, 8000), (1.0, 20_000)] {
        for window in [8, 15, 32] {
            let config = EstimatorConfig::Polynomial(Config::new(window, Answer::Centre).unwrap());
            let mut model = EncoderModel::white(NOISE_D);
            model.encoder.timer_hz = 250e6;
            let seen = Trial {
                motion: Motion::Steady { velocity },
                encoder: model,
                tick_hz: 1000.0,
                ticks,
                errors: leadscrew::uncertainty::EdgeErrors::default(),
                seed: 7,
            }
            .observe(config)
            .unwrap();
            let wide = f64::from(window);
            if velocity * wide < 15.0 {
                continue;
            }
            let bound = (720.0 * NOISE_D * NOISE_D / (velocity * wide.powi(5))).sqrt();
            let ratio = seen.acceleration_error().rms() / bound;
            assert!(
                (0.85..1.1).contains(&ratio),
                "{velocity} d/tick, W {window}: {ratio} of the bound"
            );
        }
    }
}

#[test]
fn jitter_of_the_sampling_instant_does_not_matter() {
    let sigma = |jitter_s: f64| {
        let mut model = EncoderModel::white(0.005);
        model.encoder.sampling_jitter_s = jitter_s;
        let config = EstimatorConfig::Polynomial(Config::new(15, Answer::Centre).unwrap());
        let seen = Trial {
            motion: Motion::Steady { velocity: 130.0 },
            encoder: model,
            tick_hz: 1000.0,
            ticks: 6000,
            errors: leadscrew::uncertainty::EdgeErrors::default(),
            seed: 3,
        }
        .observe(config)
        .unwrap();
        seen.acceleration_error().rms()
    };
    let (quiet, jittery) = (sigma(0.0), sigma(20e-6));
    // 20 µs are 2.6 d at this speed; of counts they make an acceleration of 6 d/tick².
    assert!(jittery < 1.5 * quiet, "{quiet} {jittery}");
}
