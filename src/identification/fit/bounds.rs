//! What a drive can be, and how a fit keeps to it.

use super::Problem;
use crate::identification::drive::{NO_LIMIT, PARAMETERS, Vector, place};
use crate::identification::matrix::{Matrix, part, set};

/// What a drive can be: place, least and most.
const BOUNDS: [(usize, f64, f64); 8] = [
    (place::GAIN, 1e-3, 1e6),
    (place::FRICTION, 0.0, 1e6),
    (place::LN_OMEGA, -7.0, 0.4),
    (place::LN_DAMPING, -3.5, 2.0),
    (place::DELAY, -0.9, 200.0),
    (place::DEAD_TIME, 0.0, 200.0),
    (place::MAX_ACCELERATION, 1e-6, NO_LIMIT),
    (place::LN_STRIBECK, -8.0, 8.0),
];

impl Problem<'_> {
    /// Friction that holds nothing may come out below zero, as noise has it.
    fn bounds(&self) -> impl Iterator<Item = (usize, f64, f64)> {
        let holds = self.held.is_some();
        BOUNDS.into_iter().map(move |(place, low, high)| {
            if place == place::FRICTION && !holds {
                (place, -high, high)
            } else {
                (place, low, high)
            }
        })
    }

    /// A vector within what a drive can be.
    pub(super) fn bounded(&self, vector: &Vector) -> Vector {
        let mut bounded = *vector;
        for (place, low, high) in self.bounds() {
            set(&mut bounded, place, |value| value.clamp(low, high));
        }
        bounded
    }

    /// Takes those parameters out of a step that it would carry past their bounds: the others then move as they
    /// should.
    pub(super) fn hold_at_bounds(
        &self,
        vector: &Vector,
        normal: &mut Matrix,
        gradient: &mut Vector,
    ) {
        for (place, low, high) in self.bounds() {
            let (value, pull) = (part(vector, place), part(gradient, place));
            if (value <= low && pull < 0.0) || (value >= high && pull > 0.0) {
                for other in 0..PARAMETERS {
                    normal.set(place, other, 0.0);
                    normal.set(other, place, 0.0);
                }
                normal.set(place, place, 1.0);
                set(gradient, place, |_| 0.0);
            }
        }
    }
}
