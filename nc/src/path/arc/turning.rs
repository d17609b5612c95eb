//! Where the axes of an arc turn round and pass places, and from which side they come.

use std::f64::consts::{PI, TAU};

use super::Arc;
use crate::coordinates::Axis;
use crate::terms::{Approach, ROUNDING};

/// Nearer to an end than this, as a fraction of the way, is at the end.
const AT_AN_END: f64 = 1e-9;

impl Arc {
    /// From which side each axis comes at a fraction of the way, or just after it; axes that stand keep their direction.
    #[must_use]
    pub fn approach(&self, fraction: f64, before: Approach) -> Approach {
        let mut by = self.to - self.from;
        let (sin, cos) = (self.start_angle + fraction * self.sweep).sin_cos();
        let [first, second] = self.plane.axes();
        let way = self.radii[0].max(self.radii[1]) * self.sweep;
        by[first] = -sin * way;
        by[second] = cos * way;
        before.after(&by)
    }

    /// From which side each axis came when the arc is done.
    #[must_use]
    pub fn approach_after(&self, before: Approach) -> Approach {
        // In the middle of what is left after the last turning point: at the end itself an axis may stand.
        let last = self
            .plane
            .axes()
            .into_iter()
            .flat_map(|axis| self.turns_round(axis))
            .fold(0.0, f64::max);
        self.approach(f64::midpoint(last, 1.0), before)
    }

    /// Fractions of the way at which an axis of the plane turns round. One that goes no farther than rounding of the program's
    /// numbers explains, before the first or after the last of them, does not.
    #[must_use]
    pub fn turns_round(&self, axis: Axis) -> Vec<f64> {
        let zero = match self.plane.axes().iter().position(|one| *one == axis) {
            Some(0) => 0.0,
            Some(_) => PI / 2.0,
            None => return Vec::new(),
        };
        let mut all = self.angles(&[zero, zero + PI]);
        // r·(1 − cos α) is how far the axis goes over an angle α before or behind the turning point.
        let radius = self.radii[0].max(self.radii[1]);
        let least = (1.0 - ROUNDING / radius).max(-1.0).acos() / self.sweep.abs();
        all.retain(|fraction| (least..=1.0 - least).contains(fraction));
        all
    }

    /// Fractions of the way at which a coordinate has a value.
    #[must_use]
    pub fn crosses(&self, axis: Axis, value: f64) -> Vec<f64> {
        let radius = self.radii[0].max(self.radii[1]);
        match self.plane.axes().iter().position(|one| *one == axis) {
            Some(i) => {
                let cosine = (value - self.centre[i]) / radius;
                if cosine.abs() >= 1.0 {
                    return Vec::new();
                }
                let angle = cosine.acos();
                if i == 0 {
                    self.angles(&[angle, -angle])
                } else {
                    self.angles(&[PI / 2.0 - angle, PI / 2.0 + angle])
                }
            }
            None => {
                let way = self.to[axis] - self.from[axis];
                let fraction = (value - self.from[axis]) / way;
                (fraction > 0.0 && fraction < 1.0)
                    .then_some(fraction)
                    .into_iter()
                    .collect()
            }
        }
    }

    /// Fractions of the way at which it passes angles, at each of its turns; ends do not count.
    fn angles(&self, angles: &[f64]) -> Vec<f64> {
        let mut all = Vec::new();
        for angle in angles {
            let mut way = ((angle - self.start_angle) * self.sweep.signum()).rem_euclid(TAU);
            while way < self.sweep.abs() {
                let fraction = way / self.sweep.abs();
                if (AT_AN_END..1.0 - AT_AN_END).contains(&fraction) {
                    all.push(fraction);
                }
                way += TAU;
            }
        }
        all.sort_by(f64::total_cmp);
        all
    }
}
