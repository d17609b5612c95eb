//! Who corrects a drive's own positioning: one place only, or it is corrected twice.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use super::terms::Built;
use crate::coordinates::{Axis, AxisSet};
use crate::source::Complaint;

/// Where the screw map of an axis is in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Owner {
    /// The axis board.
    Board,
    /// The control (LinuxCNC's `COMP_FILE`, a pitch error table).
    Control,
    /// The corrected program.
    Program,
    /// Nowhere.
    Nobody,
}

/// One for all axes, or one for each.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub(super) enum OwnerFile {
    All(Owner),
    Each(BTreeMap<Axis, Owner>),
}

impl OwnerFile {
    fn of(&self, axis: Axis) -> Option<Owner> {
        match self {
            Self::All(owner) => Some(*owner),
            Self::Each(owners) => owners.get(&axis).copied(),
        }
    }

    /// Axes that are said to be corrected in the program.
    fn in_program(&self) -> AxisSet {
        match self {
            Self::All(_) => AxisSet::NONE,
            Self::Each(owners) => owners
                .iter()
                .filter(|(_, owner)| **owner == Owner::Program)
                .map(|(axis, _)| *axis)
                .collect(),
        }
    }
}

/// Refuses two owners of an axis's screw map, and an owner that is not stated where the program would be one.
///
/// # Errors
/// The term or the statement that is one too many, at its place.
pub(super) fn check(
    text: &str,
    stated: Option<&Spanned<OwnerFile>>,
    terms: &[Built],
) -> Result<(), Complaint> {
    let mut owned: BTreeMap<Axis, &str> = BTreeMap::new();
    for one in terms {
        for axis in one.owns_screw_of.iter() {
            let name = one.term.name();
            let complain = |message: String| Complaint::at(text, &one.span, message);
            if let Some(other) = owned.insert(axis, name) {
                return Err(complain(format!(
                    "the screw of {axis} is corrected twice, by \"{other}\" and by \"{name}\": keep one (a grid says by \
                     includes_drive_errors that it holds the screw's errors)"
                )));
            }
            match stated.and_then(|stated| stated.get_ref().of(axis)) {
                Some(Owner::Program) => {}
                Some(Owner::Nobody) => {
                    return Err(complain(format!(
                        "\"{name}\" corrects the screw of {axis}, and screw_map says that nobody does: set it to \"program\""
                    )));
                }
                Some(owner @ (Owner::Board | Owner::Control)) => {
                    let owner = if owner == Owner::Board {
                        "board"
                    } else {
                        "control"
                    };
                    return Err(complain(format!(
                        "\"{name}\" corrects the screw of {axis}, and the {owner} already does (screw_map = \"{owner}\"): it \
                         would be corrected twice; take the term out, or the map out of the {owner} and state screw_map = \
                         \"program\""
                    )));
                }
                None => {
                    return Err(complain(format!(
                        "\"{name}\" corrects the screw of {axis}: state that neither board nor control does, by screw_map = \
                         \"program\" (or screw_map = {{ {axis} = \"program\" }}) at the top of the setup"
                    )));
                }
            }
        }
    }
    let Some(stated) = stated else { return Ok(()) };
    let missing = match stated.get_ref() {
        OwnerFile::All(Owner::Program) if owned.is_empty() => Some("any axis".to_owned()),
        each => each
            .in_program()
            .iter()
            .find(|axis| !owned.contains_key(axis))
            .map(|axis| axis.to_string()),
    };
    match missing {
        Some(axis) => Err(Complaint::at(
            text,
            &stated.span(),
            format!(
                "screw_map leaves the screw of {axis} to the program, and no term corrects it: add [[terms.screw]] or state \
                 another owner"
            ),
        )),
        None => Ok(()),
    }
}
