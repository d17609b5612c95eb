//! Errors of edges before and after the map.

use crate::calibration::Curve;
use crate::plot::{Colour, Figure, Panel, Series};

/// Orders looked at in a band, evenly spread: enough for its mean.
const ORDERS_A_BAND: usize = 64;
/// Bands an octave.
const BANDS_AN_OCTAVE: i32 = 3;

/// Edge by edge: a run before and after, and after alone.
pub fn along_the_revolution(curve: &Curve) -> Figure {
    let edges = curve.before_d.len() as f64;
    let points = |errors: &[f64]| -> Vec<_> {
        (0..)
            .map(|edge: u32| f64::from(edge) / edges)
            .zip(errors.iter().copied())
            .collect()
    };
    let before = Series::line("without map", points(&curve.before_d), Colour::Vermillion);
    let after = Series::line(
        "with a map of the other runs",
        points(&curve.after_d),
        Colour::Blue,
    );
    let panel = |series| Panel::new("revolutions", "error of an edge, d", series);
    Figure::new(
        "Last run, averaged; the four phases apart",
        vec![panel(vec![before, after.clone()]), panel(vec![after])],
    )
}

/// Rms in a third of an octave over the cycles a revolution, both as powers of ten.
pub fn by_wavelength(curve: &Curve) -> Figure {
    let before = Series::line("without map", bands(&curve.before_d), Colour::Vermillion);
    let after = Series::line(
        "with a map of the other runs",
        bands(&curve.after_d),
        Colour::Blue,
    );
    Figure::new(
        "Last run, averaged, by wavelength",
        vec![Panel::new(
            "log₁₀ of cycles a revolution",
            "log₁₀ of error in d, rms in 1/3 octave",
            vec![before, after],
        )],
    )
}

/// Points (log₁₀ of the order, log₁₀ of the rms) of all bands.
fn bands(errors: &[f64]) -> Vec<(f64, f64)> {
    let highest = errors.len() / 2;
    let edge = |band: i32| 2_f64.powf((f64::from(band) - 0.5) / f64::from(BANDS_AN_OCTAVE));
    let mut points = Vec::new();
    let mut from = 1;
    for band in 0.. {
        let to = (edge(band + 1).ceil() as usize).min(highest + 1);
        if to > from {
            let rms = band_rms(errors, from, to);
            let middle = ((from * (to - 1)) as f64).sqrt();
            points.push((middle.log10(), rms.max(1e-9).log10()));
        }
        from = to.max(from);
        if from > highest {
            return points;
        }
    }
    points
}

/// Rms of the orders from `from` to below `to`.
fn band_rms(errors: &[f64], from: usize, to: usize) -> f64 {
    let stride = (to - from).div_ceil(ORDERS_A_BAND);
    let orders = (from..to).step_by(stride);
    let looked_at = orders.len() as f64;
    let squares: f64 = orders.map(|order| power(errors, order)).sum();
    (squares * (to - from) as f64 / looked_at).sqrt()
}

/// Mean square of one order.
fn power(errors: &[f64], order: usize) -> f64 {
    let edges = errors.len();
    let (mut cosine, mut sine) = (0.0, 0.0);
    for (edge, error) in errors.iter().enumerate() {
        let turn = (order * edge % edges) as f64 / edges as f64;
        let (s, c) = (turn * std::f64::consts::TAU).sin_cos();
        cosine += error * c;
        sine += error * s;
    }
    let amplitude = 2.0 * f64::hypot(cosine, sine) / edges as f64;
    // The highest order has no sine.
    if 2 * order == edges {
        amplitude * amplitude / 4.0
    } else {
        amplitude * amplitude / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_hold_all_of_the_error() {
        let edges = 600;
        let errors: Vec<f64> = (0..edges)
            .map(|edge| ((edge * 7919 % 601) as f64 / 601.0 - 0.5) + (edge as f64 / 50.0).sin())
            .collect();
        let mean = errors.iter().sum::<f64>() / edges as f64;
        let all: f64 = errors
            .iter()
            .map(|error| (error - mean).powi(2))
            .sum::<f64>()
            / edges as f64;
        let in_bands: f64 = bands(&errors)
            .iter()
            .map(|(_, rms)| 10_f64.powf(2.0 * rms))
            .sum();
        // Every second order at most is looked at in the highest ones.
        assert!((in_bands / all - 1.0).abs() < 0.1, "{in_bands} {all}");
    }
}
