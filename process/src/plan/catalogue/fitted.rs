//! An encoder in its place.

use leadscrew::units::{RangeError, discrete_mm};

use super::{Encoder, FittedEncoder};

impl FittedEncoder {
    /// An encoder of the catalogue in its place; without `lines` it is the only number that it comes with.
    ///
    /// # Errors
    /// A message: lines that it does not come with, or none chosen where there are several.
    pub fn new(encoder: &Encoder, lines: Option<f64>, travel_mm: f64) -> Result<Self, String> {
        let [least, most] = encoder.lines;
        let name = &encoder.name;
        let lines = match lines {
            Some(lines) if (least..=most).contains(&lines) => lines,
            Some(lines) => {
                return Err(format!(
                    "{name} with {lines} lines: it comes with {least} to {most}"
                ));
            }
            None if least == most => least,
            None => {
                return Err(format!(
                    "{name} comes with {least} to {most} lines: say which by lines"
                ));
            }
        };
        Ok(Self {
            encoder: encoder.clone(),
            lines,
            travel_mm,
        })
    }

    /// Resolution k, d/mm, of a linear axis (P1, 8).
    ///
    /// # Errors
    /// [`RangeError`] for a travel that no axis has.
    pub fn counts_per_mm(&self) -> Result<f64, RangeError> {
        discrete_mm(self.travel_mm, self.lines).map(|discrete| 1.0 / discrete)
    }
}
