//! A cubic in t from 0 to 1 by four of its values, and how far it is from its own chord.

use crate::coordinates::Coordinates;

/// Inner Bernstein coefficients of the deviation from the chord; those at the ends are 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Deviation([Coordinates; 2]);

impl Deviation {
    /// From the values at 0, 1/3, 2/3 and 1.
    pub fn from_values([start, third, two_thirds, end]: &[Coordinates; 4]) -> Self {
        let d1 = *third - start.towards(end, 1.0 / 3.0);
        let d2 = *two_thirds - start.towards(end, 2.0 / 3.0);
        // B1 and B2 at 1/3 are 4/9 and 2/9, at 2/3 the other way round: solved for the two coefficients.
        Self([(d1 * 2.0 - d2) * 1.5, (d2 * 2.0 - d1) * 1.5])
    }

    /// A bound on the deviation, by a norm: the two inner Bernstein polynomials add up to 3/4 at most.
    pub fn bound(&self, norm: impl Fn(&Coordinates) -> f64) -> f64 {
        0.75 * norm(&self.0[0]).max(norm(&self.0[1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coordinates::Axis;

    #[test]
    fn a_parabola_reaches_its_bound_and_a_cubic_stays_below() {
        let values = |f: fn(f64) -> f64| {
            [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|t| Coordinates::xyz(f(t), 0.0, 0.0))
        };
        let bound = |f| Deviation::from_values(&values(f)).bound(|d| d[Axis::X].abs());
        // t(1 − t) is at most 1/4; its coefficients are both 1/3, so the bound is exact.
        assert!((bound(|t| 5.0 + 3.0 * t + t * (1.0 - t)) - 0.25).abs() < 1e-14);
        let cubic = |t: f64| t * (1.0 - t) * (0.5 - t);
        let largest = (0..=1000)
            .map(|i| cubic(f64::from(i) / 1000.0).abs())
            .fold(0.0, f64::max);
        assert!(bound(cubic) >= largest && bound(cubic) < 3.0 * largest);
        assert!(bound(|t| 1.0 - 2.0 * t) < 1e-15);
    }
}
