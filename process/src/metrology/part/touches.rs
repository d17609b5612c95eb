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
use crate::csv_table::{Cell, CsvTable};
use crate::metrology::touch::{Axis, Touch};

const COLUMNS: [&str; 11] = [
    "feature",
    "point",
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
    let table = CsvTable::read(text, &COLUMNS)?;
    let reader = Reader {
        feature: table.needed("feature")?,
        point: table.needed("point")?,
        table: &table,
        part,
    };
    reader.check_columns()?;
    let mut touches: Touches = vec![Vec::new(); part.features.len()];
    for row in table.rows() {
        let (feature, point, touch) = reader.touch(row)?;
        if touches[feature].iter().any(|(other, _)| *other == point) {
            let message = format!(
                "point {point} of {} is there twice",
                part.features[feature].name
            );
            return Err(table.complain(&row[reader.point], message));
        }
        touches[feature].push((point, touch));
    }
    reader.check_complete(text, &touches)?;
    Ok(touches)
}

struct Reader<'a> {
    table: &'a CsvTable<'a>,
    part: &'a Part,
    feature: usize,
    point: usize,
}

impl Reader<'_> {
    fn check_columns(&self) -> Result<(), Complaint> {
        let has = |name| self.table.column(name).is_some();
        if has("deviation_mm") == has("measured_x_mm") {
            let missing = if has("deviation_mm") {
                "one of the two only"
            } else {
                "one of the two"
            };
            let message =
                format!("expected `deviation_mm`, or `measured_x_mm` with y and z: {missing}");
            // The head of the table.
            return Err(Complaint {
                place: leadscrew_nc::source::Place { line: 1, column: 1 },
                message,
            });
        }
        if has("measured_x_mm") {
            self.table.needed("measured_y_mm")?;
            self.table.needed("measured_z_mm")?;
        }
        Ok(())
    }

    fn touch(&self, row: &[Cell]) -> Result<(usize, String, Touch), Complaint> {
        let index = self.feature_of(&row[self.feature])?;
        let feature = &self.part.features[index];
        let point = row[self.point].content.clone();
        let planned = self.planned(row, feature, &point)?;
        let measured = self.measured(row, &planned)?;
        let mut touch = Touch::at(planned.nominal, planned.normal, measured);
        let own = match self.table.column("sigma_mm") {
            Some(column) => self.table.number(&row[column])?,
            None => None,
        };
        if own.is_some_and(|sigma| sigma <= 0.0)
            && let Some(column) = self.table.column("sigma_mm")
        {
            return Err(self
                .table
                .complain(&row[column], "expected a 1σ above 0 mm, or nothing"));
        }
        touch.sigma_mm = own.or(self.part.probe.sigma_mm);
        Ok((index, point, touch))
    }

    fn feature_of(&self, cell: &Cell) -> Result<usize, Complaint> {
        let touched = || {
            let features = self.part.features.iter().enumerate();
            features.filter(|(_, feature)| feature.is_touched())
        };
        let found = touched().find(|(_, feature)| feature.name == cell.content);
        found.map(|(index, _)| index).ok_or_else(|| {
            let known: Vec<&str> = touched()
                .map(|(_, feature)| feature.name.as_str())
                .collect();
            let message = format!(
                "`{}`: the part has no such feature to touch; it has {}",
                cell.content,
                known.join(", ")
            );
            self.table.complain(cell, message)
        })
    }

    /// The planned touch by the part's file, over which the row goes.
    fn planned(&self, row: &[Cell], feature: &Feature, point: &str) -> Result<Planned, Complaint> {
        let known = feature
            .planned
            .iter()
            .find(|planned| planned.point == point);
        let place = self.places(row, ["x_mm", "y_mm", "z_mm"])?;
        let approach = match self.table.column("approach") {
            Some(column) if !row[column].content.is_empty() => {
                let normal = normal_of_approach(&row[column].content);
                Some(normal.ok_or_else(|| {
                    let message = format!(
                        "`{}`: expected a direction such as -z, or three numbers",
                        row[column].content
                    );
                    self.table.complain(&row[column], message)
                })?)
            }
            _ => None,
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
            return Err(self.table.complain(&row[self.point], message));
        };
        Ok(Planned {
            point: point.to_owned(),
            nominal,
            normal,
        })
    }

    fn measured(&self, row: &[Cell], planned: &Planned) -> Result<[f64; 3], Complaint> {
        let Some(column) = self.table.column("deviation_mm") else {
            let names = ["measured_x_mm", "measured_y_mm", "measured_z_mm"];
            let measured = self.places(row, names)?.ok_or_else(|| {
                self.table
                    .complain(&row[self.point], "the place measured is missing")
            })?;
            return Ok(if self.part.table.is_of_stylus {
                self.part.probe.surface(measured, planned.normal)
            } else {
                measured
            });
        };
        let cell = &row[column];
        let deviation = self.table.number(cell)?;
        let deviation =
            deviation.ok_or_else(|| self.table.complain(cell, "the deviation is missing"))?;
        let Some(axis) = Axis::along(planned.normal) else {
            let message = "the approach is oblique, so that a deviation of one coordinate does not tell the place: give measured_x_mm, measured_y_mm, measured_z_mm";
            return Err(self.table.complain(cell, message));
        };
        let mut measured = planned.nominal;
        measured[axis.index()] += self.true_length(axis, deviation);
        Ok(measured)
    }

    /// Three cells, or none of them.
    fn places(&self, row: &[Cell], names: [&str; 3]) -> Result<Option<[f64; 3]>, Complaint> {
        let mut place = [None; 3];
        for axis in Axis::ALL {
            if let Some(column) = self.table.column(names[axis.index()]) {
                let number = self.table.number(&row[column])?;
                place[axis.index()] = number.map(|number| self.true_length(axis, number));
            }
        }
        match place {
            [Some(x), Some(y), Some(z)] => Ok(Some([x, y, z])),
            [None, None, None] => Ok(None),
            _ => Err(self.table.complain(
                &row[self.point],
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
