//! Planes of arcs.

use crate::coordinates::{Axis, Coordinates};

/// The plane of an arc.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Plane {
    /// G17.
    #[default]
    Xy,
    /// G18: angles count from Z to X.
    Zx,
    /// G19.
    Yz,
}

impl Plane {
    /// Its axes, so that a positive angle (G3) turns from the first to the second.
    #[must_use]
    pub const fn axes(self) -> [Axis; 2] {
        match self {
            Self::Xy => [Axis::X, Axis::Y],
            Self::Zx => [Axis::Z, Axis::X],
            Self::Yz => [Axis::Y, Axis::Z],
        }
    }

    /// The axis across it, along which a helix climbs.
    #[must_use]
    pub const fn across(self) -> Axis {
        match self {
            Self::Xy => Axis::Z,
            Self::Zx => Axis::Y,
            Self::Yz => Axis::X,
        }
    }

    /// A place's two coordinates in the plane.
    #[must_use]
    pub fn of(self, place: &Coordinates) -> [f64; 2] {
        self.axes().map(|axis| place[axis])
    }
}
