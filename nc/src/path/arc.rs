//! Arcs of a program as curves over their angle, in a `plane`: `turning` says where axes turn round on them, `corrected` what a
//! correction makes of them, arcs that `fit`.

mod corrected;
mod fit;
mod plane;
mod turning;

use std::f64::consts::TAU;

pub use corrected::{ArcPiece, Piece, corrected};
pub use plane::Plane;

use super::PathError;
use crate::coordinates::Coordinates;

/// Nearer than this, mm, start and end are one place: a full circle.
const SAME_MM: f64 = 1e-9;

/// An arc in machine coordinates: a circle in its plane, all other axes going along with the angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Its plane.
    pub plane: Plane,
    /// Where it starts.
    pub from: Coordinates,
    /// Where it ends.
    pub to: Coordinates,
    /// Its centre in the plane, mm.
    pub centre: [f64; 2],
    /// Radii at start and end, mm: they differ by what the control tolerates.
    pub radii: [f64; 2],
    /// Angle at the start, rad.
    pub start_angle: f64,
    /// Angle it turns through, rad: positive for G3, with all of its turns.
    pub sweep: f64,
}

fn polar([x, y]: [f64; 2], centre: [f64; 2]) -> (f64, f64) {
    let (dx, dy) = (x - centre[0], y - centre[1]);
    (dx.hypot(dy), dy.atan2(dx))
}

fn is_one_place(plane: Plane, one: &Coordinates, other: &Coordinates) -> bool {
    let ([ax, ay], [bx, by]) = (plane.of(one), plane.of(other));
    (bx - ax).hypot(by - ay) <= SAME_MM
}

impl Arc {
    /// An arc with its centre given (I, J, K resolved to a place in the plane). Ends where it starts: a full circle. `turns` is
    /// the number of times the end is reached, 1 for an ordinary arc (LinuxCNC's P).
    ///
    /// # Errors
    /// No radius, or radii at start and end that differ by more than the control tolerates.
    pub fn from_centre(
        plane: Plane,
        from: Coordinates,
        to: Coordinates,
        centre: [f64; 2],
        clockwise: bool,
        turns: u32,
        radius_tolerance_mm: f64,
    ) -> Result<Self, PathError> {
        let (start_mm, start_angle) = polar(plane.of(&from), centre);
        let (end_mm, end_angle) = polar(plane.of(&to), centre);
        if start_mm == 0.0 || end_mm == 0.0 {
            return Err(PathError::NoRadius);
        }
        // Not a number is not within it either.
        let within = (start_mm - end_mm).abs() <= radius_tolerance_mm;
        if !within {
            return Err(PathError::Radii {
                start_mm,
                end_mm,
                tolerance_mm: radius_tolerance_mm,
            });
        }
        let forward = if is_one_place(plane, &from, &to) {
            TAU
        } else if clockwise {
            (start_angle - end_angle).rem_euclid(TAU)
        } else {
            (end_angle - start_angle).rem_euclid(TAU)
        };
        let whole = TAU * f64::from(turns.saturating_sub(1));
        Ok(Self {
            plane,
            from,
            to,
            centre,
            radii: [start_mm, end_mm],
            start_angle,
            sweep: (forward + whole) * if clockwise { -1.0 } else { 1.0 },
        })
    }

    /// An arc with its radius given: the shorter of the two, the longer where the radius is negative.
    ///
    /// # Errors
    /// An end that is the start, or too far for the radius by more than the control tolerates.
    pub fn from_radius(
        plane: Plane,
        from: Coordinates,
        to: Coordinates,
        radius_mm: f64,
        clockwise: bool,
        turns: u32,
        radius_tolerance_mm: f64,
    ) -> Result<Self, PathError> {
        let ([ax, ay], [bx, by]) = (plane.of(&from), plane.of(&to));
        let (dx, dy) = (bx - ax, by - ay);
        let half_chord_mm = dx.hypot(dy) / 2.0;
        if 2.0 * half_chord_mm <= SAME_MM {
            return Err(PathError::NoChord);
        }
        let radius = radius_mm.abs();
        let short = half_chord_mm - radius;
        if short.is_nan() || short > radius_tolerance_mm {
            return Err(PathError::RadiusTooSmall {
                radius_mm: radius,
                half_chord_mm,
            });
        }
        let beside = (radius * radius - half_chord_mm * half_chord_mm)
            .max(0.0)
            .sqrt();
        // To the left of the way for a short arc in the positive sense.
        let left = if clockwise == (radius_mm < 0.0) {
            beside
        } else {
            -beside
        };
        let chord = 2.0 * half_chord_mm;
        let centre = [
            f64::midpoint(ax, bx) - dy / chord * left,
            f64::midpoint(ay, by) + dx / chord * left,
        ];
        // Both radii are the same by construction, up to rounding.
        Self::from_centre(plane, from, to, centre, clockwise, turns, f64::INFINITY)
    }

    /// True where it ends where it starts: one or more full circles.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        is_one_place(self.plane, &self.from, &self.to)
    }

    /// The place at a fraction of the way, 0 to 1.
    #[must_use]
    pub fn at(&self, fraction: f64) -> Coordinates {
        if fraction <= 0.0 {
            return self.from;
        }
        if fraction >= 1.0 {
            return self.to;
        }
        self.at_direction(fraction, self.direction(fraction))
    }

    /// From the centre to the place at a fraction of the way, of length 1.
    fn direction(&self, fraction: f64) -> [f64; 2] {
        let (sin, cos) = (self.start_angle + fraction * self.sweep).sin_cos();
        [cos, sin]
    }

    /// The place at a fraction of the way, whose direction from the centre is known.
    fn at_direction(&self, fraction: f64, [cos, sin]: [f64; 2]) -> Coordinates {
        let mut place = self.from.towards(&self.to, fraction);
        let radius = self.radii[0] + fraction * (self.radii[1] - self.radii[0]);
        let [first, second] = self.plane.axes();
        place[first] = self.centre[0] + radius * cos;
        place[second] = self.centre[1] + radius * sin;
        place
    }

    /// The part between two fractions of the way.
    fn part(&self, a: f64, b: f64) -> Self {
        let radius = |t: f64| self.radii[0] + t * (self.radii[1] - self.radii[0]);
        Self {
            from: self.at(a),
            to: self.at(b),
            radii: [radius(a), radius(b)],
            start_angle: self.start_angle + a * self.sweep,
            sweep: (b - a) * self.sweep,
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::coordinates::Axis;
    use crate::terms::{Approach, Direction};

    fn arc(to: Coordinates, centre: [f64; 2], clockwise: bool) -> Arc {
        let from = Coordinates::xyz(10.0, 0.0, 0.0);
        Arc::from_centre(Plane::Xy, from, to, centre, clockwise, 1, 1e-3).unwrap()
    }

    #[test]
    fn centre_form_full_circles_and_helices() {
        let quarter = arc(Coordinates::xyz(0.0, 10.0, 4.0), [0.0, 0.0], false);
        assert!((quarter.sweep - PI / 2.0).abs() < 1e-12);
        let half = quarter.at(0.5);
        assert!((half[Axis::X] - 50.0_f64.sqrt()).abs() < 1e-12 && half[Axis::Z] == 2.0);
        let other_way = arc(Coordinates::xyz(0.0, 10.0, 0.0), [0.0, 0.0], true);
        assert!((other_way.sweep + 1.5 * PI).abs() < 1e-12);
        assert_eq!(arc(quarter.from, [5.0, 0.0], true).sweep, -TAU);
    }

    #[test]
    fn angles_of_the_planes_turn_from_first_to_second() {
        // G18 G3 from Z+ to X+.
        let from = Coordinates::xyz(0.0, 0.0, 10.0);
        let to = Coordinates::xyz(10.0, 0.0, 0.0);
        let arc = Arc::from_centre(Plane::Zx, from, to, [0.0, 0.0], false, 1, 1e-3).unwrap();
        assert!((arc.sweep - PI / 2.0).abs() < 1e-12);
    }

    #[test]
    fn the_sign_of_r_chooses_the_arc() {
        let from = Coordinates::xyz(10.0, 0.0, 0.0);
        let to = Coordinates::xyz(0.0, 10.0, 0.0);
        let sweep = |radius, clockwise| {
            let arc = Arc::from_radius(Plane::Xy, from, to, radius, clockwise, 1, 1e-3).unwrap();
            (arc.sweep / (PI / 2.0), arc.centre)
        };
        for (radius, clockwise, quarters, centre) in [
            (10.0, false, 1.0, [0.0, 0.0]),
            (-10.0, false, 3.0, [10.0, 10.0]),
            (10.0, true, -1.0, [10.0, 10.0]),
            (-10.0, true, -3.0, [0.0, 0.0]),
        ] {
            let (got, at) = sweep(radius, clockwise);
            assert!((got - quarters).abs() < 1e-9, "{radius} {clockwise}: {got}");
            assert!((at[0] - centre[0]).hypot(at[1] - centre[1]) < 1e-9);
        }
    }

    #[test]
    fn impossible_arcs_are_refused() {
        let from = Coordinates::xyz(10.0, 0.0, 0.0);
        let to = Coordinates::xyz(0.0, 10.1, 0.0);
        let centre =
            |tolerance| Arc::from_centre(Plane::Xy, from, to, [0.0, 0.0], false, 1, tolerance);
        assert!(matches!(centre(0.05), Err(PathError::Radii { .. })));
        assert!(centre(0.2).is_ok());
        let radius = |r, to| Arc::from_radius(Plane::Xy, from, to, r, false, 1, 1e-3);
        assert!(matches!(
            radius(5.0, to),
            Err(PathError::RadiusTooSmall { .. })
        ));
        assert_eq!(radius(5.0, from), Err(PathError::NoChord));
        let no_radius = Arc::from_centre(Plane::Xy, from, to, [10.0, 0.0], false, 1, 1e3);
        assert_eq!(no_radius, Err(PathError::NoRadius));
        assert!(radius(f64::NAN, to).is_err());
    }

    #[test]
    fn it_knows_where_axes_turn_round_and_cross_a_place() {
        let circle = arc(Coordinates::xyz(10.0, 0.0, 0.0), [0.0, 0.0], false);
        assert_eq!(circle.turns_round(Axis::Y), [0.25, 0.75]);
        assert_eq!(circle.turns_round(Axis::X), [0.5]);
        for fraction in circle.crosses(Axis::X, 5.0) {
            assert!((circle.at(fraction)[Axis::X] - 5.0).abs() < 1e-12);
        }
        assert_eq!(circle.crosses(Axis::X, 5.0).len(), 2);
        assert!(circle.crosses(Axis::Y, 11.0).is_empty());
        let up = circle.approach(0.1, Approach::UNKNOWN);
        assert_eq!(up.of(Axis::Y), Some(Direction::Up));
        assert_eq!(up.of(Axis::X), Some(Direction::Down));
        assert_eq!(up.of(Axis::Z), None);
    }
}
