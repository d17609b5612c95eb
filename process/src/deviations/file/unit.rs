//! A unit of a machine file.

use std::ops::Range;

use leadscrew_nc::coordinates::Axis;
use leadscrew_nc::source::Complaint;
use serde::Deserialize;
use toml::Spanned;

use super::super::indicators::Measured;
use super::super::law::Law;
use super::super::machine::Chain;
use super::super::unit::{Drive, Motion, Unit, direction_of};
use super::function::FunctionFile;
use super::indicators::IndicatorsFile;
use super::place;
use super::table::TableFile;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct UnitFile {
    name: String,
    linear: Option<Spanned<String>>,
    rotary: Option<Spanned<String>>,
    axis: Option<Spanned<String>>,
    #[serde(default)]
    free: bool,
    range_mm: Option<Spanned<[f64; 2]>>,
    range_deg: Option<Spanned<[f64; 2]>>,
    frame_mm: Spanned<[f64; 3]>,
    corrected: Option<bool>,
    #[serde(default)]
    table: Vec<Spanned<TableFile>>,
    #[serde(default)]
    function: Vec<Spanned<FunctionFile>>,
    indicators: Option<Spanned<IndicatorsFile>>,
}

impl UnitFile {
    pub fn read(
        self,
        text: &str,
        chain: Chain,
        span: &Range<usize>,
    ) -> Result<(Unit, Option<Measured>), Complaint> {
        let motion = self.motion(text, span)?;
        let drive = self.drive(text, &motion, span)?;
        if let (Motion::Linear(along), Drive::Placed { axis, .. }) = (&motion, drive) {
            check_direction(chain, axis, along.into_inner() * chain.sign())
                .map_err(|message| Complaint::at(text, span, message))?;
        }
        let (law, measured) = self.law(text, &motion)?;
        check_tables(&self.name, drive, &law)
            .map_err(|message| Complaint::at(text, span, message))?;
        let primary = matches!(drive.axis(), Some(Axis::X | Axis::Y | Axis::Z));
        let unit = Unit {
            frame_mm: place(text, "frame_mm", &self.frame_mm)?,
            name: self.name,
            motion,
            drive,
            corrected: self.corrected.unwrap_or(primary),
            law,
        };
        Ok((unit, measured))
    }

    fn motion(&self, text: &str, span: &Range<usize>) -> Result<Motion, Complaint> {
        let direction = |key: &Spanned<String>| {
            direction_of(key.get_ref()).ok_or_else(|| {
                let found = key.get_ref();
                let message =
                    format!("\"{found}\" is no direction: +x, -x, +y, -y, +z or -z is expected");
                Complaint::at(text, &key.span(), message)
            })
        };
        match (&self.linear, &self.rotary) {
            (Some(along), None) => Ok(Motion::Linear(direction(along)?)),
            (None, Some(about)) => Ok(Motion::Rotary(direction(about)?)),
            _ => Err(Complaint::at(
                text,
                span,
                format!(
                    "unit \"{}\" needs either `linear`, the direction it moves in as its coordinate grows, or `rotary`, the \
                     direction it turns about",
                    self.name
                ),
            )),
        }
    }

    fn drive(&self, text: &str, motion: &Motion, span: &Range<usize>) -> Result<Drive, Complaint> {
        let wrong = |message: String| Complaint::at(text, span, message);
        let axis = self.axis.as_ref().map(|key| {
            let mut letters = key.get_ref().chars();
            let axis = letters.next().and_then(Axis::from_letter);
            let axis = axis
                .filter(|axis| letters.next().is_none() && axis.is_rotary() == motion.is_rotary());
            let expected = if motion.is_rotary() {
                "A, B or C"
            } else {
                "X, Y, Z, U, V or W"
            };
            axis.ok_or_else(|| {
                let found = key.get_ref();
                let message = format!("axis \"{found}\": {expected} is expected");
                Complaint::at(text, &key.span(), message)
            })
        });
        let axis = axis.transpose()?;
        let (range, other, key) = if motion.is_rotary() {
            (&self.range_deg, &self.range_mm, "range_deg")
        } else {
            (&self.range_mm, &self.range_deg, "range_mm")
        };
        let name = &self.name;
        match (axis, range, other) {
            (axis, None, None) if self.free && motion.is_rotary() => Ok(Drive::Free { axis }),
            (None, None, None) if motion.is_rotary() => Ok(Drive::Free { axis }),
            (Some(axis), Some(range), None) if !self.free => {
                let [low, high] = *range.get_ref();
                if low < high && low.abs() <= super::LONGEST_MM && high.abs() <= super::LONGEST_MM {
                    return Ok(Drive::Placed {
                        axis,
                        range: (low, high),
                    });
                }
                let message = format!(
                    "{key} is {low} to {high}: it must rise, within ±{}",
                    super::LONGEST_MM
                );
                Err(Complaint::at(text, &range.span(), message))
            }
            _ => Err(wrong(format!(
                "unit \"{name}\" needs `axis` and `{key}`; only a rotary unit that turns freely has no range (`free = true`)"
            ))),
        }
    }

    fn law(&self, text: &str, motion: &Motion) -> Result<(Law, Option<Measured>), Complaint> {
        let rotary = motion.is_rotary();
        let mut law = Law::NONE;
        for table in &self.table {
            let read = table.get_ref().read(rotary);
            law.tables
                .push(read.map_err(|message| Complaint::at(text, &table.span(), message))?);
        }
        for function in &self.function {
            let read = function.get_ref().read(rotary);
            law.functions
                .push(read.map_err(|message| Complaint::at(text, &function.span(), message))?);
        }
        let Some(indicators) = &self.indicators else {
            return Ok((law, None));
        };
        let measured = indicators
            .get_ref()
            .read(rotary)
            .and_then(|readings| readings.solve(motion))
            .map_err(|message| Complaint::at(text, &indicators.span(), message))?;
        law.tables.push(measured.table.clone());
        Ok((law, Some(measured)))
    }
}

impl Drive {
    fn axis(self) -> Option<Axis> {
        match self {
            Self::Placed { axis, .. } => Some(axis),
            Self::Free { axis } => axis,
        }
    }
}

/// Tables cover what the unit moves over: its range, or a whole revolution.
fn check_tables(name: &str, drive: Drive, law: &Law) -> Result<(), String> {
    let (low, high) = law.range();
    match drive {
        Drive::Placed { range, axis } if low > range.0 || high < range.1 => {
            let unit = axis.unit();
            Err(format!(
                "the tables of unit \"{name}\" are known from {low} to {high} {unit}, and it moves from {} to {} {unit}: measure \
                 the rest or state a narrower range",
                range.0, range.1
            ))
        }
        Drive::Free { .. } if low.is_finite() || high.is_finite() => Err(format!(
            "the tables of unit \"{name}\" are known from {low} to {high} °, and it turns freely: what counts is the mean over a \
             revolution, which takes tables of a full turn"
        )),
        _ => Ok(()),
    }
}

/// A program's coordinate grows as the tool moves that way against the workpiece, whichever of the two moves.
fn check_direction(chain: Chain, axis: Axis, moves: nalgebra::Vector3<f64>) -> Result<(), String> {
    let name = match axis {
        Axis::X | Axis::U => "x",
        Axis::Y | Axis::V => "y",
        _ => "z",
    };
    if direction_of(name).is_some_and(|wanted| (wanted.into_inner() - moves).norm() < 1e-9) {
        return Ok(());
    }
    let sign = match chain {
        Chain::Workpiece => '-',
        Chain::Tool => '+',
    };
    Err(format!(
        "as {axis} grows the tool must move towards +{name} against the workpiece: a unit of the {} chain needs \
         `linear = \"{sign}{name}\"`",
        chain.name()
    ))
}
