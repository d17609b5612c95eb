//! The fixed-point fit against the least-squares quadratic of the same samples in `f64`.

use leadscrew::estimator::polynomial::Answer;

use crate::support::{Bench, CLOCKS, Tick, ticks_of};

/// Place and time (ticks) of the sample that a tick's edges make.
fn sample(before: i64, tick: &Tick) -> Option<(f64, f64)> {
    if tick.times.is_empty() {
        return None;
    }
    let place = (before + tick.count + 1) as f64 / 2.0;
    let total: u64 = tick.times.iter().sum();
    let time = total as f64 / tick.times.len() as f64 / f64::from(CLOCKS);
    Some((time, place))
}

/// Place, velocity and acceleration at `at` of the quadratic through samples (time, place).
fn quadratic(samples: &[(f64, f64)], at: f64) -> [f64; 3] {
    let count = samples.len() as f64;
    let place = samples.iter().map(|sample| sample.1).sum::<f64>() / count;
    let mut sums = [0.0; 5];
    let mut products = [0.0; 3];
    for &(time, x) in samples {
        for (power, sum) in sums.iter_mut().enumerate() {
            *sum += (time - at).powi(power as i32);
        }
        for (power, product) in products.iter_mut().enumerate() {
            *product += (x - place) * (time - at).powi(power as i32);
        }
    }
    let [x, v, c] = solve(sums, products);
    [place + x, v, 2.0 * c]
}

/// Cramer's rule.
fn solve(s: [f64; 5], p: [f64; 3]) -> [f64; 3] {
    let columns = [[s[0], s[1], s[2]], [s[1], s[2], s[3]], [s[2], s[3], s[4]]];
    let determinant = |m: [[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[1][0] * (m[0][1] * m[2][2] - m[0][2] * m[2][1])
            + m[2][0] * (m[0][1] * m[1][2] - m[0][2] * m[1][1])
    };
    let whole = determinant(columns);
    [0, 1, 2].map(|unknown| {
        let mut replaced = columns;
        replaced[unknown] = p;
        determinant(replaced) / whole
    })
}

/// Largest differences from the oracle in place, velocity and acceleration on a motion, after the start.
fn worst(window: u32, motion: impl Fn(f64) -> f64, ticks: u32) -> [f64; 3] {
    let mut bench = Bench::new(window, Answer::Newest);
    let mut samples: Vec<(f64, f64)> = Vec::new();
    let mut before = motion(0.0).floor() as i64;
    let mut worst = [0.0_f64; 3];
    // The first capture is the origin.
    bench.update(&leadscrew::hal::Capture {
        count: before as u32,
        ..Default::default()
    });
    for (index, tick) in ticks_of(&motion, ticks).iter().enumerate() {
        let now = index as f64 + 1.0;
        samples.extend(sample(before, tick));
        before = tick.count;
        samples.retain(|(time, _)| now - time < f64::from(window) - 0.25);
        let estimate = tick.with(0, 0, |capture| bench.update(capture));
        if index as u32 > 4 * window && samples.len() >= 4 {
            let exact = quadratic(&samples, now);
            let found: [f64; 3] = [
                estimate.position.to_num(),
                estimate.velocity.to_num(),
                estimate.acceleration.to_num(),
            ];
            for ((worst, found), exact) in worst.iter_mut().zip(found).zip(exact) {
                *worst = worst.max((found - exact).abs());
            }
        }
    }
    worst
}

#[test]
fn the_fit_is_that_of_floating_point() {
    // Of a place 2⁻¹⁴ d, of the end of a window some nine times that, over its length for the velocity. The ideal
    // quadratic has every time where it is; bridging a quarter of a tick adds less than that.
    for (window, bounds) in [
        (8, [1.5e-4, 1.2e-4, 4e-5]),
        (15, [1.2e-4, 6e-5, 1e-5]),
        (64, [1.2e-4, 3e-5, 2e-6]),
    ] {
        for velocity in [150.3, -77.77, 9.61, 2.37] {
            let steady = worst(window, |t| 0.3 + velocity * t, 400);
            let curved = worst(
                window,
                |t| 0.3 + velocity * t + 0.5 * 0.05 * velocity.signum() * t * t,
                400,
            );
            for found in [steady, curved] {
                for (found, bound) in found.iter().zip(bounds) {
                    assert!(
                        *found < bound,
                        "W {window}, {velocity} d/tick: {steady:?} {curved:?}"
                    );
                }
            }
        }
    }
}
