//! Tables, functions and readings of a machine file.

use nalgebra::Vector3;
use serde::Deserialize;

use super::super::indicators::{Indicator, Readings, Stand};
use super::super::law::{Function, Table, Wave};
use super::super::setting::{Component, SettingVector};
use super::super::unit::direction_of;

/// 1 µm in mm, and 1 µrad in units of 10⁻³ rad.
const MICRO: f64 = 1e-3;
const URAD: f64 = 1e-6;
const ARCSEC: f64 = std::f64::consts::PI / 648_000.0;
/// Largest shift, mm, and turn, rad, of a unit: beyond, small angles are not small.
const LARGEST_MM: f64 = 10.0;
const LARGEST_RAD: f64 = 0.01;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TableFile {
    at_mm: Option<Vec<f64>>,
    at_deg: Option<Vec<f64>>,
    a_um: Option<Vec<f64>>,
    b_um: Option<Vec<f64>>,
    c_um: Option<Vec<f64>>,
    lambda_urad: Option<Vec<f64>>,
    beta_urad: Option<Vec<f64>>,
    gamma_urad: Option<Vec<f64>>,
    lambda_arcsec: Option<Vec<f64>>,
    beta_arcsec: Option<Vec<f64>>,
    gamma_arcsec: Option<Vec<f64>>,
}

impl TableFile {
    pub fn read(&self, rotary: bool) -> Result<Table, String> {
        let places = places(&self.at_mm, &self.at_deg, rotary)?;
        let mut values = vec![SettingVector::ZERO; places.len()];
        let columns = [
            ("a_um", Component::A, &self.a_um, MICRO),
            ("b_um", Component::B, &self.b_um, MICRO),
            ("c_um", Component::C, &self.c_um, MICRO),
            ("lambda_urad", Component::Lambda, &self.lambda_urad, URAD),
            ("beta_urad", Component::Beta, &self.beta_urad, URAD),
            ("gamma_urad", Component::Gamma, &self.gamma_urad, URAD),
            (
                "lambda_arcsec",
                Component::Lambda,
                &self.lambda_arcsec,
                ARCSEC,
            ),
            ("beta_arcsec", Component::Beta, &self.beta_arcsec, ARCSEC),
            ("gamma_arcsec", Component::Gamma, &self.gamma_arcsec, ARCSEC),
        ];
        let mut given = Vec::new();
        for (key, component, column, unit) in columns {
            let Some(column) = column else { continue };
            if given.contains(&component) {
                return Err(format!(
                    "{component} is given in urad and in arcsec: choose one"
                ));
            }
            given.push(component);
            if column.len() != places.len() {
                return Err(format!(
                    "{key} has {} values for {} places: one for each is needed",
                    column.len(),
                    places.len()
                ));
            }
            for (value, &number) in values.iter_mut().zip(column) {
                *value = value.with(component, checked(key, component, number, unit)?);
            }
        }
        Table::new(places, values, rotary)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FunctionFile {
    of: String,
    constant_um: Option<f64>,
    constant_urad: Option<f64>,
    constant_arcsec: Option<f64>,
    slope_um_per_m: Option<f64>,
    slope_urad_per_m: Option<f64>,
    slope_arcsec_per_m: Option<f64>,
    #[serde(default)]
    wave: Vec<WaveFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WaveFile {
    amplitude_um: Option<f64>,
    amplitude_urad: Option<f64>,
    amplitude_arcsec: Option<f64>,
    period_mm: Option<f64>,
    periods_a_turn: Option<u32>,
    #[serde(default)]
    phase_deg: f64,
}

impl FunctionFile {
    pub fn read(&self, rotary: bool) -> Result<Function, String> {
        let found = Component::ALL.into_iter().find(|one| one.key() == self.of);
        let component = found.ok_or_else(|| {
            let keys = Component::ALL.map(Component::key).join(", ");
            format!("of = \"{}\": one of {keys} is expected", self.of)
        })?;
        let constant = [self.constant_um, self.constant_urad, self.constant_arcsec];
        let slope = [
            self.slope_um_per_m,
            self.slope_urad_per_m,
            self.slope_arcsec_per_m,
        ];
        if rotary && slope.iter().any(Option::is_some) {
            return Err(
                "a slope does not close after a turn: a rotary unit has constants, waves and tables"
                    .to_owned(),
            );
        }
        let wave = |wave: &WaveFile| wave.read(component, rotary);
        Ok(Function {
            component,
            constant: one_of("constant", component, constant)?.unwrap_or_default(),
            slope: one_of("slope", component, slope)?.unwrap_or_default() / 1000.0,
            waves: self.wave.iter().map(wave).collect::<Result<_, _>>()?,
        })
    }
}

impl WaveFile {
    fn read(&self, component: Component, rotary: bool) -> Result<Wave, String> {
        let amplitude = [
            self.amplitude_um,
            self.amplitude_urad,
            self.amplitude_arcsec,
        ];
        let period = match (self.period_mm, self.periods_a_turn, rotary) {
            (Some(period), None, false) if (0.001..=1e6).contains(&period) => period,
            (None, Some(count), true) if (1..=100_000).contains(&count) => 360.0 / f64::from(count),
            (_, _, false) => {
                return Err("a wave of a linear unit needs `period_mm`, 0.001 to 1e6".to_owned());
            }
            (_, _, true) => {
                return Err(
                    "a wave of a rotary unit needs `periods_a_turn`, 1 to 100000".to_owned(),
                );
            }
        };
        if !self.phase_deg.is_finite() {
            return Err(format!(
                "phase_deg is {}: a number is expected",
                self.phase_deg
            ));
        }
        Ok(Wave {
            amplitude: one_of("amplitude", component, amplitude)?
                .ok_or("a wave needs an amplitude")?,
            period,
            phase_deg: self.phase_deg,
        })
    }
}

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

fn places(
    at_mm: &Option<Vec<f64>>,
    at_deg: &Option<Vec<f64>>,
    rotary: bool,
) -> Result<Vec<f64>, String> {
    match (at_mm, at_deg, rotary) {
        (Some(places), None, false) | (None, Some(places), true) => Ok(places.clone()),
        (_, _, false) => Err("a linear unit needs its places as `at_mm`".to_owned()),
        (_, _, true) => Err("a rotary unit needs its places as `at_deg`".to_owned()),
    }
}

/// The one value in µm, µrad and arcsec that is given, in mm or rad.
fn one_of(
    what: &str,
    component: Component,
    [um, urad, arcsec]: [Option<f64>; 3],
) -> Result<Option<f64>, String> {
    let given = [
        ("um", um, MICRO),
        ("urad", urad, URAD),
        ("arcsec", arcsec, ARCSEC),
    ];
    let mut given = given
        .into_iter()
        .filter_map(|(unit, value, scale)| Some((unit, value?, scale)));
    let Some((unit, value, scale)) = given.next() else {
        return Ok(None);
    };
    if given.next().is_some() {
        return Err(format!(
            "the {what} of {component} is given in two units: choose one"
        ));
    }
    if (unit == "um") == component.is_turn() {
        let expected = if component.is_turn() {
            "urad or arcsec"
        } else {
            "um"
        };
        return Err(format!(
            "the {what} of {component} is in {unit}: {expected} is expected"
        ));
    }
    checked(what, component, value, scale).map(Some)
}

fn checked(what: &str, component: Component, value: f64, unit: f64) -> Result<f64, String> {
    let largest = if component.is_turn() {
        LARGEST_RAD
    } else {
        LARGEST_MM
    };
    if (value * unit).abs() <= largest {
        return Ok(value * unit);
    }
    let most = largest / unit;
    Err(format!(
        "{what} of {component} is {value}: -{most:.0} to {most:.0} is allowed"
    ))
}
