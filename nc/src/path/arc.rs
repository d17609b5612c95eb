//! Arcs of a program as curves over their angle.

mod corrected;
mod fit;

use std::f64::consts::{PI, TAU};

pub use corrected::{ArcPiece, Piece, corrected};

use super::PathError;
use crate::coordinates::{Axis, Coordinates};
use crate::terms::{Approach, ROUNDING};

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

/// Nearer than this, mm, start and end are one place: a full circle.
const SAME_MM: f64 = 1e-9;

/// Nearer to an end than this, as a fraction of the way, is at the end.
const AT_AN_END: f64 = 1e-9;

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
    use super::*;
    use crate::terms::Direction;

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
