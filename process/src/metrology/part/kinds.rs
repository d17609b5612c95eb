//! Features as the file has them.

use leadscrew_nc::source::Complaint;
use serde::Deserialize;
use toml::Spanned;

use super::{Blank, Kind, PassesPlan, Planned, ToolPlan, direction, expand};
use crate::metrology::bore::Diameters;
use crate::metrology::relations::TableTurn;
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

fn numbers(
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

const COORDINATE: (f64, f64) = (-LONGEST_MM, LONGEST_MM);
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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CoaxialityFile {
    pub name: Spanned<String>,
    pub of: [Spanned<String>; 2],
    turn: Option<TurnFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TurnFile {
    about: Axis,
    pivot_mm: Spanned<[f64; 3]>,
    pivot_offset_mm: Spanned<[f64; 3]>,
    pivot_sigma_mm: Option<Spanned<[f64; 3]>>,
}

impl CoaxialityFile {
    pub fn turn(&self, text: &str) -> Result<Option<TableTurn>, Complaint> {
        let Some(turn) = &self.turn else {
            return Ok(None);
        };
        let sigma = turn.pivot_sigma_mm.as_ref();
        let sigma = sigma.map_or(Ok([0.0; 3]), |sigma| places(text, sigma, "pivot_sigma_mm"))?;
        Ok(Some(TableTurn {
            about: turn.about,
            pivot_mm: places(text, &turn.pivot_mm, "pivot_mm")?,
            pivot_offset_mm: places(text, &turn.pivot_offset_mm, "pivot_offset_mm")?,
            pivot_sigma_mm: sigma,
        }))
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DistanceFile {
    pub name: Spanned<String>,
    pub of: [Spanned<String>; 2],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PerpendicularityFile {
    pub name: Spanned<String>,
    pub axis: Spanned<String>,
    pub face: Spanned<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ToolFile {
    pub name: Spanned<String>,
    setter_mm: Spanned<f64>,
    touched_mm: Vec<Spanned<f64>>,
    sigma_mm: Option<Spanned<f64>>,
    then_mm: Option<Spanned<f64>>,
    then_sigma_mm: Option<Spanned<f64>>,
}

impl ToolFile {
    pub fn read(&self, text: &str, probe_sigma: Option<f64>) -> Result<ToolPlan, Complaint> {
        let sigma = |value: &Option<Spanned<f64>>, key| {
            let check = |value| checked(text, value, key, "mm", (1e-9, 100.0));
            value.as_ref().map(check).transpose()
        };
        let then = self.then_mm.as_ref();
        let then = then
            .map(|then| checked(text, then, "then_mm", "mm", COORDINATE))
            .transpose()?;
        let then_sigma = sigma(&self.then_sigma_mm, "then_sigma_mm")?;
        Ok(ToolPlan {
            setter_mm: checked(text, &self.setter_mm, "setter_mm", "mm", COORDINATE)?,
            touched_mm: numbers(text, &self.touched_mm, "touched_mm", "mm", COORDINATE)?,
            sigma_mm: sigma(&self.sigma_mm, "sigma_mm")?.or(probe_sigma),
            then: then.map(|then| (then, then_sigma)),
        })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PassesFile {
    pub name: Spanned<String>,
    pub of: Option<Spanned<String>>,
    blank_mm: Option<Spanned<f64>>,
    finished_mm: Spanned<f64>,
    max_depth_mm: Spanned<f64>,
    finishing_mm: Spanned<f64>,
}

impl PassesFile {
    pub fn read(&self, text: &str, of: Option<usize>) -> Result<PassesPlan, Complaint> {
        let coordinate = |value, key| checked(text, value, key, "mm", COORDINATE);
        let blank = match (of, &self.blank_mm) {
            (Some(of), None) => Blank::Of(of),
            (None, Some(blank)) => Blank::Stated(coordinate(blank, "blank_mm")?),
            _ => {
                let message = "expected either `of`, a feature, or `blank_mm`";
                return Err(Complaint::at(text, &self.name.span(), message));
            }
        };
        Ok(PassesPlan {
            blank,
            finished_mm: coordinate(&self.finished_mm, "finished_mm")?,
            max_depth_mm: checked(text, &self.max_depth_mm, "max_depth_mm", "mm", (1e-3, 1e3))?,
            finishing_mm: checked(text, &self.finishing_mm, "finishing_mm", "mm", (0.0, 1e3))?,
        })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SettingFile {
    pub name: Spanned<String>,
    pub of: Option<Vec<Spanned<String>>>,
    free: Option<Vec<Component>>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Component {
    A,
    B,
    C,
    Lambda,
    Beta,
    Gamma,
}

impl SettingFile {
    pub fn free(&self) -> [bool; 6] {
        let Some(free) = &self.free else {
            return [true; 6];
        };
        let mut all = [false; 6];
        for component in free {
            all[*component as usize] = true;
        }
        all
    }
}
