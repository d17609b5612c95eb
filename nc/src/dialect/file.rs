//! The file of a dialect.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use super::meaning::{CycleEnd, Meaning};
use crate::block::Lexis;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    pub name: String,
    pub description: String,
    pub text: Lexis,
    pub numbers: Numbers,
    pub axes: Axes,
    pub letters: Spanned<String>,
    #[serde(default)]
    pub tools: Tools,
    /// Codes in force at the start.
    pub start: Vec<Spanned<String>>,
    /// L of G10 that are known.
    #[serde(default)]
    pub set_data: Vec<u32>,
    pub codes: BTreeMap<Meaning, Vec<Spanned<String>>>,
    #[serde(default)]
    pub work_offsets: Vec<Spanned<String>>,
    #[serde(default)]
    pub cycle: Vec<CycleFile>,
    /// Codes that are known and refused, and why.
    #[serde(default)]
    pub refused: BTreeMap<String, Vec<Spanned<String>>>,
    /// Words of fixed width, by letter.
    #[serde(default)]
    pub fields: BTreeMap<Spanned<String>, Field>,
}

/// What a number without a point says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Integers {
    /// Millimetres, inches, degrees.
    Units,
    /// Steps of the control's increment.
    Increments,
}

/// How numbers of places are written.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Numbers {
    /// What a number without a point says.
    pub integers: Integers,
    /// True where numbers may have a point.
    pub point: bool,
    /// Finest step of a word in mm; with a point a power of ten.
    pub increment_mm: f64,
    /// Finest step in inches; without it the dialect has no inches.
    pub increment_inch: Option<f64>,
    /// Finest step of rotary axes, degrees.
    pub increment_degrees: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Axes {
    /// Letters of the axes, `XYZ`.
    pub known: Spanned<String>,
    /// Letters that are ways of an axis whatever the mode, `U = "X"`.
    #[serde(default)]
    pub incremental: BTreeMap<Spanned<String>, Spanned<String>>,
    /// The axis that may be written as a diameter.
    pub diameter: Option<Spanned<String>>,
    /// X words are diameters before any code says so.
    #[serde(default)]
    pub diameter_at_start: bool,
    /// G52 writes into the same place as G92.
    #[serde(default)]
    pub local_is_shift: bool,
}

/// Where the tool's offset comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ToolSelection {
    /// T selects, M6 takes; the offset of H or of the tool in use.
    #[default]
    ToolChange,
    /// T takes and its last two digits are the offset: T0101.
    Turret,
    /// T takes, and the control knows no offsets.
    Plain,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Tools {
    #[serde(default)]
    pub selection: ToolSelection,
    /// Taking an offset does not move the axes: their coordinates change.
    #[serde(default)]
    pub offsets_stand_still: bool,
    /// A tool length without H is that of the tool in use, and H alone does nothing; else H is modal.
    #[serde(default)]
    pub length_of_tool_in_use: bool,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CycleFile {
    pub codes: Vec<Spanned<String>>,
    pub targets: Spanned<String>,
    pub end: CycleEnd,
    pub modal: bool,
    #[serde(default)]
    pub thread: bool,
}

/// A word of fixed width.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Field {
    /// Digits it has.
    pub digits: u8,
    /// True where it shows its sign.
    #[serde(default)]
    pub signed: bool,
}
