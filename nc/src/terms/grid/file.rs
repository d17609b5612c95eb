//! The grid as it is written in TOML.

use std::collections::BTreeMap;

use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use toml::Spanned;

use super::{Grid, GridAxis, ToolOffsetRange, check_places, nodes};
use crate::coordinates::{Axis, Coordinates};
use crate::source::{Complaint, read_toml};

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

/// Where the parts of a grid are in a text.
#[derive(Deserialize)]
struct Spans {
    over: Vec<Spanned<IgnoredAny>>,
    correct: Vec<Spanned<IgnoredAny>>,
}

/// A grid from a text, what is wrong with its numbers at the part that has them.
pub(super) fn read(text: &str) -> Result<Grid, Complaint> {
    let file: GridFile = read_toml(text)?;
    let spans: Spans = read_toml(text)?;
    let nodes = file.over.iter().fold(1_usize, |product, one| {
        let places = one.places_mm.as_ref().or(one.places_deg.as_ref());
        product.saturating_mul(places.map_or(1, Vec::len))
    });
    for (one, span) in file.over.iter().zip(&spans.over) {
        one.clone()
            .checked()
            .and_then(|axis| check_places(&axis))
            .map_err(|message| Complaint::at(text, &span.span(), message))?;
    }
    for (one, span) in file.correct.iter().zip(&spans.correct) {
        let values = in_unit(
            one.axis,
            "values",
            one.values_mm.clone(),
            one.values_deg.clone(),
        );
        values
            .and_then(|column| check_column(one.axis, &column, nodes))
            .map_err(|message| Complaint::at(text, &span.span(), message))?;
    }
    Grid::try_from(file).map_err(|message| Complaint::at(text, &(0..0), message))
}

impl OverFile {
    fn checked(self) -> Result<GridAxis, String> {
        Ok(GridAxis {
            axis: self.axis,
            places: in_unit(self.axis, "places", self.places_mm, self.places_deg)?,
        })
    }
}

impl TryFrom<GridFile> for Grid {
    type Error = String;

    fn try_from(file: GridFile) -> Result<Self, String> {
        let mut over = Vec::new();
        for one in file.over {
            over.push(one.checked()?);
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

fn check_column(axis: Axis, column: &[f64], nodes: usize) -> Result<(), String> {
    if column.len() != nodes {
        return Err(format!(
            "{} values correct {axis}, and the grid has {nodes} nodes: one value for each is needed",
            column.len()
        ));
    }
    match column.iter().find(|value| !value.is_finite()) {
        Some(value) => Err(format!(
            "a value of {axis} is {value}: it must be a finite number"
        )),
        None => Ok(()),
    }
}

fn interleaved(axes: &[Axis], columns: &[Vec<f64>], nodes: usize) -> Result<Vec<f64>, String> {
    for (axis, column) in axes.iter().zip(columns) {
        check_column(*axis, column, nodes)?;
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
