//! A term whose K can be worked out by heart.

use leadscrew_nc::coordinates::{Axis, AxisSet, Coordinates};
use leadscrew_nc::terms::{Circumstances, Region, Shape, Steepness, Term, TermError};

/// K of one axis from the place of another: `k0 + k1·p + k2·p²`, mm.
#[derive(Clone, Copy, Debug)]
pub struct Polynomial {
    pub corrects: Axis,
    pub over: Axis,
    pub k0: f64,
    pub k1: f64,
    pub k2: f64,
}

impl Term for Polynomial {
    fn name(&self) -> &str {
        "polynomial"
    }
    fn correction(&self, at: &Coordinates, _: &Circumstances) -> Result<Coordinates, TermError> {
        let p = at[self.over];
        Ok(Coordinates::ZERO.with(self.corrects, self.k0 + self.k1 * p + self.k2 * p * p))
    }
    fn corrects(&self) -> AxisSet {
        AxisSet::of(self.corrects)
    }
    fn depends_on(&self) -> AxisSet {
        if self.k1 == 0.0 && self.k2 == 0.0 {
            AxisSet::NONE
        } else {
            AxisSet::of(self.over)
        }
    }
    fn shape(&self) -> Shape {
        match (self.k1 == 0.0, self.k2 == 0.0) {
            (true, true) => Shape::Constant,
            (false, true) => Shape::Affine,
            _ => Shape::Curved,
        }
    }
    fn steepness(&self, within: &Region) -> Steepness {
        let far = within.farthest_from(self.over, 0.0);
        Steepness {
            slope: self.k1.abs() + 2.0 * self.k2.abs() * far,
            bend: 2.0 * self.k2.abs(),
        }
    }
}
