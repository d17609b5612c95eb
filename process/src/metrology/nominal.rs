//! A round feature as planned.

use nalgebra::Vector2;

use super::touch::{Axis, Touch};

/// A round feature as planned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nominal {
    /// The direction of its axis.
    pub axis: Axis,
    /// A place on the axis, mm; its coordinate along the axis is where a tilted axis is told: the face.
    pub centre_mm: [f64; 3],
    /// The planned diameter there, mm.
    pub diameter_mm: f64,
    /// How the planned diameter grows along the axis, mm per mm.
    pub taper: f64,
}

impl Nominal {
    /// A feature of constant diameter.
    #[must_use]
    pub const fn straight(axis: Axis, centre_mm: [f64; 3], diameter_mm: f64) -> Self {
        Self {
            axis,
            centre_mm,
            diameter_mm,
            taper: 0.0,
        }
    }

    /// The two axes square to its axis, right-handed with it: x, y for z; z, x for y.
    #[must_use]
    pub const fn across(&self) -> [Axis; 2] {
        [self.axis.next(), self.axis.next().next()]
    }

    pub(super) fn height(&self, place: [f64; 3]) -> f64 {
        place[self.axis.index()] - self.centre_mm[self.axis.index()]
    }

    pub(super) fn offset(&self, place: [f64; 3]) -> Vector2<f64> {
        let offset = |axis: Axis| place[axis.index()] - self.centre_mm[axis.index()];
        let [first, second] = self.across();
        Vector2::new(offset(first), offset(second))
    }

    /// From the axis to the planned place of a touch, of length 1.
    pub(super) fn outward(&self, touch: &Touch) -> Vector2<f64> {
        self.offset(touch.nominal).normalize()
    }

    /// The planned radius at the height of a place, mm.
    pub(super) fn radius_at(&self, place: [f64; 3]) -> f64 {
        (self.diameter_mm + self.taper * self.height(place)) / 2.0
    }

    /// Deviation of the radius at a touch, mm, seen from the planned axis along the planned direction.
    pub(super) fn radial_deviation(&self, touch: &Touch) -> f64 {
        let across = self.offset(touch.measured).dot(&self.outward(touch));
        across - self.radius_at(touch.nominal)
    }
}
