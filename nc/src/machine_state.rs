//! What a control knows and a program does not say: offsets, tools, references, where the axes stand when it begins.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::coordinates::Axis;

/// Values by axis, mm or degrees; X of a lathe is a radius. Axes that are not named are unknown.
pub type Places = BTreeMap<Axis, f64>;

/// What is known of the control when the program begins. What is missing and needed is asked for by name.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MachineState {
    /// Where the axes stand, machine coordinates.
    pub start: Places,
    /// The offsets of the workpiece.
    pub work_offsets: WorkOffsets,
    /// Places that G28, G30 go to, by code, machine coordinates.
    pub references: BTreeMap<String, Places>,
    /// Where a tool change (M6) leaves axes, machine coordinates; the others stay.
    pub tool_change: Places,
    /// Offsets of tools, by the number that the control looks them up by: H, D, the tool's number, or the last two digits of T.
    pub tools: BTreeMap<u32, Tool>,
    /// Number of the tool in use.
    pub tool: Option<u32>,
    /// Number of the tool whose offset is in force; none of them unless given.
    pub tool_offset: Option<u32>,
    /// True where the control leaves out blocks that begin with `/`.
    pub block_delete: Option<bool>,
    /// True where X words are diameters before the program says so; else as the dialect says.
    pub diameter: Option<bool>,
    /// True where the program begins in inches; else as the dialect says.
    pub inches: Option<bool>,
    /// How far the radius of an arc's end may be from that of its start on this control, mm.
    pub radius_tolerance_mm: Option<f64>,
}

impl MachineState {
    /// All places and offsets with their keys.
    pub(crate) fn all_places(&self) -> impl Iterator<Item = (Vec<String>, &Places)> {
        let key = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
        let WorkOffsets {
            origins,
            external,
            shift,
            ..
        } = &self.work_offsets;
        let single = [
            (key(&["start"]), &self.start),
            (key(&["tool_change"]), &self.tool_change),
            (key(&["work_offsets", "external"]), external),
            (key(&["work_offsets", "shift"]), shift),
        ];
        let origins = origins
            .iter()
            .map(move |(name, places)| (key(&["work_offsets", "origins", name]), places));
        let references = self
            .references
            .iter()
            .map(move |(name, places)| (key(&["references", name]), places));
        let tools = self.tools.iter().map(move |(number, tool)| {
            (key(&["tools", &number.to_string(), "offset"]), &tool.offset)
        });
        single
            .into_iter()
            .chain(origins)
            .chain(references)
            .chain(tools)
    }
}

/// Origins of workpieces.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct WorkOffsets {
    /// The code in force at the start; else as the dialect says.
    pub active: Option<String>,
    /// Origins by code, `G54`, machine coordinates.
    pub origins: BTreeMap<String, Places>,
    /// Added to all of them: the control's external or common offset; 0 unless given.
    pub external: Places,
    /// What G92, G50 or G52 left in force; 0 unless given.
    pub shift: Places,
}

/// A tool's offset.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Tool {
    /// Place of the control point less place of the tip: the length in Z of a mill, X (radius) and Z of a turning tool.
    pub offset: Places,
    /// Radius of cutter or nose, mm.
    pub radius_mm: Option<f64>,
}
