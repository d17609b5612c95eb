//! How two features lie to each other: coaxiality, distance, perpendicularity.

use super::bore::Bore;
use super::circle::Circle;
use super::error::MetrologyError;
use super::fitted::Fitted;
use super::nominal::Nominal;
use super::plane::Plane;
use super::touch::{Axis, vector3};

/// A value with its 1σ where there is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncertain<T> {
    /// The value.
    pub value: T,
    /// Its 1σ.
    pub sigma: Option<T>,
}

/// Roots of sums of squares, coordinate by coordinate.
fn root_sum(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|index| a[index].hypot(b[index]))
}

/// A turn of the table by 180° between the measurements of two features.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableTurn {
    /// The axis that the table turns about.
    pub about: Axis,
    /// Planned place of the pivot, mm; its coordinate along the axis of the table does not matter.
    pub pivot_mm: [f64; 3],
    /// Measured less planned place of the pivot, mm.
    pub pivot_offset_mm: [f64; 3],
    /// 1σ of that, mm.
    pub pivot_sigma_mm: [f64; 3],
}

impl TableTurn {
    /// A planned place seen before the turn, as a place after it, or the other way round.
    #[must_use]
    pub fn turned(&self, place: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|index| {
            if index == self.about.index() {
                place[index]
            } else {
                2.0 * self.pivot_mm[index] - place[index]
            }
        })
    }

    /// A deviation measured after the turn, as it is on the workpiece before it: the coordinates across the table's axis change
    /// their sign, and the offset of the pivot enters twice.
    #[must_use]
    pub fn deviation(&self, after: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|index| {
            if index == self.about.index() {
                after[index]
            } else {
                2.0 * self.pivot_offset_mm[index] - after[index]
            }
        })
    }

    fn sigma(&self, after: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|index| {
            if index == self.about.index() {
                after[index]
            } else {
                after[index].hypot(2.0 * self.pivot_sigma_mm[index])
            }
        })
    }
}

/// Offset of the table's pivot from one feature measured before and after a turn by 180°, mm: the mean of its deviations, across
/// the table's axis.
#[must_use]
pub fn pivot_offset(before: [f64; 3], after: [f64; 3], about: Axis) -> [f64; 3] {
    std::array::from_fn(|index| {
        if index == about.index() {
            0.0
        } else {
            (before[index] + after[index]) / 2.0
        }
    })
}

/// A circle beside its planned place.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    /// As planned.
    pub nominal: &'a Nominal,
    /// As measured.
    pub circle: &'a Fitted<Circle>,
}

/// How two holes lie to each other, P4 (3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coaxiality {
    /// Offset of hole I against hole II across their axis, e_x, e_z of P4, mm.
    pub offset_mm: [f64; 3],
    /// Its length e, mm.
    pub eccentricity_mm: f64,
    /// Rotations λ, β, γ of the line through both centres, rad.
    pub rotation: [f64; 3],
}

/// Coaxiality of holes I and II; `turn` if the table was turned by 180° before hole II was measured, whose places are then those
/// after the turn.
///
/// # Errors
/// Axes that are not parallel, centres not seen in both directions, or no distance along the axis.
pub fn coaxiality(
    first: Placed<'_>,
    second: Placed<'_>,
    turn: Option<&TableTurn>,
) -> Result<Uncertain<Coaxiality>, MetrologyError> {
    const WHAT: &str = "a coaxiality";
    let axis = common_axis(WHAT, first, second)?;
    let (mut second_place, mut second_centre) =
        (second.nominal.centre_mm, second.circle.value.centre_mm);
    let mut second_sigma = second.circle.sigma.map(|sigma| sigma.centre_mm);
    if let Some(turn) = turn {
        if turn.about == axis {
            return Err(wrong(WHAT, "a turn about the axis of the holes itself"));
        }
        second_place = turn.turned(second_place);
        second_centre = turn.deviation(second_centre);
        second_sigma = second_sigma.map(|sigma| turn.sigma(sigma));
    }
    let distance = second_place[axis.index()] - first.nominal.centre_mm[axis.index()];
    if distance.abs() < 1e-6 {
        return Err(wrong(
            WHAT,
            "both holes are planned at one place along the axis",
        ));
    }
    let mut offset = vector3(first.circle.value.centre_mm) - vector3(second_centre);
    offset[axis.index()] = 0.0;
    // Slope of the line through the centres, then ω = axis × slope: P4 with y_II − y_I below.
    let rotation = |offset| vector3(axis.unit()).cross(&(offset / -distance));
    let sigma = match (first.circle.sigma, second_sigma) {
        (Some(first), Some(second)) => {
            let mut sigma = root_sum(first.centre_mm, second);
            sigma[axis.index()] = 0.0;
            let along = offset.norm();
            Some(Coaxiality {
                offset_mm: sigma,
                eccentricity_mm: length_sigma(offset.into(), along, sigma),
                rotation: rotation(vector3(sigma)).map(f64::abs).into(),
            })
        }
        _ => None,
    };
    Ok(Uncertain {
        value: Coaxiality {
            offset_mm: offset.into(),
            eccentricity_mm: offset.norm(),
            rotation: rotation(offset).into(),
        },
        sigma,
    })
}

/// 1σ of a length by the 1σ of its coordinates; at length 0 the largest of these.
fn length_sigma(vector: [f64; 3], length: f64, sigma: [f64; 3]) -> f64 {
    if length == 0.0 {
        return sigma.into_iter().fold(0.0, f64::max);
    }
    let part = |index: usize| (vector[index] / length * sigma[index]).powi(2);
    (part(0) + part(1) + part(2)).sqrt()
}

/// Distance of two centres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// As measured, mm: L_φ of P4 (4).
    pub measured_mm: f64,
    /// Measured less planned, mm.
    pub deviation_mm: f64,
}

/// Distance of two centres across their axis, P4 (4).
///
/// # Errors
/// Axes that are not parallel, centres not seen in both directions, or planned at one place.
pub fn distance(
    first: Placed<'_>,
    second: Placed<'_>,
) -> Result<Uncertain<Distance>, MetrologyError> {
    const WHAT: &str = "a distance of centres";
    let axis = common_axis(WHAT, first, second)?;
    let mut planned = vector3(second.nominal.centre_mm) - vector3(first.nominal.centre_mm);
    planned[axis.index()] = 0.0;
    if planned.norm() < 1e-6 {
        return Err(wrong(WHAT, "both centres are planned at one place"));
    }
    let deviation = vector3(second.circle.value.centre_mm) - vector3(first.circle.value.centre_mm);
    let vector = planned + deviation;
    let measured = vector.norm();
    let sigma = match (first.circle.sigma, second.circle.sigma) {
        (Some(first), Some(second)) => {
            let sigma = root_sum(first.centre_mm, second.centre_mm);
            let sigma = length_sigma(vector.into(), measured, sigma);
            Some(Distance {
                measured_mm: sigma,
                deviation_mm: sigma,
            })
        }
        _ => None,
    };
    Ok(Uncertain {
        value: Distance {
            measured_mm: measured,
            deviation_mm: measured - planned.norm(),
        },
        sigma,
    })
}

/// Rotation of an axis less that of a face square to it: λ, β, γ, rad; 0 about the axis. P4 Figure 4.
///
/// # Errors
/// An axis not seen in both directions.
pub fn perpendicularity(
    axis: (&Nominal, &Fitted<Bore>),
    face: &Fitted<Plane>,
) -> Result<Uncertain<[f64; 3]>, MetrologyError> {
    const WHAT: &str = "a perpendicularity";
    let (nominal, bore) = axis;
    if !nominal
        .across()
        .iter()
        .all(|across| bore.value.seen[across.index()])
    {
        return Err(wrong(
            WHAT,
            "the axis is not seen in both directions across it",
        ));
    }
    let about_it = nominal.axis.index();
    let mut value: [f64; 3] = (vector3(bore.value.rotation) - vector3(face.value.rotation)).into();
    value[about_it] = 0.0;
    let sigma = match (&bore.sigma, &face.sigma) {
        (Some(axis), Some(face)) => {
            let mut sigma = root_sum(axis.rotation, face.rotation);
            sigma[about_it] = 0.0;
            Some(sigma)
        }
        _ => None,
    };
    Ok(Uncertain { value, sigma })
}

fn common_axis(
    what: &'static str,
    first: Placed<'_>,
    second: Placed<'_>,
) -> Result<Axis, MetrologyError> {
    let axis = first.nominal.axis;
    if second.nominal.axis != axis {
        return Err(wrong(what, "the axes of the two are not parallel"));
    }
    let seen_whole = |one: Placed<'_>| {
        let across = one.nominal.across();
        across
            .iter()
            .all(|across| one.circle.value.seen[across.index()])
    };
    if !(seen_whole(first) && seen_whole(second)) {
        return Err(wrong(
            what,
            "a centre is seen in one direction only: touch it in both",
        ));
    }
    Ok(axis)
}

fn wrong(what: &'static str, reason: &str) -> MetrologyError {
    MetrologyError::Impossible {
        what,
        reason: reason.to_owned(),
    }
}
