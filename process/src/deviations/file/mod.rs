//! Machines as TOML files: a [`unit`] is read with what it deviates by, a [`table`], a [`function`] or [`indicators`], whose numbers
//! are [`quantity`]s.

mod function;
mod indicators;
mod quantity;
mod table;
mod unit;

use leadscrew_nc::source::{Complaint, read_toml};
use nalgebra::Vector3;
use serde::Deserialize;
use toml::Spanned;

use super::indicators::Measured;
use super::machine::{Chain, DriveErrors, Machine};
use super::unit::{Drive, Unit};
use unit::UnitFile;

/// Longest way between two frames, and from the last to the tool's tip, mm.
const LONGEST_MM: f64 = 100_000.0;

/// The machines that come with the program: name and text.
pub const BUILT_IN: [(&str, &str); 2] = [
    ("6904MF2", include_str!("../../../machines/6904mf2.toml")),
    ("lathe", include_str!("../../../machines/lathe.toml")),
];

/// A machine as its file has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The machine.
    pub machine: Machine,
    /// What indicators said, by the name of the unit.
    pub measured: Vec<(String, Measured)>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MachineFile {
    name: String,
    origin: String,
    drive_errors: DriveErrorsKey,
    tool_mm: Spanned<[f64; 3]>,
    #[serde(default)]
    workpiece: Vec<Spanned<UnitFile>>,
    #[serde(default)]
    tool: Vec<Spanned<UnitFile>>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum DriveErrorsKey {
    Included,
    Elsewhere,
}

/// Reads a machine file.
///
/// # Errors
/// Where and what is wrong: a key, a number out of its range, a table that does not cover its unit, a drive's own error in a
/// machine whose drive errors are corrected elsewhere.
pub fn read(text: &str) -> Result<Loaded, Complaint> {
    let file: MachineFile = read_toml(text)?;
    let drive_errors = match file.drive_errors {
        DriveErrorsKey::Included => DriveErrors::Included,
        DriveErrorsKey::Elsewhere => DriveErrors::Elsewhere,
    };
    let mut measured = Vec::new();
    let mut chain = |chain: Chain, units: Vec<Spanned<UnitFile>>| {
        let read = |unit: Spanned<UnitFile>| {
            let span = unit.span();
            let (unit, found) = unit.into_inner().read(text, chain, &span)?;
            measured.extend(found.map(|found| (unit.name.clone(), found)));
            check_drive(&unit, drive_errors)
                .map_err(|message| Complaint::at(text, &span, message))?;
            Ok((unit, span))
        };
        units.into_iter().map(read).collect::<Result<Vec<_>, _>>()
    };
    let workpiece = chain(Chain::Workpiece, file.workpiece)?;
    let tool = chain(Chain::Tool, file.tool)?;
    check_names(text, workpiece.iter().chain(&tool))?;
    let machine = Machine {
        name: file.name,
        origin: file.origin,
        workpiece: workpiece.into_iter().map(|(unit, _)| unit).collect(),
        tool: tool.into_iter().map(|(unit, _)| unit).collect(),
        tool_mm: place(text, "tool_mm", &file.tool_mm)?,
        drive_errors,
    };
    Ok(Loaded { machine, measured })
}

/// The built-in machine of that name.
#[must_use]
pub fn built_in(name: &str) -> Option<&'static str> {
    let found = BUILT_IN.iter().find(|(known, _)| known == &name);
    found.map(|(_, text)| *text)
}

fn place(text: &str, key: &str, value: &Spanned<[f64; 3]>) -> Result<Vector3<f64>, Complaint> {
    let numbers = value.get_ref();
    if numbers.iter().all(|one| one.abs() <= LONGEST_MM) {
        return Ok(Vector3::from(*numbers));
    }
    Err(Complaint::at(
        text,
        &value.span(),
        format!("{key} is {numbers:?}: each number must be from -{LONGEST_MM} to {LONGEST_MM} mm"),
    ))
}

/// A drive's own error that something else corrects as well would be corrected twice.
fn check_drive(unit: &Unit, drive_errors: DriveErrors) -> Result<(), String> {
    let placed = matches!(unit.drive, Drive::Placed { .. });
    let own = unit.motion.drive_component();
    if placed && drive_errors == DriveErrors::Elsewhere && unit.law.has(own) {
        return Err(format!(
            "unit \"{}\" has a positioning error {own} of its own drive, and `drive_errors = \"elsewhere\"` says that a screw map \
             corrects it: take {own} out, or say `drive_errors = \"included\"` and take the screw map out",
            unit.name
        ));
    }
    Ok(())
}

fn check_names<'a>(
    text: &str,
    units: impl Iterator<Item = &'a (Unit, std::ops::Range<usize>)>,
) -> Result<(), Complaint> {
    let mut seen: Vec<&Unit> = Vec::new();
    for (unit, span) in units {
        let axis_of = |unit: &Unit| match unit.drive {
            Drive::Placed { axis, .. } => Some(axis),
            Drive::Free { axis } => axis,
        };
        for other in &seen {
            let twice = if other.name == unit.name {
                format!("two units are called \"{}\"", unit.name)
            } else if axis_of(unit).is_some() && axis_of(other) == axis_of(unit) {
                format!(
                    "units \"{}\" and \"{}\" have the same axis",
                    other.name, unit.name
                )
            } else {
                continue;
            };
            return Err(Complaint::at(text, span, twice));
        }
        seen.push(unit);
    }
    if seen.is_empty() {
        return Err(Complaint::at(
            text,
            &(0..0),
            "the machine has no unit: add [[workpiece]] and [[tool]]",
        ));
    }
    Ok(())
}
