//! `[indicators]`: their places, directions and readings.

use nalgebra::Vector3;
use serde::Deserialize;

use super::quantity::{MICRO, places};
use crate::deviations::indicators::{Indicator, Readings, Stand};
use crate::deviations::unit::direction_of;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct IndicatorsFile {
    stand: StandKey,
    sigma_um: Option<f64>,
    indicator: Vec<IndicatorFile>,
    at_mm: Option<Vec<f64>>,
    at_deg: Option<Vec<f64>>,
    readings_um: Vec<Vec<f64>>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum StandKey {
    Unit,
    Machine,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct IndicatorFile {
    name: String,
    place_mm: [f64; 3],
    direction: String,
}

impl IndicatorsFile {
    pub fn read(&self, rotary: bool) -> Result<Readings, String> {
        let indicator = |one: &IndicatorFile| {
            let direction = direction_of(&one.direction).ok_or_else(|| {
                format!(
                    "direction \"{}\" of indicator \"{}\": +x, -x, +y, -y, +z or -z is expected",
                    one.direction, one.name
                )
            })?;
            if one
                .place_mm
                .iter()
                .any(|mm| mm.is_nan() || mm.abs() > super::LONGEST_MM)
            {
                return Err(format!(
                    "place_mm of indicator \"{}\" is {:?}: each number must be within ±{} mm",
                    one.name,
                    one.place_mm,
                    super::LONGEST_MM
                ));
            }
            Ok(Indicator {
                name: one.name.clone(),
                place_mm: Vector3::from(one.place_mm),
                direction,
            })
        };
        if let Some(sigma) = self.sigma_um.filter(|sigma| !(1e-3..=1e3).contains(sigma)) {
            return Err(format!("sigma_um is {sigma}: 0.001 to 1000 um is expected"));
        }
        let row = |row: &Vec<f64>| row.iter().map(|um| um * MICRO).collect();
        Ok(Readings {
            indicators: self
                .indicator
                .iter()
                .map(indicator)
                .collect::<Result<_, _>>()?,
            stand: match self.stand {
                StandKey::Unit => Stand::Unit,
                StandKey::Machine => Stand::Machine,
            },
            places: places(&self.at_mm, &self.at_deg, rotary)?,
            readings_mm: self.readings_um.iter().map(row).collect(),
            sigma_mm: self.sigma_um.map(|um| um * MICRO),
        })
    }
}
