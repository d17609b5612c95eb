//! Planned touches of features by their sizes.

use super::Planned;
use crate::metrology::touch::vector3;
use crate::metrology::{Axis, Nominal};

/// Touches at places of one face.
pub(super) fn of_face(places: &[[f64; 3]], normal: [f64; 3]) -> Vec<Planned> {
    let touch = |(number, nominal): (usize, &[f64; 3])| Planned {
        point: number.to_string(),
        nominal: *nominal,
        normal,
    };
    (1..).zip(places).map(touch).collect()
}

/// Touches around an axis, section by section. Angles are right-handed about it, degrees, from the axis that follows it: about z
/// from x towards y, about y from z towards x.
pub(super) fn around(
    nominal: &Nominal,
    places: &[f64],
    angles_deg: &[f64],
    inside: bool,
) -> Vec<Planned> {
    let along = nominal.axis.index();
    let [first, second] = nominal.across().map(|axis| vector3(axis.unit()));
    let mut planned = Vec::new();
    for &place in places {
        let mut centre = vector3(nominal.centre_mm);
        centre[along] = place;
        let radius = nominal.radius_at(centre.into());
        for angle in angles_deg {
            let (sine, cosine) = sine_cosine(*angle);
            let outward = first * cosine + second * sine;
            let normal = if inside { -outward } else { outward };
            planned.push(Planned {
                point: (planned.len() + 1).to_string(),
                nominal: (centre + outward * radius).into(),
                normal: normal.map(|part| part + 0.0).into(),
            });
        }
    }
    planned
}

/// Exact at quarters, so that touches along axes are that.
fn sine_cosine(angle_deg: f64) -> (f64, f64) {
    let quarter = angle_deg.rem_euclid(360.0) / 90.0;
    match quarter {
        0.0 => (0.0, 1.0),
        1.0 => (1.0, 0.0),
        2.0 => (0.0, -1.0),
        3.0 => (-1.0, 0.0),
        _ => angle_deg.to_radians().sin_cos(),
    }
}

/// Touches of a turned surface from the + side, the − side or both, at places along z.
pub(super) fn of_turned(
    nominal: &Nominal,
    places: &[f64],
    sides: &[[f64; 3]],
    inside: bool,
) -> Vec<Planned> {
    let angles: Vec<f64> = sides
        .iter()
        .map(|side| {
            if side[Axis::X.index()] > 0.0 {
                0.0
            } else {
                180.0
            }
        })
        .collect();
    around(nominal, places, &angles, inside)
}
