//! Means, deviations and amplitudes of samples.

/// Mean and standard deviation.
pub fn mean_and_sigma(samples: &[f64]) -> (f64, f64) {
    let count = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / count;
    let variance = samples
        .iter()
        .map(|sample| (sample - mean).powi(2))
        .sum::<f64>()
        / count;
    (mean, variance.sqrt())
}

/// Asserts that the standard deviation is `sigma` within four times the scatter of such an estimate from
/// this many independent samples, 1/√(2n) of it.
#[track_caller]
pub fn assert_sigma(samples: &[f64], sigma: f64) {
    let (_, seen) = mean_and_sigma(samples);
    let scatter = 4.0 / (2.0 * samples.len() as f64).sqrt();
    assert!(
        (seen / sigma - 1.0).abs() < scatter,
        "{seen} instead of {sigma} from {} samples",
        samples.len()
    );
}

/// Amplitude of the sine of `order` periods over all samples.
pub fn amplitude(samples: &[f64], order: u32) -> f64 {
    let count = samples.len() as f64;
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (place, sample) in samples.iter().enumerate() {
        let angle = std::f64::consts::TAU * f64::from(order) * place as f64 / count;
        sine += sample * angle.sin();
        cosine += sample * angle.cos();
    }
    2.0 * sine.hypot(cosine) / count
}
