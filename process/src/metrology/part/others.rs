//! Features as the file has them that are not touched themselves.

use leadscrew_nc::source::Complaint;
use serde::Deserialize;
use toml::Spanned;

use super::kinds::{COORDINATE, checked, numbers, places};
use super::{Blank, PassesPlan, ToolPlan};
use crate::metrology::Axis;
use crate::metrology::relations::TableTurn;
use crate::setting_vector::Component;

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

impl SettingFile {
    pub fn free(&self) -> [bool; 6] {
        let Some(free) = &self.free else {
            return [true; 6];
        };
        let mut all = [false; 6];
        for component in free {
            all[component.index()] = true;
        }
        all
    }
}
