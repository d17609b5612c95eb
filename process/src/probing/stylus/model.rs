//! The equations of a trigger on a ring, a boss or a sphere, and the waves of r(t) over the directions.

use nalgebra::Vector3;

use super::{Artefact, Reference};
use crate::metrology::adjustment::Model;
use crate::metrology::touch::Touch;

/// sinᵏθ·cos kφ and sinᵏθ·sin kφ of a unit vector: the real and imaginary part of (x + iy)ᵏ.
pub(super) fn wave(order: u32, direction: &Vector3<f64>) -> [f64; 2] {
    let (mut real, mut imaginary) = (1.0, 0.0);
    for _ in 0..order {
        (real, imaginary) = (
            real * direction.x - imaginary * direction.y,
            real * direction.y + imaginary * direction.x,
        );
    }
    [real, imaginary]
}

/// cos²θ − ⅓ of a unit vector.
pub(super) fn zone(direction: &Vector3<f64>) -> f64 {
    direction.z * direction.z - 1.0 / 3.0
}

/// Unknowns: the centre, r₀, the lobes by order, and on a sphere c.
pub(super) struct Probed {
    pub reference: Reference,
    /// Where the search for the centre begins.
    pub start: Vector3<f64>,
}

impl Probed {
    pub const fn dimensions(&self) -> usize {
        self.reference.artefact.dimensions()
    }

    pub const fn orders(&self) -> std::ops::RangeInclusive<u32> {
        2..=self.reference.orders
    }

    /// Where the stylus was from the centre.
    fn off_centre(&self, touch: &Touch, unknowns: &[f64]) -> Vector3<f64> {
        let mut from = Vector3::from(touch.measured) - self.start;
        for (axis, unknown) in unknowns[..self.dimensions()].iter().enumerate() {
            from[axis] -= unknown;
        }
        from
    }

    /// +1 where the stylus comes from within.
    const fn side(&self) -> f64 {
        if self.reference.artefact.is_inside() {
            1.0
        } else {
            -1.0
        }
    }

    /// How r grows with r₀, the lobes and the polar part.
    fn shape(&self, direction: &Vector3<f64>) -> Vec<f64> {
        let mut shape = vec![1.0];
        for order in self.orders() {
            shape.extend(wave(order, direction));
        }
        if self.reference.artefact == Artefact::Sphere {
            shape.push(zone(direction));
        }
        shape
    }
}

impl Model for Probed {
    const WHAT: &'static str = "a stylus";

    fn unknowns(&self) -> usize {
        self.dimensions() + self.shape(&Vector3::x()).len()
    }

    fn misfit(&self, touch: &Touch, unknowns: &[f64]) -> f64 {
        let from = self.off_centre(touch, unknowns);
        let towards = from.normalize() * self.side();
        let of_shape = self.shape(&towards).into_iter();
        let radius: f64 = of_shape
            .zip(&unknowns[self.dimensions()..])
            .map(|(slope, unknown)| slope * unknown)
            .sum();
        from.norm() - 0.5 * self.reference.diameter_mm + self.side() * radius
    }

    fn row(&self, touch: &Touch, unknowns: &[f64]) -> Vec<f64> {
        let outwards = self.off_centre(touch, unknowns).normalize();
        let side = self.side();
        let mut row: Vec<f64> = outwards.iter().copied().take(self.dimensions()).collect();
        let shape = self.shape(&(outwards * side));
        row.extend(shape.into_iter().map(|slope| -side * slope));
        row
    }

    fn why_degenerate(&self, _: &[f64]) -> String {
        let needed = self.unknowns();
        format!(
            "{needed} unknowns need touches spread all round{}: touch in more directions, or seek fewer orders of lobes",
            match self.reference.artefact {
                Artefact::Sphere => " and over several heights",
                Artefact::Ring | Artefact::Boss => "",
            }
        )
    }
}
