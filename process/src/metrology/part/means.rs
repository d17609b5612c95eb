//! Probe, tables and motion as the file has them.

use std::collections::BTreeMap;

use leadscrew_nc::source::Complaint;
use serde::Deserialize;
use toml::Spanned;

use super::kinds::{LONGEST_MM, checked};
use super::{Probe, ProgramPlan, Table, direction};
use crate::metrology::Axis;

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ProbeFile {
    sigma_mm: Option<Spanned<f64>>,
    radius_mm: Option<Spanned<f64>>,
    pretravel_mm: Option<Spanned<f64>>,
    #[serde(default)]
    pretravel_of_mm: BTreeMap<Spanned<String>, Spanned<f64>>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TableFile {
    #[serde(default)]
    x_is: XIs,
    #[serde(default)]
    places_of: PlacesOf,
}

#[derive(Default, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum XIs {
    #[default]
    Radius,
    Diameter,
}

#[derive(Default, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum PlacesOf {
    #[default]
    Surface,
    Stylus,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ProgramFile {
    safe_axis: Option<Axis>,
    safe_mm: Option<Spanned<f64>>,
    approach_mm: Option<Spanned<f64>>,
    overtravel_mm: Option<Spanned<f64>>,
    feed_mm_per_min: Option<Spanned<f64>>,
    travel_mm_per_min: Option<Spanned<f64>>,
    log: Option<Spanned<String>>,
}

impl ProbeFile {
    pub fn read(&self, text: &str) -> Result<Probe, Complaint> {
        let length = |value: &Option<Spanned<f64>>, key, range| match value {
            Some(value) => checked(text, value, key, "mm", range).map(Some),
            None => Ok(None),
        };
        let mut pretravel_of = [[None; 2]; 3];
        for (key, value) in &self.pretravel_of_mm {
            let direction = direction(key.get_ref());
            let Some((direction, axis)) = direction.and_then(|one| Some((one, Axis::along(one)?)))
            else {
                let message = format!("`{}`: expected a direction such as \"+x\"", key.get_ref());
                return Err(Complaint::at(text, &key.span(), message));
            };
            let plus = usize::from(direction[axis.index()] > 0.0);
            let value = checked(text, value, "pretravel_of_mm", "mm", (-10.0, 10.0))?;
            pretravel_of[axis.index()][plus] = Some(value);
        }
        Ok(Probe {
            sigma_mm: length(&self.sigma_mm, "sigma_mm", (1e-9, 100.0))?,
            radius_mm: length(&self.radius_mm, "radius_mm", (0.0, 1000.0))?.unwrap_or(0.0),
            pretravel_mm: length(&self.pretravel_mm, "pretravel_mm", (-10.0, 10.0))?.unwrap_or(0.0),
            pretravel_of,
        })
    }
}

impl TableFile {
    pub fn read(&self) -> Table {
        Table {
            x_is_diameter: self.x_is == XIs::Diameter,
            is_of_stylus: self.places_of == PlacesOf::Stylus,
        }
    }
}

impl ProgramFile {
    pub fn read(&self, text: &str) -> Result<ProgramPlan, Complaint> {
        let or = |value: &Option<Spanned<f64>>, key, unit, range, default| match value {
            Some(value) => checked(text, value, key, unit, range),
            None => Ok(default),
        };
        let safe = self.safe_mm.as_ref();
        let safe = safe.map(|safe| checked(text, safe, "safe_mm", "mm", (-LONGEST_MM, LONGEST_MM)));
        let log = match &self.log {
            None => "probe.txt".to_owned(),
            Some(log) => {
                let is_plain =
                    |letter: char| letter.is_ascii_alphanumeric() || "._-/".contains(letter);
                if log.get_ref().is_empty() || !log.get_ref().chars().all(is_plain) {
                    let message = "log: expected a file name of letters, digits and . _ - /, which a comment of the program can hold";
                    return Err(Complaint::at(text, &log.span(), message));
                }
                log.get_ref().clone()
            }
        };
        let feed = (0.1, 10_000.0);
        Ok(ProgramPlan {
            safe_axis: self.safe_axis.unwrap_or(Axis::Z),
            safe_mm: safe.transpose()?,
            approach_mm: or(&self.approach_mm, "approach_mm", "mm", (0.01, 100.0), 2.0)?,
            overtravel_mm: or(
                &self.overtravel_mm,
                "overtravel_mm",
                "mm",
                (0.01, 100.0),
                2.0,
            )?,
            feed_mm_per_min: or(
                &self.feed_mm_per_min,
                "feed_mm_per_min",
                "mm/min",
                feed,
                100.0,
            )?,
            travel_mm_per_min: or(
                &self.travel_mm_per_min,
                "travel_mm_per_min",
                "mm/min",
                feed,
                1000.0,
            )?,
            log,
        })
    }
}
