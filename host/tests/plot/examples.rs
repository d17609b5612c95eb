//! Figures to test with.

use leadscrew_host::plot::{Colour, Figure, Panel, Series};

pub type Points = Vec<(f64, f64)>;

pub fn sampled(count: usize, value: impl Fn(f64) -> f64) -> Points {
    let seconds = |tick: usize| tick as f64 * 5.0 / count as f64;
    (0..count)
        .map(|k| (seconds(k), value(seconds(k))))
        .collect()
}

/// Noise of ±1 that is the same in every run.
pub fn noise(t: f64) -> f64 {
    ((t * 1e4).sin() * 43_758.545_3).fract()
}

/// The demonstration's figure: noise beneath estimates beneath the truth.
pub fn motion(count: usize) -> Figure {
    let ramp = |t: f64| (t - 0.5).clamp(0.0, 0.6) * 120.0 - (t - 3.5).clamp(0.0, 0.6) * 120.0;
    let acceleration = |t: f64| (ramp(t + 0.01) - ramp(t)) * 0.1;
    let measured = |t: f64| (acceleration(t) + 2.0 * noise(t)).round();
    let estimate = |shift: f64| sampled(count, move |t| acceleration(t) + 0.1 * noise(t + shift));
    let raw = Series::dots("difference", sampled(count, measured), Colour::Grey);
    let truth = Series::dashed("truth", sampled(count, acceleration), Colour::Black);
    let velocity = sampled(count, ramp);
    let error = sampled(count, |t| 25.0 * acceleration(t) + noise(t));
    Figure::new(
        "300 mm at 9 000 mm/min",
        vec![
            Panel::new(
                "time, s",
                "acceleration, d/tick²",
                vec![
                    raw,
                    Series::line("exponential", estimate(0.0), Colour::Blue),
                    Series::line("simple average", estimate(0.1), Colour::Vermillion),
                    Series::line("Gaussian", estimate(0.2), Colour::BluishGreen),
                    truth,
                ],
            ),
            Panel::new(
                "time, s",
                "velocity, d/tick",
                vec![Series::line("truth", velocity, Colour::Blue)],
            ),
            Panel::new(
                "time, s",
                "following error, d",
                vec![Series::line("encoder", error, Colour::ReddishPurple)],
            ),
        ],
    )
}

pub fn one_panel(series: Vec<Series>) -> Figure {
    Figure::new("", vec![Panel::new("time, s", "value", series)])
}

pub fn one_line(points: Points) -> Figure {
    one_panel(vec![Series::line("line", points, Colour::Blue)])
}
