//! Deviations over the working volume, and their corrections as a table for NC programs.

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::terms::grid::{Grid, GridAxis, ToolOffsetRange};
use leadscrew_nc::terms::{Circumstances, Term};
use nalgebra::Vector3;

use super::error::DeviationError;
use super::machine::{DriveErrors, Machine};
use crate::setting_vector::SettingVector;

/// Half of the stretch around the coordinate of an axis at rest over which a table of corrections is taken to hold, mm or degrees.
const AT_REST: f64 = 1e-3;

/// Deviation and correction at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPoint {
    /// Machine coordinates.
    pub at: Coordinates,
    /// Nominal place of the tool's tip in machine axes, mm.
    pub tip: Vector3<f64>,
    /// Δ, machine axes.
    pub delta: SettingVector,
    /// K.
    pub k: Coordinates,
    /// Δ that is left with K in force.
    pub left: SettingVector,
}

/// The machine over a grid of places, the last axis running fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// The axes of the grid with their places.
    pub over: Vec<GridAxis>,
    /// One point for each node.
    pub points: Vec<MapPoint>,
}

/// The largest of something over a map, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The value with its sign.
    pub value: f64,
    /// Where it is.
    pub at: Coordinates,
}

impl Map {
    /// The point with the largest absolute value of something.
    pub fn extreme(&self, of: impl Fn(&MapPoint) -> f64) -> Extreme {
        let start = Extreme {
            value: 0.0,
            at: Coordinates::ZERO,
        };
        self.points.iter().fold(start, |largest, point| {
            let value = of(point);
            if value.abs() > largest.value.abs() {
                Extreme {
                    value,
                    at: point.at,
                }
            } else {
                largest
            }
        })
    }
}

impl Machine {
    /// Evenly spaced places over all axes that place units, but those in `at_rest`: `steps` each, 2 at least.
    #[must_use]
    pub fn evenly(&self, at_rest: &[Axis], steps: usize) -> Vec<GridAxis> {
        let steps = steps.max(2);
        let moving = self.axes().into_iter();
        let moving = moving.filter(|(axis, _)| !at_rest.contains(axis));
        moving
            .map(|(axis, (low, high))| {
                let place = |i: usize| {
                    let part = i as f64 / (steps - 1) as f64;
                    low * (1.0 - part) + high * part
                };
                GridAxis {
                    axis,
                    places: (0..steps).map(place).collect(),
                }
            })
            .collect()
    }

    /// Deviation and correction at one place.
    ///
    /// # Errors
    /// As [`Machine::correction`].
    pub fn point(&self, at: &Coordinates) -> Result<MapPoint, DeviationError> {
        let correction = self.correction(at)?;
        Ok(MapPoint {
            at: *at,
            tip: self.tip(at)?.coords,
            delta: self.deviation(at)?,
            k: correction.k,
            left: correction.left,
        })
    }

    /// Deviation and correction at every node of a grid; the other axes stand at `rest`.
    ///
    /// # Errors
    /// As [`Machine::correction`].
    pub fn map(&self, rest: &Coordinates, over: Vec<GridAxis>) -> Result<Map, DeviationError> {
        let count = over.iter().map(|one| one.places.len()).product();
        let mut points = Vec::with_capacity(count);
        for node in 0..count {
            points.push(self.point(&place_of(rest, &over, node))?);
        }
        Ok(Map { over, points })
    }

    /// The corrections K over a grid as a table for NC programs. It says whether the drives' own errors are in it, and holds for
    /// tools whose tip lies where an error of `within_mm` follows from no turn on the grid; of an axis of the machine that is not
    /// in `over` it holds at its place in `rest` only.
    ///
    /// # Errors
    /// A place without a correction, or more axes than a table can have, in words.
    pub fn corrections(
        &self,
        rest: &Coordinates,
        over: Vec<GridAxis>,
        within_mm: f64,
    ) -> Result<Grid, String> {
        let map = self
            .map(rest, over.clone())
            .map_err(|error| error.to_string())?;
        let turn = map.extreme(|point| point.delta.turn.norm()).value;
        let mut guarded = over;
        for (axis, _) in self.axes() {
            if guarded.iter().all(|one| one.axis != axis) {
                let place = rest[axis];
                guarded.push(GridAxis {
                    axis,
                    places: vec![place - AT_REST, place + AT_REST],
                });
            }
        }
        let moving = map.over;
        let values = guarded.clone();
        Grid::sampled(
            format!("deviations of {}", self.name),
            guarded,
            self.corrected(),
            |node| {
                let at = values.iter().fold(*rest, |at, one| {
                    let moves = moving.iter().any(|other| other.axis == one.axis);
                    let place = if moves {
                        node[one.axis]
                    } else {
                        rest[one.axis]
                    };
                    at.with(one.axis, place)
                });
                let found = self.correction(&at).map_err(|error| error.to_string())?;
                Ok(found.k.iter().map(|(axis, k)| (axis, rounded(k))).collect())
            },
        )
        .map(|grid| {
            grid.including_drive_errors(self.drive_errors == DriveErrors::Included)
                .for_tool((turn > 0.0).then(|| ToolOffsetRange {
                    offset: Coordinates::xyz(-self.tool_mm.x, -self.tool_mm.y, -self.tool_mm.z),
                    within_mm: within_mm / turn,
                }))
        })
    }

    /// Most by which a table of corrections, linear between its nodes, differs from K in the middles of its cells, mm over the
    /// linear axes.
    ///
    /// # Errors
    /// As [`Machine::correction`], in words.
    pub fn interpolation_error_mm(&self, rest: &Coordinates, grid: &Grid) -> Result<f64, String> {
        let over = grid.over();
        let count: usize = over.iter().map(|one| one.places.len() - 1).product();
        let tool_offset = grid.tool().map(|tool| tool.offset);
        let with = Circumstances {
            tool_offset,
            ..Circumstances::default()
        };
        let mut largest = 0.0_f64;
        let middle = |one: &GridAxis| GridAxis {
            axis: one.axis,
            places: one
                .places
                .windows(2)
                .map(|ends| 0.5 * (ends[0] + ends[1]))
                .collect(),
        };
        let cells: Vec<GridAxis> = over.iter().map(middle).collect();
        for cell in 0..count {
            let at = place_of(rest, &cells, cell);
            let table = grid.correction(&at, &with).map_err(|e| e.to_string())?;
            let k = self.correction(&at).map_err(|e| e.to_string())?.k;
            largest = largest.max((table - k).length_mm());
        }
        Ok(largest)
    }
}

/// To 0.01 nm: what lies below is rounding of the sums.
fn rounded(value: f64) -> f64 {
    (value * 1e8).round() / 1e8 + 0.0
}

/// The place of a node, the last axis running fastest.
fn place_of(rest: &Coordinates, over: &[GridAxis], node: usize) -> Coordinates {
    let mut left = node;
    let mut at = *rest;
    for one in over.iter().rev() {
        let count = one.places.len();
        at[one.axis] = one.places[left % count];
        left /= count;
    }
    at
}
