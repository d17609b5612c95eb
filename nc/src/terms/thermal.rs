//! Thermal growth: of a screw or scale, which carries its axis too far, or of the workpiece, which the program has to follow.
//!
//! With e = coefficient × (temperature − reference) and l the way from the fixed point: a grown screw brings the carriage to l(1+e)
//! where l is asked for, so l/(1+e) is asked for instead, K = −l·e/(1+e); a grown workpiece has its features at l(1+e), K = l·e.

use serde::Deserialize;
use toml::Spanned;

use super::{Circumstances, Region, Shape, Steepness, Term, TermError};
use crate::checks::{FARTHEST, within};
use crate::coordinates::{Axis, AxisSet, Coordinates};
use crate::source::Complaint;

/// What grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Grows {
    /// The screw or scale that the axis is measured by.
    Screw,
    /// The workpiece.
    Workpiece,
}

/// As it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThermalFile {
    name: String,
    axis: Spanned<Axis>,
    grows: Grows,
    expansion_um_per_m_k: Spanned<f64>,
    fixed_point_mm: Spanned<f64>,
    temperature_c: Spanned<f64>,
    #[serde(default = "reference")]
    reference_c: Spanned<f64>,
}

/// ISO 1: lengths are stated at 20 °C.
fn reference() -> Spanned<f64> {
    Spanned::new(0..0, 20.0)
}

/// Growth along one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Thermal {
    name: String,
    axis: Axis,
    /// K for a mm of way from the fixed point.
    factor: f64,
    fixed_point_mm: f64,
}

impl Thermal {
    /// Growth by a coefficient (1/K) and a temperature difference (K) from a fixed point (mm).
    #[must_use]
    pub fn new(
        name: impl Into<String>,
        axis: Axis,
        grows: Grows,
        expansion_per_k: f64,
        fixed_point_mm: f64,
        difference_k: f64,
    ) -> Self {
        let e = expansion_per_k * difference_k;
        Self {
            name: name.into(),
            axis,
            factor: match grows {
                Grows::Screw => -e / (1.0 + e),
                Grows::Workpiece => e,
            },
            fixed_point_mm,
        }
    }

    /// From what is written.
    ///
    /// # Errors
    /// What is wrong in the text, and where.
    pub fn from_file(text: &str, file: &ThermalFile) -> Result<Self, Complaint> {
        let axis = *file.axis.get_ref();
        if axis.is_rotary() {
            return Err(Complaint::at(
                text,
                &file.axis.span(),
                format!("axis = \"{axis}\": only linear axes grow"),
            ));
        }
        let expansion = within(
            text,
            "expansion_um_per_m_k",
            &file.expansion_um_per_m_k,
            (0.0, 200.0),
            "um/m/K",
        )?;
        let fixed = within(
            text,
            "fixed_point_mm",
            &file.fixed_point_mm,
            (-FARTHEST, FARTHEST),
            "mm",
        )?;
        let temperature = within(
            text,
            "temperature_c",
            &file.temperature_c,
            (-50.0, 200.0),
            "degC",
        )?;
        let reference = within(
            text,
            "reference_c",
            &file.reference_c,
            (-50.0, 200.0),
            "degC",
        )?;
        let difference = temperature - reference;
        Ok(Self::new(
            &*file.name,
            axis,
            file.grows,
            expansion * 1e-6,
            fixed,
            difference,
        ))
    }
}

impl Term for Thermal {
    fn name(&self) -> &str {
        &self.name
    }

    fn correction(&self, at: &Coordinates, _: &Circumstances) -> Result<Coordinates, TermError> {
        let way = at[self.axis] - self.fixed_point_mm;
        Ok(Coordinates::ZERO.with(self.axis, self.factor * way))
    }

    fn corrects(&self) -> AxisSet {
        AxisSet::of(self.axis)
    }

    fn depends_on(&self) -> AxisSet {
        AxisSet::of(self.axis)
    }

    fn shape(&self) -> Shape {
        if self.factor == 0.0 {
            Shape::None
        } else {
            Shape::Affine
        }
    }

    fn steepness(&self, _: &Region) -> Steepness {
        Steepness {
            slope: self.factor.abs(),
            bend: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warm_screw_is_asked_for_less_and_a_warm_workpiece_for_more() {
        let at = Coordinates::xyz(0.0, 0.0, 600.0);
        let k = |grows| {
            Thermal::new("t", Axis::Z, grows, 11.5e-6, 100.0, 8.0)
                .correction(&at, &Circumstances::default())
                .unwrap()[Axis::Z]
        };
        // 500 mm × 11.5 µm/m/K × 8 K = 46 µm.
        assert!((k(Grows::Workpiece) - 0.046).abs() < 1e-12);
        let asked_for = 500.0 + k(Grows::Screw);
        let reached = asked_for * (1.0 + 11.5e-6 * 8.0);
        assert!((reached - 500.0).abs() < 1e-12, "{reached}");
    }
}
