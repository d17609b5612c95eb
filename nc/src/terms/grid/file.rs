//! The grid as it is written in TOML.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Grid, GridAxis, ToolOffsetRange, nodes};
use crate::coordinates::{Axis, Coordinates};

#[derive(Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GridFile {
    name: String,
    #[serde(default)]
    includes_drive_errors: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tool: Option<ToolFile>,
    over: Vec<OverFile>,
    correct: Vec<CorrectFile>,
}

#[derive(Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ToolFile {
    offset_mm: BTreeMap<Axis, f64>,
    within_mm: f64,
}

#[derive(Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct OverFile {
    axis: Axis,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    places_mm: Option<Vec<f64>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    places_deg: Option<Vec<f64>>,
}

#[derive(Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CorrectFile {
    axis: Axis,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    values_mm: Option<Vec<f64>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    values_deg: Option<Vec<f64>>,
}

/// The list in the unit of the axis; the other must be absent.
fn in_unit(
    axis: Axis,
    what: &str,
    mm: Option<Vec<f64>>,
    deg: Option<Vec<f64>>,
) -> Result<Vec<f64>, String> {
    let (right, wrong) = if axis.is_rotary() {
        (deg, mm)
    } else {
        (mm, deg)
    };
    match (right, wrong) {
        (Some(list), None) => Ok(list),
        _ => Err(format!(
            "{axis} needs {what}_{}, and only that",
            axis.unit()
        )),
    }
}

/// The list under the key of the axis's unit: (`_mm`, `_deg`).
fn by_unit(axis: Axis, list: Vec<f64>) -> (Option<Vec<f64>>, Option<Vec<f64>>) {
    if axis.is_rotary() {
        (None, Some(list))
    } else {
        (Some(list), None)
    }
}

impl TryFrom<GridFile> for Grid {
    type Error = String;

    fn try_from(file: GridFile) -> Result<Self, String> {
        let mut over = Vec::new();
        for one in file.over {
            over.push(GridAxis {
                axis: one.axis,
                places: in_unit(one.axis, "places", one.places_mm, one.places_deg)?,
            });
        }
        let mut corrects = Vec::new();
        let mut columns = Vec::new();
        for one in file.correct {
            corrects.push(one.axis);
            columns.push(in_unit(one.axis, "values", one.values_mm, one.values_deg)?);
        }
        let values = interleaved(&corrects, &columns, nodes(&over))?;
        let tool = file.tool.map(tool).transpose()?;
        Ok(Self::new(file.name, over, corrects, values)?
            .including_drive_errors(file.includes_drive_errors)
            .for_tool(tool))
    }
}

fn interleaved(axes: &[Axis], columns: &[Vec<f64>], nodes: usize) -> Result<Vec<f64>, String> {
    for (axis, column) in axes.iter().zip(columns) {
        if column.len() != nodes {
            return Err(format!(
                "{} values correct {axis}, and the grid has {nodes} nodes: one value for each is needed",
                column.len()
            ));
        }
    }
    Ok((0..nodes)
        .flat_map(|node| columns.iter().map(move |column| column[node]))
        .collect())
}

fn tool(file: ToolFile) -> Result<ToolOffsetRange, String> {
    if !file.within_mm.is_finite() || file.within_mm <= 0.0 {
        return Err(format!(
            "within_mm = {}: it must be above 0 mm",
            file.within_mm
        ));
    }
    let offset: Coordinates = file.offset_mm.into_iter().collect();
    if !offset.is_finite() {
        return Err("offset_mm must be finite".to_owned());
    }
    Ok(ToolOffsetRange {
        offset,
        within_mm: file.within_mm,
    })
}

impl From<Grid> for GridFile {
    fn from(grid: Grid) -> Self {
        let width = grid.corrects.len();
        let column = |c: usize| grid.values.iter().skip(c).step_by(width).copied().collect();
        let correct = grid
            .corrects
            .iter()
            .enumerate()
            .map(|(c, axis)| {
                let (values_mm, values_deg) = by_unit(*axis, column(c));
                CorrectFile {
                    axis: *axis,
                    values_mm,
                    values_deg,
                }
            })
            .collect();
        let over = grid
            .over
            .into_iter()
            .map(|one| {
                let (places_mm, places_deg) = by_unit(one.axis, one.places);
                OverFile {
                    axis: one.axis,
                    places_mm,
                    places_deg,
                }
            })
            .collect();
        Self {
            name: grid.name,
            includes_drive_errors: grid.includes_drive_errors,
            tool: grid.tool.map(|tool| ToolFile {
                offset_mm: tool.offset.iter().filter(|(_, v)| *v != 0.0).collect(),
                within_mm: tool.within_mm,
            }),
            over,
            correct,
        }
    }
}
