//! Tool wear: what a tool's offset has changed by since it was entered in the control's table, by tool number.
//!
//! A change of the offset (control point less tip) is added to the place of the control point: K = +change. A worn drill is
//! shorter, its change in Z is negative. A turning tool's nose that wears moves the imaginary tip, at which the program
//! aims: its radius changed by ρ moves it by −ρ along the directions of the tool's orientation from nose centre to tip. That
//! is exact on cylinders and faces; on tapers and arcs the control's own nose radius compensation has to know the new radius.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use super::{Circumstances, Region, Shape, Steepness, Term, TermError, Trouble};
use crate::checks::{ByAxis, coordinates, within};
use crate::coordinates::{Axis, AxisSet, Coordinates};
use crate::source::Complaint;

/// Largest wear that is believed, mm.
const LARGEST_MM: f64 = 10.0;

/// Wear of one tool as it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WearFile {
    tool: u32,
    /// Change of the tool's offset: measured less entered.
    #[serde(default)]
    offset_mm: ByAxis,
    /// Change of a turning tool's nose radius: measured less entered.
    nose_radius_mm: Option<Spanned<f64>>,
    /// As in LinuxCNC's tool table, 1 to 9: on which side of the nose centre the imaginary tip lies.
    orientation: Option<Spanned<u8>>,
}

/// Wear of the tools of a list; others have none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wear {
    name: String,
    tools: BTreeMap<u32, Coordinates>,
}

impl Wear {
    /// Changes of tools' offsets by tool number.
    #[must_use]
    pub fn new(name: impl Into<String>, tools: BTreeMap<u32, Coordinates>) -> Self {
        Self {
            name: name.into(),
            tools,
        }
    }

    /// From what is written, a list of tools.
    ///
    /// # Errors
    /// What is wrong in the text, and where.
    pub fn from_list(
        name: &str,
        text: &str,
        list: &[Spanned<WearFile>],
    ) -> Result<Self, Complaint> {
        let mut tools = BTreeMap::new();
        for file in list {
            let wear = file.get_ref();
            let change = coordinates(text, "offset_mm", &wear.offset_mm, false, LARGEST_MM)?
                + nose(text, wear)?;
            if tools.insert(wear.tool, change).is_some() {
                return Err(Complaint::at(
                    text,
                    &file.span(),
                    format!("tool {} is worn twice: state its wear once", wear.tool),
                ));
            }
        }
        Ok(Self::new(name, tools))
    }
}

fn nose(text: &str, wear: &WearFile) -> Result<Coordinates, Complaint> {
    let (Some(radius), orientation) = (&wear.nose_radius_mm, &wear.orientation) else {
        return Ok(Coordinates::ZERO);
    };
    let change = within(
        text,
        "nose_radius_mm",
        radius,
        (-LARGEST_MM, LARGEST_MM),
        "mm",
    )?;
    let tip = orientation
        .as_ref()
        .and_then(|number| tip(*number.get_ref()));
    let (x, z) = tip.ok_or_else(|| {
        let span = orientation.as_ref().map_or(radius.span(), Spanned::span);
        Complaint::at(
            text,
            &span,
            "nose_radius_mm needs orientation = 1 to 9, that of the tool table: the radius of a milling cutter acts across the \
             path and is corrected in the control's own table",
        )
    })?;
    // The nose centre stays in the holder while the tip draws back towards it: control point less tip grows by −ρ along the
    // direction from centre to tip.
    Ok(Coordinates::xyz(-change * x, 0.0, -change * z))
}

/// Directions from the nose centre to the imaginary tip in X and Z by orientation, as LinuxCNC numbers them: 2 is the common
/// tool for turning outside towards the chuck, 9 is programmed at the centre.
#[must_use]
pub fn tip(orientation: u8) -> Option<(f64, f64)> {
    Some(match orientation {
        1 => (-1.0, 1.0),
        2 => (-1.0, -1.0),
        3 => (1.0, -1.0),
        4 => (1.0, 1.0),
        5 => (0.0, 1.0),
        6 => (-1.0, 0.0),
        7 => (0.0, -1.0),
        8 => (1.0, 0.0),
        9 => (0.0, 0.0),
        _ => return None,
    })
}

impl Term for Wear {
    fn name(&self) -> &str {
        &self.name
    }

    fn correction(&self, _: &Coordinates, with: &Circumstances) -> Result<Coordinates, TermError> {
        let tool = with.tool.ok_or_else(|| TermError {
            term: self.name.clone(),
            trouble: Trouble::ToolUnknown,
        })?;
        Ok(self.tools.get(&tool).copied().unwrap_or_default())
    }

    fn corrects(&self) -> AxisSet {
        self.tools
            .values()
            .flat_map(Coordinates::iter)
            .filter(|(_, change)| *change != 0.0)
            .map(|(axis, _): (Axis, f64)| axis)
            .collect()
    }

    fn depends_on(&self) -> AxisSet {
        AxisSet::NONE
    }

    fn depends_on_tool(&self) -> bool {
        true
    }

    fn shape(&self) -> Shape {
        if self.corrects().is_empty() {
            Shape::None
        } else {
            Shape::Constant
        }
    }

    fn steepness(&self, _: &Region) -> Steepness {
        Steepness::default()
    }
}
