//! Figures of merit: rms, peak, slope.

/// Running sums of a signal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    count: u64,
    squares: f64,
    peak: f64,
}

impl Spread {
    /// Of nothing.
    pub const NONE: Self = Self {
        count: 0,
        squares: 0.0,
        peak: 0.0,
    };

    /// Takes in a value; not-a-number is passed over.
    pub fn push(&mut self, value: f64) {
        if value.is_finite() {
            self.count += 1;
            self.squares += value * value;
            self.peak = self.peak.max(value.abs());
        }
    }

    /// Both together.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        Self {
            count: self.count + other.count,
            squares: self.squares + other.squares,
            peak: self.peak.max(other.peak),
        }
    }

    /// Root of the mean square, bias included; 0 of nothing.
    #[must_use]
    pub fn rms(&self) -> f64 {
        if self.count == 0 {
            0.0
        } else {
            (self.squares / self.count as f64).sqrt()
        }
    }

    /// [`rms`](Self::rms), or `None` of nothing.
    #[must_use]
    pub fn rms_of_some(&self) -> Option<f64> {
        (self.count > 0).then(|| self.rms())
    }

    /// [`peak`](Self::peak), or `None` of nothing.
    #[must_use]
    pub fn peak_of_some(&self) -> Option<f64> {
        (self.count > 0).then_some(self.peak)
    }

    /// Largest magnitude; 0 of nothing.
    #[must_use]
    pub const fn peak(&self) -> f64 {
        self.peak
    }

    /// Values taken in.
    #[must_use]
    pub const fn count(&self) -> u64 {
        self.count
    }
}

impl Extend<f64> for Spread {
    fn extend<T: IntoIterator<Item = f64>>(&mut self, values: T) {
        values.into_iter().for_each(|value| self.push(value));
    }
}

impl FromIterator<f64> for Spread {
    fn from_iter<T: IntoIterator<Item = f64>>(values: T) -> Self {
        let mut spread = Self::default();
        spread.extend(values);
        spread
    }
}

/// Mean of some values; `None` of nothing.
#[must_use]
pub fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0_u64);
    for value in values {
        sum += value;
        count += 1;
    }
    (count > 0).then(|| sum / count as f64)
}

/// Least-squares slope of y over x; `None` for fewer than two different x.
#[must_use]
pub fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let count = points.len() as f64;
    let mean_x = points.iter().map(|point| point.0).sum::<f64>() / count;
    let mean_y = points.iter().map(|point| point.1).sum::<f64>() / count;
    let (mut across, mut along) = (0.0, 0.0);
    for (x, y) in points {
        across += (x - mean_x) * (y - mean_y);
        along += (x - mean_x) * (x - mean_x);
    }
    (along > 0.0).then(|| across / along)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_mean_and_slope_of_known_values() {
        assert_eq!(mean([1.0, 2.0, 6.0].into_iter()), Some(3.0));
        assert_eq!(mean(std::iter::empty()), None);
        let spread: Spread = [3.0, -4.0, f64::NAN].into_iter().collect();
        assert_eq!(
            (spread.rms(), spread.peak(), spread.count()),
            (12.5_f64.sqrt(), 4.0, 2)
        );
        assert_eq!(slope(&[(0.0, 1.0), (1.0, 3.0), (2.0, 5.0)]), Some(2.0));
        assert_eq!(slope(&[(1.0, 1.0), (1.0, 3.0)]), None);
        assert_eq!(slope(&[]), None);
    }
}
