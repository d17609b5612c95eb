//! The trend of a capture, which stands in for the truth: what the axis does over many ticks.

/// Ticks to either side of the instant that a trend goes through.
pub(super) const HALF: usize = 50;
/// Largest rms distance of the counts from their trend, d: an encoder's errors, but no change of acceleration.
pub(super) const MAX_MISFIT_D: f64 = 2.0;

/// Acceleration of the trend by tick; `None` where the axis stands, turns round or changes its acceleration.
pub(super) struct Trend(Vec<Option<f64>>);

impl Trend {
    /// Of the count at each tick.
    pub(super) fn of(counts: &[i64]) -> Self {
        let around = |tick: usize| {
            let first = tick.checked_sub(HALF)?;
            steady_acceleration(counts.get(first..=tick + HALF)?)
        };
        Self((0..counts.len()).map(around).collect())
    }

    /// Acceleration `lag` ticks before a tick, between ticks by a straight line.
    pub(super) fn before(&self, tick: usize, lag: f64) -> Option<f64> {
        let instant = tick as f64 - lag;
        if instant < 0.0 {
            return None;
        }
        let (index, share) = (instant as usize, instant.fract());
        let at = |index: usize| self.0.get(index).copied().flatten();
        let earlier = at(index)?;
        let later = if share > 0.0 { at(index + 1)? } else { earlier };
        Some(earlier + share * (later - earlier))
    }

    /// Ticks with a trend.
    pub(super) fn steady_ticks(&self) -> usize {
        self.0.iter().flatten().count()
    }
}

/// Acceleration of the least-squares quadratic through an odd number of counts, if they go one way and keep to it.
fn steady_acceleration(counts: &[i64]) -> Option<f64> {
    let steps = || counts.windows(2).map(|pair| pair[1] - pair[0]);
    if !(steps().all(|step| step > 0) || steps().all(|step| step < 0)) {
        return None;
    }
    let size = counts.len() as f64;
    let half = (counts.len() / 2) as f64;
    let middle = counts[counts.len() / 2];
    let points = || {
        let place = |(index, count): (usize, &i64)| (index as f64 - half, (count - middle) as f64);
        counts.iter().enumerate().map(place)
    };
    let sum = |of: &dyn Fn(f64, f64) -> f64| points().map(|(u, x)| of(u, x)).sum::<f64>();
    let (squares, fourths) = (sum(&|u, _| u * u), sum(&|u, _| u.powi(4)));
    let bend = |u: f64| u * u - squares / size;
    let mean = sum(&|_, x| x) / size;
    let slope = sum(&|u, x| u * x) / squares;
    let curvature = sum(&|u, x| bend(u) * x) / (fourths - squares * squares / size);
    let misfit = sum(&|u, x| (x - mean - slope * u - curvature * bend(u)).powi(2)) / size;
    (misfit.sqrt() <= MAX_MISFIT_D).then_some(2.0 * curvature)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts of x = v·t + a·t²/2, with −a from the middle on.
    fn counts(velocity: f64, acceleration: f64, ticks: i32, turns: bool) -> Vec<i64> {
        let mut place = 0.0;
        let mut speed = velocity;
        let step = |tick| {
            let sign = if turns && tick > ticks / 2 { -1.0 } else { 1.0 };
            place += speed + sign * acceleration / 2.0;
            speed += sign * acceleration;
            f64::floor(place) as i64
        };
        (0..ticks).map(step).collect()
    }

    #[test]
    fn a_steady_acceleration_is_found_and_interpolated() {
        let trend = Trend::of(&counts(20.0, 0.05, 400, false));
        assert_eq!(trend.steady_ticks(), 300);
        for (tick, lag) in [(200, 0.0), (200, 7.5), (349, 0.0), (349, 299.0)] {
            let found = trend.before(tick, lag).unwrap();
            // Rounding to counts: √(720/12/101⁵) is 8e-5.
            assert!((found - 0.05).abs() < 4e-4, "{tick} {lag}: {found}");
        }
        assert_eq!(trend.before(350, 0.0), None);
        assert_eq!(trend.before(49, 0.0), None);
        assert_eq!(trend.before(10, 11.0), None);
    }

    #[test]
    fn rest_reversal_and_a_change_of_acceleration_have_no_trend() {
        assert_eq!(Trend::of(&[7; 500]).steady_ticks(), 0);
        assert_eq!(Trend::of(&counts(2.0, -0.02, 201, false)).steady_ticks(), 0);
        let kinked = Trend::of(&counts(20.0, 0.2, 400, true));
        assert_eq!(kinked.before(200, 0.0), None);
        assert!(kinked.before(120, 0.0).is_some() && kinked.before(300, 0.0).is_some());
        assert_eq!(Trend::of(&[]).steady_ticks(), 0);
    }
}
