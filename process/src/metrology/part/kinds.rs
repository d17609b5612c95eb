//! Touched features as the file has them.

use leadscrew_nc::source::Complaint;
use serde::Deserialize;
use toml::Spanned;

use super::{Kind, Planned, direction, expand};
use crate::metrology::bore::Diameters;
use crate::metrology::{Axis, Nominal};

/// Lengths in files: no machine is larger, mm.
pub(super) const LONGEST_MM: f64 = 100_000.0;

/// A value of the file with a check of its range.
pub(super) fn checked(
    text: &str,
    value: &Spanned<f64>,
    key: &str,
    unit: &str,
    (low, high): (f64, f64),
) -> Result<f64, Complaint> {
    let number = *value.get_ref();
    if (low..=high).contains(&number) {
        return Ok(number);
    }
    let message = format!("{key} = {number} {unit}: allowed are {low} to {high} {unit}");
    Err(Complaint::at(text, &value.span(), message))
}

/// Lengths that may be negative.
pub(super) fn places<const N: usize>(
    text: &str,
    value: &Spanned<[f64; N]>,
    key: &str,
) -> Result<[f64; N], Complaint> {
    let all = *value.get_ref();
    match all
        .iter()
        .find(|one| one.is_nan() || one.abs() > LONGEST_MM)
    {
        None => Ok(all),
        Some(one) => Err(Complaint::at(
            text,
            &value.span(),
            format!("{key} has {one} mm: allowed are -{LONGEST_MM} to {LONGEST_MM} mm"),
        )),
    }
}

fn all_places<const N: usize>(
    text: &str,
    values: &[Spanned<[f64; N]>],
    key: &str,
) -> Result<Vec<[f64; N]>, Complaint> {
    values
        .iter()
        .map(|value| places(text, value, key))
        .collect()
}

pub(super) fn numbers(
    text: &str,
    values: &[Spanned<f64>],
    key: &str,
    unit: &str,
    range: (f64, f64),
) -> Result<Vec<f64>, Complaint> {
    values
        .iter()
        .map(|value| checked(text, value, key, unit, range))
        .collect()
}

/// The direction of a face along an axis or oblique.
fn normal(text: &str, value: &Spanned<String>) -> Result<[f64; 3], Complaint> {
    direction(value.get_ref()).ok_or_else(|| {
        let message = format!(
            "`{}`: expected a direction such as \"+z\" or \"-x\", or three numbers \"0.6 0 0.8\"",
            value.get_ref()
        );
        Complaint::at(text, &value.span(), message)
    })
}

/// Coordinates of files, mm.
pub(super) const COORDINATE: (f64, f64) = (-LONGEST_MM, LONGEST_MM);
const LENGTH: (f64, f64) = (1e-6, LONGEST_MM);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlaneFile {
    pub name: Spanned<String>,
    normal: Spanned<String>,
    #[serde(default)]
    points_mm: Vec<Spanned<[f64; 3]>>,
}

impl PlaneFile {
    pub fn read(&self, text: &str) -> Result<(Kind, Vec<Planned>), Complaint> {
        let places = all_places(text, &self.points_mm, "points_mm")?;
        Ok((
            Kind::Plane,
            expand::of_face(&places, normal(text, &self.normal)?),
        ))
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ShoulderFile {
    pub name: Spanned<String>,
    normal: Spanned<String>,
    along: Axis,
    #[serde(default)]
    points_mm: Vec<Spanned<[f64; 3]>>,
}

impl ShoulderFile {
    pub fn read(&self, text: &str) -> Result<(Kind, Vec<Planned>), Complaint> {
        let places = all_places(text, &self.points_mm, "points_mm")?;
        let planned = expand::of_face(&places, normal(text, &self.normal)?);
        Ok((Kind::Shoulder { along: self.along }, planned))
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CircleFile {
    pub name: Spanned<String>,
    axis: Axis,
    centre_mm: Spanned<[f64; 3]>,
    diameter_mm: Spanned<f64>,
    #[serde(default)]
    angles_deg: Vec<Spanned<f64>>,
}

impl CircleFile {
    pub fn read(&self, text: &str, inside: bool) -> Result<(Kind, Vec<Planned>), Complaint> {
        let centre = places(text, &self.centre_mm, "centre_mm")?;
        let diameter = checked(text, &self.diameter_mm, "diameter_mm", "mm", LENGTH)?;
        let angles = numbers(text, &self.angles_deg, "angles_deg", "°", (-360.0, 360.0))?;
        let nominal = Nominal::straight(self.axis, centre, diameter);
        let section = [centre[self.axis.index()]];
        let planned = expand::around(&nominal, &section, &angles, inside);
        Ok((Kind::Circle { nominal, inside }, planned))
    }
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum DiametersKey {
    #[default]
    OfSections,
    Cylinder,
    Cone,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AxisFile {
    pub name: Spanned<String>,
    axis: Axis,
    inside: bool,
    /// At the face.
    centre_mm: Spanned<[f64; 3]>,
    diameter_mm: Spanned<f64>,
    taper: Option<Spanned<f64>>,
    #[serde(default)]
    diameters: DiametersKey,
    #[serde(default)]
    sections_mm: Vec<Spanned<f64>>,
    #[serde(default)]
    angles_deg: Vec<Spanned<f64>>,
}

impl AxisFile {
    pub fn read(&self, text: &str) -> Result<(Kind, Vec<Planned>), Complaint> {
        let nominal = Nominal {
            axis: self.axis,
            centre_mm: places(text, &self.centre_mm, "centre_mm")?,
            diameter_mm: checked(text, &self.diameter_mm, "diameter_mm", "mm", LENGTH)?,
            taper: taper(text, self.taper.as_ref())?,
        };
        let sections = numbers(text, &self.sections_mm, "sections_mm", "mm", COORDINATE)?;
        let angles = numbers(text, &self.angles_deg, "angles_deg", "°", (-360.0, 360.0))?;
        let planned = expand::around(&nominal, &sections, &angles, self.inside);
        let diameters = match self.diameters {
            DiametersKey::OfSections => Diameters::OfSections,
            DiametersKey::Cylinder => Diameters::Cylinder,
            DiametersKey::Cone => Diameters::Cone,
        };
        let inside = self.inside;
        Ok((
            Kind::Axis {
                nominal,
                inside,
                diameters,
            },
            planned,
        ))
    }
}

fn taper(text: &str, taper: Option<&Spanned<f64>>) -> Result<f64, Complaint> {
    taper.map_or(Ok(0.0), |taper| {
        checked(text, taper, "taper", "mm/mm", (-10.0, 10.0))
    })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TurnedFile {
    pub name: Spanned<String>,
    diameter_mm: Spanned<f64>,
    #[serde(default)]
    inside: bool,
    /// Where diameter and taper are told.
    face_mm: Option<Spanned<f64>>,
    taper: Option<Spanned<f64>>,
    #[serde(default)]
    places_mm: Vec<Spanned<f64>>,
    /// Where the touched surface lies.
    #[serde(default)]
    sides: Vec<Spanned<String>>,
}

impl TurnedFile {
    pub fn read(&self, text: &str) -> Result<(Kind, Vec<Planned>), Complaint> {
        let face = |face: &Spanned<f64>| checked(text, face, "face_mm", "mm", COORDINATE);
        let nominal = Nominal {
            axis: Axis::Z,
            centre_mm: [0.0, 0.0, self.face_mm.as_ref().map_or(Ok(0.0), face)?],
            diameter_mm: checked(text, &self.diameter_mm, "diameter_mm", "mm", LENGTH)?,
            taper: taper(text, self.taper.as_ref())?,
        };
        let places = numbers(text, &self.places_mm, "places_mm", "mm", COORDINATE)?;
        let mut sides = Vec::new();
        for side in &self.sides {
            let direction = normal(text, side)?;
            if Axis::along(direction) != Some(Axis::X) {
                let message = format!("sides has `{}`: allowed are +x and -x", side.get_ref());
                return Err(Complaint::at(text, &side.span(), message));
            }
            sides.push(direction);
        }
        if sides.is_empty() {
            sides.push(Axis::X.unit());
        }
        let inside = self.inside;
        let planned = expand::of_turned(&nominal, &places, &sides, inside);
        Ok((Kind::Turned { nominal, inside }, planned))
    }
}
