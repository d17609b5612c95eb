//! The terms of a setup file.

use std::collections::BTreeSet;
use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;

use super::ReadFile;
use crate::coordinates::{Axis, AxisSet};
use crate::source::Complaint;
use crate::terms::Term;
use crate::terms::affine::{Affine, AffineFile};
use crate::terms::grid::Grid;
use crate::terms::screw::{PointFile, ScrewMap};
use crate::terms::thermal::{Thermal, ThermalFile};
use crate::terms::wear::{Wear, WearFile};
use crate::terms::workpiece::{Workpiece, WorkpieceFile};

/// Tables of terms, by kind.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TermsFile {
    #[serde(default)]
    affine: Vec<Spanned<AffineFile>>,
    #[serde(default)]
    grid: Vec<Spanned<GridEntry>>,
    #[serde(default)]
    screw: Vec<Spanned<ScrewEntry>>,
    #[serde(default)]
    thermal: Vec<Spanned<ThermalFile>>,
    #[serde(default)]
    wear: Vec<Spanned<WearFile>>,
    #[serde(default)]
    workpiece: Vec<Spanned<WorkpieceFile>>,
}

/// A grid in a file of its own.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct GridEntry {
    file: Spanned<String>,
}

/// A screw map: its points here, or in a file of its own.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ScrewEntry {
    name: Option<String>,
    axis: Spanned<Axis>,
    file: Option<Spanned<String>>,
    points: Option<Vec<PointFile>>,
}

/// A term with its place in the setup.
pub(super) struct Built {
    pub term: Box<dyn Term>,
    pub span: Range<usize>,
    /// Axes of whose drives it corrects the positioning errors.
    pub owns_screw_of: AxisSet,
}

impl Built {
    fn new(term: impl Term + 'static, span: Range<usize>) -> Self {
        Self {
            term: Box::new(term),
            span,
            owns_screw_of: AxisSet::NONE,
        }
    }
}

/// All terms of a setup, their names different.
///
/// # Errors
/// What is wrong, and where.
pub(super) fn build(
    text: &str,
    file: &TermsFile,
    files: ReadFile<'_>,
) -> Result<Vec<Built>, Complaint> {
    let mut all = Vec::new();
    for one in &file.affine {
        all.push(Built::new(
            Affine::from_file(text, one.get_ref())?,
            one.span(),
        ));
    }
    for one in &file.grid {
        all.push(grid(text, one, files)?);
    }
    for one in &file.screw {
        all.push(screw(text, one, files)?);
    }
    for one in &file.thermal {
        all.push(Built::new(
            Thermal::from_file(text, one.get_ref())?,
            one.span(),
        ));
    }
    for one in &file.workpiece {
        all.push(Built::new(
            Workpiece::from_file(text, one.get_ref())?,
            one.span(),
        ));
    }
    if let Some(first) = file.wear.first() {
        let wear = Wear::from_list("tool wear", text, &file.wear)?;
        all.push(Built::new(wear, first.span()));
    }
    let mut names = BTreeSet::new();
    for one in &all {
        if !names.insert(one.term.name()) {
            let message = format!(
                "two terms are named \"{}\": give each its own name, reports and messages go by it",
                one.term.name()
            );
            return Err(Complaint::at(text, &one.span, message));
        }
    }
    Ok(all)
}

/// The text of a file, and how to put its name in front of what is wrong in it.
fn content(text: &str, name: &Spanned<String>, files: ReadFile<'_>) -> Result<String, Complaint> {
    files(name.get_ref()).map_err(|message| Complaint::at(text, &name.span(), message))
}

fn inside(text: &str, name: &Spanned<String>, complaint: &Complaint) -> Complaint {
    Complaint::at(
        text,
        &name.span(),
        format!("{}:{complaint}", name.get_ref()),
    )
}

fn grid(text: &str, entry: &Spanned<GridEntry>, files: ReadFile<'_>) -> Result<Built, Complaint> {
    let name = &entry.get_ref().file;
    let grid = Grid::read(&content(text, name, files)?)
        .map_err(|complaint| inside(text, name, &complaint))?;
    let owns_screw_of = if grid.includes_drive_errors() {
        grid.corrects()
    } else {
        AxisSet::NONE
    };
    Ok(Built {
        owns_screw_of,
        ..Built::new(grid, entry.span())
    })
}

fn screw(text: &str, entry: &Spanned<ScrewEntry>, files: ReadFile<'_>) -> Result<Built, Complaint> {
    let file = entry.get_ref();
    let axis = *file.axis.get_ref();
    if axis.is_rotary() {
        return Err(Complaint::at(
            text,
            &file.axis.span(),
            format!("axis = \"{axis}\": a screw map is of a linear axis; take a grid over {axis}"),
        ));
    }
    let named = file.name.clone().unwrap_or_else(|| format!("screw {axis}"));
    let map = match (&file.file, &file.points) {
        (Some(name), None) => ScrewMap::read_csv(&named, axis, &content(text, name, files)?)
            .map_err(|complaint| inside(text, name, &complaint))?,
        (None, Some(points)) => ScrewMap::from_points(&named, axis, text, points)?,
        _ => {
            return Err(Complaint::at(
                text,
                &entry.span(),
                "a screw map needs either file = \"NAME.csv\" or points = [ … ]",
            ));
        }
    };
    Ok(Built {
        owns_screw_of: AxisSet::of(axis),
        ..Built::new(map, entry.span())
    })
}
