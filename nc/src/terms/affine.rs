//! K = K0 + A(Y)·(Y − Y0): P4 (6) with its datum and units stated. The coefficients of A are numbers, or functions of a coordinate
//! given as tables, linear between their points: the paper's matrix of functional coefficients.

use serde::Deserialize;
use toml::Spanned;

use super::table::Table;
use super::{Circumstances, Region, Shape, Steepness, Term, TermError};
use crate::checks::{ByAxis, FARTHEST, LARGEST_K, place, within_at};
use crate::coordinates::{Axis, AxisSet, Coordinates};
use crate::source::Complaint;

/// Largest coefficient that is believed; more is a slip of unit.
const LARGEST_COEFFICIENT: f64 = 10.0;

/// As it is written: `name`, `datum_mm` and `datum_deg` (Y0), `constant_mm` and `constant_deg` (K0), and a list of coefficients.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AffineFile {
    name: String,
    #[serde(default)]
    datum_mm: ByAxis,
    #[serde(default)]
    datum_deg: ByAxis,
    #[serde(default)]
    constant_mm: ByAxis,
    #[serde(default)]
    constant_deg: ByAxis,
    #[serde(default)]
    coefficient: Vec<Spanned<CoefficientFile>>,
}

/// An entry of A: how much of a corrected axis for a unit of a coordinate, `mm_per_mm = 1e-5`. A function: `over`, with
/// `places_mm` (or `places_deg`) and a list of as many values.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CoefficientFile {
    corrects: Axis,
    by: Axis,
    mm_per_mm: Option<Spanned<Values>>,
    mm_per_deg: Option<Spanned<Values>>,
    deg_per_mm: Option<Spanned<Values>>,
    deg_per_deg: Option<Spanned<Values>>,
    over: Option<Spanned<Axis>>,
    places_mm: Option<Spanned<Vec<f64>>>,
    places_deg: Option<Spanned<Vec<f64>>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
enum Values {
    One(f64),
    Many(Vec<f64>),
}

/// A coefficient: a number, or a function of a coordinate.
#[derive(Clone, Debug, PartialEq)]
enum Value {
    Number(f64),
    Function(Table),
}

/// An entry of A.
#[derive(Clone, Debug, PartialEq)]
struct Coefficient {
    corrects: Axis,
    by: Axis,
    value: Value,
}

/// K = K0 + A(Y)·(Y − Y0).
#[derive(Clone, Debug, PartialEq)]
pub struct Affine {
    name: String,
    datum: Coordinates,
    constant: Coordinates,
    coefficients: Vec<Coefficient>,
}

impl Affine {
    /// K0 everywhere, about the datum Y0 where coefficients follow.
    #[must_use]
    pub fn new(name: impl Into<String>, constant: Coordinates, datum: Coordinates) -> Self {
        Self {
            name: name.into(),
            datum,
            constant,
            coefficients: Vec::new(),
        }
    }

    /// With an entry of A: so much of `corrects` for a unit of `by`.
    #[must_use]
    pub fn with(mut self, corrects: Axis, by: Axis, coefficient: f64) -> Self {
        self.coefficients.push(Coefficient {
            corrects,
            by,
            value: Value::Number(coefficient),
        });
        self
    }

    /// With an entry of A that is a function of the coordinate `over`, linear between points (place, coefficient).
    ///
    /// # Errors
    /// What is wrong with the numbers, in words.
    pub fn with_function(
        mut self,
        corrects: Axis,
        by: Axis,
        over: Axis,
        points: &[(f64, f64)],
    ) -> Result<Self, String> {
        let (places, values) = points.iter().copied().unzip();
        self.coefficients.push(Coefficient {
            corrects,
            by,
            value: Value::Function(Table::new(over, places, values)?),
        });
        Ok(self)
    }

    /// From what is written.
    ///
    /// # Errors
    /// What is wrong in the text, and where.
    pub fn from_file(text: &str, file: &AffineFile) -> Result<Self, Complaint> {
        let mut term = Self::new(
            &*file.name,
            place(
                text,
                "constant",
                &file.constant_mm,
                &file.constant_deg,
                LARGEST_K,
            )?,
            place(text, "datum", &file.datum_mm, &file.datum_deg, FARTHEST)?,
        );
        for entry in &file.coefficient {
            term.coefficients.push(coefficient(text, entry)?);
        }
        Ok(term)
    }
}

fn coefficient(text: &str, entry: &Spanned<CoefficientFile>) -> Result<Coefficient, Complaint> {
    let file = entry.get_ref();
    let complain = |message: String| Complaint::at(text, &entry.span(), message);
    let unit = format!("{}_per_{}", file.corrects.unit(), file.by.unit());
    let given = [
        ("mm_per_mm", &file.mm_per_mm),
        ("mm_per_deg", &file.mm_per_deg),
        ("deg_per_mm", &file.deg_per_mm),
        ("deg_per_deg", &file.deg_per_deg),
    ];
    let mut present = given
        .iter()
        .filter_map(|(key, value)| Some((*key, value.as_ref()?)));
    let (Some((key, values)), None) = (present.next(), present.next()) else {
        return Err(complain(format!("one value is needed, {unit} = …")));
    };
    if key != unit {
        return Err(Complaint::at(
            text,
            &values.span(),
            format!(
                "{key}: a coefficient of {} by {} is stated as {unit}",
                file.corrects, file.by
            ),
        ));
    }
    let checked = |number: f64| {
        let range = (-LARGEST_COEFFICIENT, LARGEST_COEFFICIENT);
        within_at(
            text,
            &values.span(),
            key,
            number,
            range,
            &unit.replace("_per_", "/"),
        )
    };
    let value = match (values.get_ref(), &file.over) {
        (Values::One(number), None) => Value::Number(checked(*number)?),
        (Values::Many(numbers), Some(over)) => {
            let numbers = numbers
                .iter()
                .map(|number| checked(*number))
                .collect::<Result<_, _>>()?;
            Value::Function(function(text, file, over, numbers)?)
        }
        (Values::One(_), Some(_)) => {
            return Err(complain(format!(
                "over = …: {unit} must be a list of values"
            )));
        }
        (Values::Many(_), None) => {
            return Err(complain(format!(
                "a list of {unit} needs over = \"axis\" and the places of that axis"
            )));
        }
    };
    Ok(Coefficient {
        corrects: file.corrects,
        by: file.by,
        value,
    })
}

fn function(
    text: &str,
    file: &CoefficientFile,
    over: &Spanned<Axis>,
    values: Vec<f64>,
) -> Result<Table, Complaint> {
    let axis = *over.get_ref();
    let (right, wrong) = if axis.is_rotary() {
        (&file.places_deg, &file.places_mm)
    } else {
        (&file.places_mm, &file.places_deg)
    };
    let (Some(places), None) = (right, wrong) else {
        return Err(Complaint::at(
            text,
            &over.span(),
            format!(
                "over = \"{axis}\" needs places_{}, and only that",
                axis.unit()
            ),
        ));
    };
    Table::new(axis, places.get_ref().clone(), values)
        .map_err(|message| Complaint::at(text, &places.span(), message))
}

impl Term for Affine {
    fn name(&self) -> &str {
        &self.name
    }

    fn correction(&self, at: &Coordinates, _: &Circumstances) -> Result<Coordinates, TermError> {
        let mut k = self.constant;
        for entry in &self.coefficients {
            let factor = match &entry.value {
                Value::Number(number) => *number,
                Value::Function(table) => table.at(at[table.axis], &self.name)?,
            };
            k[entry.corrects] += factor * (at[entry.by] - self.datum[entry.by]);
        }
        Ok(k)
    }

    fn corrects(&self) -> AxisSet {
        let constant = self
            .constant
            .iter()
            .filter(|(_, k)| *k != 0.0)
            .map(|(axis, _)| axis);
        constant
            .chain(self.coefficients.iter().map(|entry| entry.corrects))
            .collect()
    }

    fn depends_on(&self) -> AxisSet {
        self.coefficients.iter().fold(AxisSet::NONE, |axes, entry| {
            let axes = axes.with(entry.by);
            match &entry.value {
                Value::Number(_) => axes,
                Value::Function(table) => axes.with(table.axis),
            }
        })
    }

    fn shape(&self) -> Shape {
        let of = |entry: &Coefficient| match &entry.value {
            Value::Number(number) if *number == 0.0 => Shape::None,
            Value::Number(_) => Shape::Affine,
            Value::Function(_) => Shape::Curved,
        };
        let constant = if self.constant == Coordinates::ZERO {
            Shape::None
        } else {
            Shape::Constant
        };
        self.coefficients.iter().map(of).fold(constant, Ord::max)
    }

    fn breaks(&self, axis: Axis, found: &mut dyn FnMut(&[f64])) {
        for entry in &self.coefficients {
            if let Value::Function(table) = &entry.value
                && table.axis == axis
            {
                found(table.places());
            }
        }
    }

    /// The sums of what each entry can do: |a·y′ + a′·o′·(y − y0)| and |2·a′·o′·y′| along a unit direction.
    fn steepness(&self, within: &Region) -> Steepness {
        self.coefficients
            .iter()
            .fold(Steepness::default(), |sum, entry| match &entry.value {
                Value::Number(number) => Steepness {
                    slope: sum.slope + number.abs(),
                    ..sum
                },
                Value::Function(table) => {
                    let far = within.farthest_from(entry.by, self.datum[entry.by]);
                    let steepest = table.steepest();
                    Steepness {
                        slope: sum.slope + table.largest() + steepest * far,
                        bend: sum.bend + 2.0 * steepest,
                    }
                }
            })
    }
}
