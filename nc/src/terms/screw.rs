//! The screw map: what a drive's own positioning is off at places of its travel, having come from below and from above.
//!
//! A file of them is the CSV of the on-board screw table, `position_mm,forward_um,backward_um`: carriage less place, reached
//! towards larger and towards smaller coordinates. In TOML a point has the same keys; `backward_um` left out is the same as
//! `forward_um`. K = −error.

mod csv_form;

use serde::Deserialize;
use toml::Spanned;

use super::table::Table;
use super::{Circumstances, Direction, Region, Shape, Steepness, Term, TermError, Trouble};
use crate::checks::{FARTHEST, within};
use crate::coordinates::{Axis, AxisSet, Coordinates};
use crate::source::Complaint;

/// Largest error of a screw that is believed, µm.
const LARGEST_UM: f64 = 10_000.0;

/// A point as it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointFile {
    position_mm: Spanned<f64>,
    forward_um: Spanned<f64>,
    backward_um: Option<Spanned<f64>>,
}

/// The screw map of one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct ScrewMap {
    name: String,
    axis: Axis,
    /// Errors in mm, having come towards larger and towards smaller coordinates.
    forward: Table,
    backward: Table,
}

impl ScrewMap {
    /// A map from points (place, error coming upward, error coming downward), mm; degrees for a rotary axis.
    ///
    /// # Errors
    /// What is wrong with the numbers, in words.
    pub fn new(
        name: impl Into<String>,
        axis: Axis,
        points: &[(f64, f64, f64)],
    ) -> Result<Self, String> {
        let table = |error: fn(&(f64, f64, f64)) -> f64| {
            Table::new(
                axis,
                points.iter().map(|point| point.0).collect(),
                points.iter().map(error).collect(),
            )
        };
        Ok(Self {
            name: name.into(),
            axis,
            forward: table(|point| point.1)?,
            backward: table(|point| point.2)?,
        })
    }

    /// A map from the CSV of the on-board screw table.
    ///
    /// # Errors
    /// What is wrong in the text, and where.
    pub fn read_csv(name: &str, axis: Axis, text: &str) -> Result<Self, Complaint> {
        Self::from_points(name, axis, text, &csv_form::points(text)?)
    }

    /// A map from the points of a text.
    ///
    /// # Errors
    /// What is wrong in the text, and where.
    pub fn from_points(
        name: &str,
        axis: Axis,
        text: &str,
        points: &[PointFile],
    ) -> Result<Self, Complaint> {
        let error = |key: &str, value: &Spanned<f64>| {
            within(text, key, value, (-LARGEST_UM, LARGEST_UM), "um").map(|um| um / 1000.0)
        };
        let mut checked: Vec<(f64, f64, f64)> = Vec::new();
        for point in points {
            let at = within(
                text,
                "position_mm",
                &point.position_mm,
                (-FARTHEST, FARTHEST),
                "mm",
            )?;
            let forward = error("forward_um", &point.forward_um)?;
            let backward = match &point.backward_um {
                Some(value) => error("backward_um", value)?,
                None => forward,
            };
            if checked.last().is_some_and(|(last, ..)| *last >= at) {
                return Err(Complaint::at(
                    text,
                    &point.position_mm.span(),
                    format!(
                        "position_mm = {at} mm is not above the one before: the points must rise"
                    ),
                ));
            }
            checked.push((at, forward, backward));
        }
        Self::new(name, axis, &checked).map_err(|message| {
            Complaint::at(text, &(0..0), format!("the screw map of {axis}: {message}"))
        })
    }

    /// Its axis.
    #[must_use]
    pub fn axis(&self) -> Axis {
        self.axis
    }

    fn is_directional(&self) -> bool {
        self.forward != self.backward
    }
}

impl Term for ScrewMap {
    fn name(&self) -> &str {
        &self.name
    }

    fn correction(&self, at: &Coordinates, with: &Circumstances) -> Result<Coordinates, TermError> {
        let table = match with.approach.of(self.axis) {
            Some(Direction::Down) => &self.backward,
            None if self.is_directional() => {
                return Err(TermError {
                    term: self.name.clone(),
                    trouble: Trouble::ApproachUnknown { axis: self.axis },
                });
            }
            _ => &self.forward,
        };
        let error = table.at(at[self.axis], &self.name)?;
        Ok(Coordinates::ZERO.with(self.axis, -error))
    }

    fn corrects(&self) -> AxisSet {
        AxisSet::of(self.axis)
    }

    fn depends_on(&self) -> AxisSet {
        AxisSet::of(self.axis)
    }

    fn depends_on_approach_of(&self) -> AxisSet {
        if self.is_directional() {
            AxisSet::of(self.axis)
        } else {
            AxisSet::NONE
        }
    }

    fn shape(&self) -> Shape {
        if self.forward.largest() == 0.0 && self.backward.largest() == 0.0 {
            Shape::None
        } else {
            Shape::Curved
        }
    }

    fn breaks(&self, axis: Axis, found: &mut dyn FnMut(&[f64])) {
        if axis == self.axis {
            found(self.forward.places());
        }
    }

    fn steepness(&self, _: &Region) -> Steepness {
        Steepness {
            slope: self.forward.steepest().max(self.backward.steepest()),
            bend: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Approach;
    use super::*;

    const TEXT: &str = "# measured cold\nposition_mm,forward_um,backward_um\n0,0,8\n100, 10,20\n";

    fn coming(direction: Direction) -> Circumstances {
        Circumstances {
            approach: Approach::UNKNOWN.with(Axis::Z, direction),
            ..Circumstances::default()
        }
    }

    #[test]
    fn it_undoes_the_error_of_the_direction_it_came_from() {
        let map = ScrewMap::read_csv("screw Z", Axis::Z, TEXT).unwrap();
        let at = Coordinates::xyz(0.0, 0.0, 25.0);
        let k = |with| map.correction(&at, &with).map(|k| k[Axis::Z]);
        assert!((k(coming(Direction::Up)).unwrap() + 0.0025).abs() < 1e-15);
        assert!((k(coming(Direction::Down)).unwrap() + 0.011).abs() < 1e-15);
        let unknown = k(Circumstances::default()).unwrap_err().to_string();
        assert!(unknown.contains("from which side Z came"), "{unknown}");
        assert_eq!(map.depends_on_approach_of(), AxisSet::of(Axis::Z));
    }

    #[test]
    fn one_error_for_both_directions_needs_no_direction() {
        let text = TEXT.replace("0,0,8", "0,0,0").replace("10,20", "10,10");
        let map = ScrewMap::read_csv("screw Z", Axis::Z, &text).unwrap();
        let at = Coordinates::xyz(0.0, 0.0, 25.0);
        let k = map.correction(&at, &Circumstances::default()).unwrap();
        assert!((k[Axis::Z] + 0.0025).abs() < 1e-15);
        assert!(map.depends_on_approach_of().is_empty());
    }

    #[test]
    fn bad_points_are_refused_at_their_place() {
        for (from, to, message) in [
            ("100,", "0,", "4:1: position_mm = 0 mm is not above"),
            (
                " 10,",
                " 1e6,",
                "4:6: forward_um = 1000000 um is out of range",
            ),
            (
                "0,0,8",
                "0,0,",
                "3:5: backward_um = \"\": expected a number",
            ),
            (
                "0,0,8",
                "0,0",
                "3:1: 2 fields, and the header has 3 columns",
            ),
            (
                "forward_um,",
                "forwards,",
                "2:13: column \"forwards\" is not known: expected position_mm, forward_um",
            ),
            ("\n100, 10,20", "", "1:1: the screw map of Z: two places"),
        ] {
            let error = ScrewMap::read_csv("s", Axis::Z, &TEXT.replace(from, to)).unwrap_err();
            assert!(error.to_string().starts_with(message), "{error}");
        }
    }
}
