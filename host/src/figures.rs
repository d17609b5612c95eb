//! What the plots of simulation and replay have in common.

use leadscrew::estimator::{Estimate, EstimatorConfig};

use crate::plot::{Colour, Panel, Series};

/// Label of the time axis.
const TIME: &str = "time, s";
/// Label of a velocity axis.
pub const VELOCITY: &str = "velocity, d/tick";
/// Label of an acceleration axis.
pub const ACCELERATION: &str = "acceleration, d/tick²";
/// Label of a following-error axis.
pub const FOLLOWING_ERROR: &str = "following error, d";

/// Points of `value` over the ticks, each at the instant `lag` ticks before its own.
pub fn points<T>(
    items: &[T],
    tick_hz: f64,
    lag: impl Fn(&T) -> f64,
    value: impl Fn(&T) -> f64,
) -> Vec<(f64, f64)> {
    let at = |(tick, item): (usize, &T)| ((tick as f64 - lag(item)) / tick_hz, value(item));
    items.iter().enumerate().map(at).collect()
}

/// Velocity of an estimator at the instants it holds for.
#[must_use]
pub fn velocity_points(estimates: &[Estimate], tick_hz: f64) -> Vec<(f64, f64)> {
    points(
        estimates,
        tick_hz,
        |estimate| estimate.lags.velocity.to_num(),
        |estimate| estimate.velocity.to_num(),
    )
}

/// Acceleration of an estimator at the instants it holds for.
#[must_use]
pub fn acceleration_points(estimates: &[Estimate], tick_hz: f64) -> Vec<(f64, f64)> {
    points(
        estimates,
        tick_hz,
        |estimate| estimate.lags.acceleration.to_num(),
        |estimate| estimate.acceleration.to_num(),
    )
}

/// A curve of an estimator, which looks alike in every figure: the first of the list, plain counting,
/// is grey dots.
#[must_use]
pub fn estimator_series(name: &str, points: Vec<(f64, f64)>) -> Series {
    let place = EstimatorConfig::NAMES
        .iter()
        .position(|known| *known == name);
    match place.unwrap_or_default() {
        0 => Series::dots(name, points, Colour::Grey),
        index => Series::line(name, points, Colour::cycle(index - 1)).with_width(1.2),
    }
}

/// A panel over time.
#[must_use]
pub fn panel(y_label: &str, series: Vec<Series>) -> Panel {
    Panel::new(TIME, y_label, series)
}
