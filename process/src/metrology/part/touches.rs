//! Touches as a table.
//!
//! | column | |
//! | --- | --- |
//! | `feature`, `point` | which touch; needed |
//! | `x_mm`, `y_mm`, `z_mm` | planned place on the surface; not needed where the part's file has it |
//! | `approach` | direction of the probe's motion, `-z` or `0.6 0 -0.8`; likewise |
//! | `deviation_mm` | measured less planned coordinate, positive along the axis of an approach along an axis; or |
//! | `measured_x_mm`, `measured_y_mm`, `measured_z_mm` | the place found |
//! | `sigma_mm` | 1σ of the touch along the normal; else that of the probe |

use leadscrew_nc::source::Complaint;

use super::{Feature, Part, Planned, Touches, normal_of_approach};
use crate::metrology::touch::{Axis, Touch};
use leadscrew_nc::csv_text::{CsvText, Row};

const NEEDED: [&str; 2] = ["feature", "point"];
const OPTIONAL: [&str; 9] = [
    "x_mm",
    "y_mm",
    "z_mm",
    "approach",
    "deviation_mm",
    "measured_x_mm",
    "measured_y_mm",
    "measured_z_mm",
    "sigma_mm",
];

/// Reads a table of touches of a part.
///
/// # Errors
/// Where and what is wrong: an unknown feature, a touch twice or not at all, a number that is none.
pub fn read(text: &str, part: &Part) -> Result<Touches, Complaint> {
    let table = CsvText::read(text, &NEEDED, &OPTIONAL)?;
    let reader = Reader {
        table: &table,
        part,
    };
    reader.check_columns()?;
    let mut touches: Touches = vec![Vec::new(); part.features.len()];
    for row in table.rows() {
        let (feature, point, touch) = reader.touch(&row)?;
        if touches[feature].iter().any(|(other, _)| *other == point) {
            let message = format!(
                "point {point} of {} is there twice",
                part.features[feature].name
            );
            return Err(row.complain("point", message));
        }
        touches[feature].push((point, touch));
    }
    reader.check_complete(text, &touches)?;
    Ok(touches)
}

struct Reader<'a> {
    table: &'a CsvText<'a>,
    part: &'a Part,
}

impl Reader<'_> {
    fn check_columns(&self) -> Result<(), Complaint> {
        let has = |name| self.table.has(name);
        let missing = |message: String| Err(self.table.complain_of_header(message));
        if has("deviation_mm") == has("measured_x_mm") {
            let which = if has("deviation_mm") {
                "one of the two only"
            } else {
                "one of the two"
            };
            return missing(format!(
                "expected `deviation_mm`, or `measured_x_mm` with y and z: {which}"
            ));
        }
        for name in ["measured_y_mm", "measured_z_mm"] {
            if has("measured_x_mm") && !has(name) {
                return missing(format!(
                    "there is no column \"{name}\" beside `measured_x_mm`"
                ));
            }
        }
        Ok(())
    }

    fn touch(&self, row: &Row<'_>) -> Result<(usize, String, Touch), Complaint> {
        let index = self.feature_of(row)?;
        let feature = &self.part.features[index];
        let point = row.text("point").to_owned();
        let planned = self.planned(row, feature, &point)?;
        let measured = self.measured(row, &planned)?;
        let mut touch = Touch::at(planned.nominal, planned.normal, measured);
        let own = row.optional_number("sigma_mm")?;
        if own.is_some_and(|sigma| sigma <= 0.0) {
            return Err(row.complain("sigma_mm", "expected a 1σ above 0 mm, or nothing"));
        }
        touch.sigma_mm = own.or(self.part.probe.sigma_mm);
        Ok((index, point, touch))
    }

    fn feature_of(&self, row: &Row<'_>) -> Result<usize, Complaint> {
        let touched = || {
            let features = self.part.features.iter().enumerate();
            features.filter(|(_, feature)| feature.is_touched())
        };
        let found = touched().find(|(_, feature)| feature.name == row.text("feature"));
        found.map(|(index, _)| index).ok_or_else(|| {
            let known: Vec<&str> = touched()
                .map(|(_, feature)| feature.name.as_str())
                .collect();
            let has = if known.is_empty() {
                "none: add features to its file".to_owned()
            } else {
                known.join(", ")
            };
            let message = format!(
                "`{}`: the part has no such feature to touch; it has {has}",
                row.text("feature")
            );
            row.complain("feature", message)
        })
    }

    /// The planned touch by the part's file, over which the row goes.
    fn planned(&self, row: &Row<'_>, feature: &Feature, point: &str) -> Result<Planned, Complaint> {
        let known = feature
            .planned
            .iter()
            .find(|planned| planned.point == point);
        let place = self.places(row, ["x_mm", "y_mm", "z_mm"])?;
        let approach = match row.text("approach") {
            "" => None,
            direction => Some(normal_of_approach(direction).ok_or_else(|| {
                let message =
                    format!("`{direction}`: expected a direction such as -z, or three numbers");
                row.complain("approach", message)
            })?),
        };
        let nominal = place.or(known.map(|known| known.nominal));
        let normal = approach.or(known.map(|known| known.normal));
        let (Some(nominal), Some(normal)) = (nominal, normal) else {
            let lacks = if nominal.is_none() {
                "x_mm, y_mm, z_mm"
            } else {
                "approach"
            };
            let message = format!(
                "point {point} of {} is not in the part's file: expected {lacks} here",
                feature.name
            );
            return Err(row.complain("point", message));
        };
        Ok(Planned {
            point: point.to_owned(),
            nominal,
            normal,
        })
    }

    fn measured(&self, row: &Row<'_>, planned: &Planned) -> Result<[f64; 3], Complaint> {
        if !self.table.has("deviation_mm") {
            let names = ["measured_x_mm", "measured_y_mm", "measured_z_mm"];
            let measured = self
                .places(row, names)?
                .ok_or_else(|| row.complain("point", "the place measured is missing"))?;
            return Ok(if self.part.table.is_of_stylus {
                self.part.probe.surface(measured, planned.normal)
            } else {
                measured
            });
        }
        let deviation = row.optional_number("deviation_mm")?;
        let deviation =
            deviation.ok_or_else(|| row.complain("deviation_mm", "the deviation is missing"))?;
        let Some(axis) = Axis::along(planned.normal) else {
            let message = "the approach is oblique, so that a deviation of one coordinate does not tell the place: give measured_x_mm, measured_y_mm, measured_z_mm";
            return Err(row.complain("deviation_mm", message));
        };
        let mut measured = planned.nominal;
        measured[axis.index()] += self.true_length(axis, deviation);
        Ok(measured)
    }

    /// Three cells, or none of them.
    fn places(&self, row: &Row<'_>, names: [&str; 3]) -> Result<Option<[f64; 3]>, Complaint> {
        let mut place = [None; 3];
        for axis in Axis::ALL {
            let number = row.optional_number(names[axis.index()])?;
            place[axis.index()] = number.map(|number| self.true_length(axis, number));
        }
        match place {
            [Some(x), Some(y), Some(z)] => Ok(Some([x, y, z])),
            [None, None, None] => Ok(None),
            _ => Err(row.complain(
                "point",
                format!("expected all of {} or none", names.join(", ")),
            )),
        }
    }

    fn true_length(&self, axis: Axis, value: f64) -> f64 {
        if axis == Axis::X && self.part.table.x_is_diameter {
            value / 2.0
        } else {
            value
        }
    }

    /// Planned touches that are not in the table would go unnoticed.
    fn check_complete(&self, text: &str, touches: &Touches) -> Result<(), Complaint> {
        for (feature, touches) in self.part.features.iter().zip(touches) {
            let is_missing =
                |planned: &&Planned| touches.iter().all(|(point, _)| *point != planned.point);
            let missing: Vec<&str> = feature
                .planned
                .iter()
                .filter(is_missing)
                .map(|planned| planned.point.as_str())
                .collect();
            if !missing.is_empty() || (feature.is_touched() && touches.is_empty()) {
                let which = if missing.is_empty() {
                    "all its touches".to_owned()
                } else {
                    format!("point {}", missing.join(", "))
                };
                let message = format!("{}: {which} missing from the table", feature.name);
                return Err(Complaint::at(text, &(text.len()..text.len()), message));
            }
        }
        Ok(())
    }
}
