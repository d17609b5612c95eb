//! Movements as a control makes them, and places along them.

use std::f64::consts::TAU;

use leadscrew_nc::coordinates::Coordinates;
use leadscrew_nc::path::arc::Plane;

/// What lies between samples of an arc, mm.
const SAGITTA_MM: f64 = 1e-4;

/// The way between the ends of a movement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    Line,
    Arc {
        plane: Plane,
        /// Machine coordinates, mm.
        centre: [f64; 2],
        /// Angle turned through, rad, positive for G3.
        sweep: f64,
    },
}

/// A movement, in machine coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    pub is_feed: bool,
    pub from: Coordinates,
    pub to: Coordinates,
    pub shape: Shape,
}

impl Shape {
    /// What G2 or G3 goes along from one place to another about a centre; over less than `closed_mm` it is a full circle.
    pub fn arc(
        plane: Plane,
        from: &Coordinates,
        to: &Coordinates,
        centre: [f64; 2],
        clockwise: bool,
        closed_mm: f64,
    ) -> Self {
        let sign = if clockwise { -1.0 } else { 1.0 };
        let angle = |place: &Coordinates| {
            let [x, y] = plane.of(place);
            (y - centre[1]).atan2(x - centre[0])
        };
        let chord = plane.of(&(*to - *from));
        let turned = if chord[0].hypot(chord[1]) < closed_mm {
            TAU
        } else {
            ((angle(to) - angle(from)) * sign).rem_euclid(TAU)
        };
        Self::Arc {
            plane,
            centre,
            sweep: sign * turned,
        }
    }
}

impl Motion {
    /// Places along it, on arcs so near to each other that the lines between them are within 0.1 µm of it, and where an axis turns
    /// round.
    pub fn samples(&self) -> Vec<Coordinates> {
        let way = (self.to - self.from).length_mm();
        let count = match self.shape {
            // K bends along it.
            Shape::Line if self.is_feed => 40 + (way / 5.0) as usize,
            Shape::Line => 1,
            Shape::Arc {
                plane,
                centre,
                sweep,
            } => {
                let [x, y] = plane.of(&self.from);
                let radius = (x - centre[0]).hypot(y - centre[1]);
                (sweep.abs() * (radius / (8.0 * SAGITTA_MM)).sqrt()).ceil() as usize + 20
            }
        };
        let mut fractions: Vec<f64> = (0..=count).map(|i| i as f64 / count as f64).collect();
        if let Shape::Arc {
            plane,
            centre,
            sweep,
        } = self.shape
        {
            let [x, y] = plane.of(&self.from);
            let start = (y - centre[1]).atan2(x - centre[0]);
            let quarters = (-20..=20).map(|quarter| f64::from(quarter) * TAU / 4.0);
            fractions.extend(
                quarters
                    .map(|angle| (angle - start) / sweep)
                    .filter(|fraction| (1e-6..1.0 - 1e-6).contains(fraction)),
            );
            fractions.sort_by(f64::total_cmp);
        }
        fractions
            .into_iter()
            .map(|fraction| self.at(fraction))
            .collect()
    }

    fn at(&self, fraction: f64) -> Coordinates {
        let mut place = self.from.towards(&self.to, fraction);
        if let Shape::Arc {
            plane,
            centre,
            sweep,
        } = self.shape
        {
            let [x, y] = plane.of(&self.from);
            let (sin, cos) = (fraction * sweep).sin_cos();
            let (dx, dy) = (x - centre[0], y - centre[1]);
            let [first, second] = plane.axes();
            place[first] = centre[0] + dx * cos - dy * sin;
            place[second] = centre[1] + dx * sin + dy * cos;
        }
        place
    }
}
