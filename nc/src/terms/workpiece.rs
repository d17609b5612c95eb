//! Setting of the workpiece: it lies off its planned place by (a, b, c) and is turned by (λ, β, γ), as probing found; the program
//! follows it.
//!
//! A feature planned at p lies at p′ = P + t + R·(p − P), with P the point to which the setting is stated, t = (a, b, c), R the exact
//! rotation by λ about x, then β about y, then γ about z, right-handed, about the machine's axes. K = p′ − p at the tip of the tool:
//! the tool's place relative to the workpiece is off by −K, so this is K = −Δ of P4 with the workpiece at the end of its chain.
//! Affine, so a line stays a line.

use serde::Deserialize;
use toml::Spanned;

use super::{Circumstances, Region, Shape, Steepness, Term, TermError, Trouble};
use crate::checks::{ByAxis, FARTHEST, LARGEST_K, coordinates, within};
use crate::coordinates::{Axis, AxisSet, Coordinates};
use crate::source::Complaint;

/// As it is written; what is left out is 0.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WorkpieceFile {
    name: String,
    point_mm: Spanned<ByAxis>,
    #[serde(default = "zero")]
    a_mm: Spanned<f64>,
    #[serde(default = "zero")]
    b_mm: Spanned<f64>,
    #[serde(default = "zero")]
    c_mm: Spanned<f64>,
    #[serde(default = "zero")]
    lambda_rad: Spanned<f64>,
    #[serde(default = "zero")]
    beta_rad: Spanned<f64>,
    #[serde(default = "zero")]
    gamma_rad: Spanned<f64>,
}

fn zero() -> Spanned<f64> {
    Spanned::new(0..0, 0.0)
}

const XYZ: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

/// Where a workpiece lies less where it was planned.
#[derive(Clone, Debug, PartialEq)]
pub struct Workpiece {
    name: String,
    point: [f64; 3],
    shift: [f64; 3],
    /// R − I.
    turn: [[f64; 3]; 3],
}

impl Workpiece {
    /// A setting: shift (a, b, c) in mm, angles (λ, β, γ) in rad, about a point in machine coordinates (of the tool's tip), mm.
    #[must_use]
    pub fn new(
        name: impl Into<String>,
        point: [f64; 3],
        shift: [f64; 3],
        [lambda, beta, gamma]: [f64; 3],
    ) -> Self {
        let (sl, cl) = lambda.sin_cos();
        let (sb, cb) = beta.sin_cos();
        let (sg, cg) = gamma.sin_cos();
        Self {
            name: name.into(),
            point,
            shift,
            turn: [
                [
                    cg * cb - 1.0,
                    cg * sb * sl - sg * cl,
                    cg * sb * cl + sg * sl,
                ],
                [
                    sg * cb,
                    sg * sb * sl + cg * cl - 1.0,
                    sg * sb * cl - cg * sl,
                ],
                [-sb, cb * sl, cb * cl - 1.0],
            ],
        }
    }

    /// From what is written.
    ///
    /// # Errors
    /// What is wrong in the text, and where.
    pub fn from_file(text: &str, file: &WorkpieceFile) -> Result<Self, Complaint> {
        let point = coordinates(text, "point_mm", file.point_mm.get_ref(), false, FARTHEST)?;
        if let Some((axis, _)) = point.iter().skip(3).find(|(_, value)| *value != 0.0) {
            return Err(Complaint::at(
                text,
                &file.point_mm.span(),
                format!("point_mm: {axis} has no place here, only X, Y and Z"),
            ));
        }
        let mm = |key, value| within(text, key, value, (-LARGEST_K, LARGEST_K), "mm");
        let rad = |key, value| within(text, key, value, (-0.8, 0.8), "rad");
        Ok(Self::new(
            &*file.name,
            XYZ.map(|axis| point[axis]),
            [
                mm("a_mm", &file.a_mm)?,
                mm("b_mm", &file.b_mm)?,
                mm("c_mm", &file.c_mm)?,
            ],
            [
                rad("lambda_rad", &file.lambda_rad)?,
                rad("beta_rad", &file.beta_rad)?,
                rad("gamma_rad", &file.gamma_rad)?,
            ],
        ))
    }

    fn turns(&self) -> bool {
        self.turn.iter().flatten().any(|entry| *entry != 0.0)
    }
}

impl Term for Workpiece {
    fn name(&self) -> &str {
        &self.name
    }

    fn correction(&self, at: &Coordinates, with: &Circumstances) -> Result<Coordinates, TermError> {
        let mut k = Coordinates::ZERO;
        for (axis, shift) in XYZ.into_iter().zip(self.shift) {
            k[axis] = shift;
        }
        if !self.turns() {
            return Ok(k);
        }
        let offset = with.tool_offset.ok_or_else(|| TermError {
            term: self.name.clone(),
            trouble: Trouble::ToolOffsetUnknown,
        })?;
        let tip = *at - offset;
        for (row, axis) in self.turn.iter().zip(XYZ) {
            for ((entry, column), point) in row.iter().zip(XYZ).zip(self.point) {
                k[axis] += entry * (tip[column] - point);
            }
        }
        Ok(k)
    }

    fn corrects(&self) -> AxisSet {
        XYZ.into_iter()
            .zip(self.shift)
            .zip(self.turn)
            .filter(|((_, shift), row)| *shift != 0.0 || row.iter().any(|entry| *entry != 0.0))
            .map(|((axis, _), _)| axis)
            .collect()
    }

    fn depends_on(&self) -> AxisSet {
        XYZ.into_iter()
            .enumerate()
            .filter(|(column, _)| self.turn.iter().any(|row| row[*column] != 0.0))
            .map(|(_, axis)| axis)
            .collect()
    }

    fn depends_on_tool(&self) -> bool {
        self.turns()
    }

    fn shape(&self) -> Shape {
        if self.turns() {
            Shape::Affine
        } else if self.corrects().is_empty() {
            Shape::None
        } else {
            Shape::Constant
        }
    }

    fn steepness(&self, _: &Region) -> Steepness {
        let squares: f64 = self.turn.iter().flatten().map(|entry| entry * entry).sum();
        Steepness {
            slope: squares.sqrt(),
            bend: 0.0,
        }
    }
}
