//! `[[function]]`: constant, slope and waves of one parameter.

use serde::Deserialize;

use super::quantity::one_of;
use crate::deviations::law::{Function, Wave};
use crate::setting_vector::Component;

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
