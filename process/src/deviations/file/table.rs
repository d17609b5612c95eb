//! `[[table]]`: columns of µm, µrad or arcsec over places.

use serde::Deserialize;

use super::quantity::{ARCSEC, MICRO, URAD, checked, places};
use crate::deviations::law::Table;
use crate::setting_vector::{Component, SettingVector};

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
