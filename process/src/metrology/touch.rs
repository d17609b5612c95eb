//! One touch of a surface: where it was planned, which way the surface looks, where it was found.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// The coordinates of a workpiece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// x; rotation about it is λ.
    X,
    /// y; rotation about it is β.
    Y,
    /// z; rotation about it is γ.
    Z,
}

impl Axis {
    /// All, in order.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// Its place in a vector.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The axis that follows in the right-handed order x, y, z, x.
    #[must_use]
    pub const fn next(self) -> Self {
        match self {
            Self::X => Self::Y,
            Self::Y => Self::Z,
            Self::Z => Self::X,
        }
    }

    /// The unit vector along it.
    #[must_use]
    pub fn unit(self) -> [f64; 3] {
        let mut unit = [0.0; 3];
        unit[self.index()] = 1.0;
        unit
    }

    /// `x`, `y` or `z`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        ["x", "y", "z"][self as usize]
    }

    /// The Greek letter of the rotation about it.
    #[must_use]
    pub const fn rotation_name(self) -> &'static str {
        ["λ", "β", "γ"][self as usize]
    }

    /// The axis that a vector lies along, either way; none if it is oblique.
    #[must_use]
    pub fn along(vector: [f64; 3]) -> Option<Self> {
        let length = vector3(vector).norm();
        let along = |axis: &Self| vector[axis.index()].abs() >= length * (1.0 - 1e-9);
        Self::ALL.into_iter().find(along)
    }
}

/// A touch, all in the coordinates of the workpiece, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// The planned place on the surface.
    pub nominal: [f64; 3],
    /// Which way the surface looks: out of the material, of length 1. The probe comes against it.
    pub normal: [f64; 3],
    /// The place found, on the surface: the stylus is taken off already.
    pub measured: [f64; 3],
    /// 1σ of the place along the normal; none if nobody states one.
    pub sigma_mm: Option<f64>,
}

impl Touch {
    /// A touch of which the place is known. `normal` may have any length but 0.
    #[must_use]
    pub fn at(nominal: [f64; 3], normal: [f64; 3], measured: [f64; 3]) -> Self {
        Self {
            nominal,
            normal: vector3(normal).normalize().into(),
            measured,
            sigma_mm: None,
        }
    }

    /// A touch of which only the deviation along the normal is known, mm, positive out of the material.
    #[must_use]
    pub fn off_by(nominal: [f64; 3], normal: [f64; 3], along_normal_mm: f64) -> Self {
        let normal = vector3(normal).normalize();
        let measured = vector3(nominal) + normal * along_normal_mm;
        Self::at(nominal, normal.into(), measured.into())
    }

    /// The same touch with a stated 1σ, mm.
    #[must_use]
    pub const fn with_sigma(mut self, sigma_mm: f64) -> Self {
        self.sigma_mm = Some(sigma_mm);
        self
    }

    /// Measured less planned place along the normal, mm, positive out of the material.
    #[must_use]
    pub fn along_normal_mm(&self) -> f64 {
        (vector3(self.measured) - vector3(self.nominal)).dot(&vector3(self.normal))
    }

    /// Δ of P4: measured less planned coordinate, mm, positive along the axis.
    #[must_use]
    pub fn deviation_mm(&self, axis: Axis) -> f64 {
        self.measured[axis.index()] - self.nominal[axis.index()]
    }

    /// Whether every number is finite, the normal is not 0, and a stated 1σ is positive.
    pub(super) fn is_usable(&self) -> bool {
        let places = [self.nominal, self.normal, self.measured];
        let finite = places.iter().flatten().all(|value| value.is_finite());
        finite
            && vector3(self.normal).norm() > 0.5
            && self
                .sigma_mm
                .is_none_or(|sigma| sigma.is_finite() && sigma > 0.0)
    }
}

pub(super) fn vector3(vector: [f64; 3]) -> Vector3<f64> {
    Vector3::from(vector)
}
