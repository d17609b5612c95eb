//! Backup files of an axis: its parameters, and beside them what was calibrated.

use std::path::{Path, PathBuf};

use leadscrew::protocol::frame::checksum;
use leadscrew_client::{Axis, Error, Kind};

use super::values::{self, Edit, NewValue, named_request};
use crate::axis_file::{self, Content, Entry};
use crate::error::CommandError;

/// What is calibrated, the end of its file's name, and what it is called.
pub const CALIBRATION: [(Kind, &str, &str); 2] = [
    (Kind::EncoderMap, "map", "encoder map"),
    (Kind::ScrewTable, "screw", "screw table"),
];
/// Longest file that is read: no flash is as large.
const MOST_BYTES: u64 = 1 << 20;

/// A file of calibration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Calibration {
    /// What it is.
    pub kind: Kind,
    /// The same in words.
    pub name: &'static str,
    /// The file.
    pub file: PathBuf,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

impl Calibration {
    /// Its checksum.
    #[must_use]
    pub fn crc(&self) -> u32 {
        checksum(&self.bytes)
    }
}

/// The text of a backup.
///
/// # Errors
/// Of a lost axis.
pub fn text(axis: &mut Axis) -> Result<String, Error> {
    let identity = axis.identity().clone();
    let head = format!(
        "Backup of an axis: firmware {}, board {}.\nKeys that are left out are restored to their default.",
        identity.firmware, identity.board
    );
    let entries = values::entries(axis)?;
    Ok(axis_file::text(&head, &entries))
}

/// What is saved of calibration; what is not is left out.
///
/// # Errors
/// [`Error::Refused`]; those of a lost axis.
pub fn read_calibration(axis: &mut Axis, file: &Path) -> Result<Vec<Calibration>, Error> {
    let mut found = Vec::new();
    for (kind, extension, name) in CALIBRATION {
        if axis.stored(kind)?.length > 0 {
            found.push(Calibration {
                kind,
                name,
                file: file.with_extension(extension),
                bytes: axis.read_stored(kind)?,
            });
        }
    }
    Ok(found)
}

/// The files of calibration beside a backup.
///
/// # Errors
/// There is none, or it cannot be read.
pub fn calibration_files(file: &Path) -> Result<Vec<Calibration>, CommandError> {
    let mut found = Vec::new();
    for (kind, extension, name) in CALIBRATION {
        let path = file.with_extension(extension);
        let Ok(about) = path.metadata() else {
            continue;
        };
        let unreadable = |why: String| {
            let path = path.display();
            CommandError::Data(format!(
                "{path}: cannot be read ({why}): name another backup"
            ))
        };
        if about.len() > MOST_BYTES {
            return Err(unreadable(
                "it is no calibration, it is too long".to_owned(),
            ));
        }
        let bytes = std::fs::read(&path).map_err(|error| unreadable(error.to_string()))?;
        found.push(Calibration {
            kind,
            name,
            file: path,
            bytes,
        });
    }
    if found.is_empty() {
        let (map, screw) = (file.with_extension("map"), file.with_extension("screw"));
        return Err(CommandError::Usage(format!(
            "--calibration: there is neither {} nor {}. Leave --calibration out, or name another backup",
            map.display(),
            screw.display()
        )));
    }
    Ok(found)
}

/// The edits that a file asks for, checked as the firmware will check them.
///
/// # Errors
/// With file, line and parameter.
pub fn edits(file: &Path) -> Result<Vec<Edit>, CommandError> {
    let settings = axis_file::read(file)?;
    axis_file::validate(&settings).map_err(|error| {
        let file = file.display();
        CommandError::Data(format!("{file}: {error}. Nothing was changed"))
    })?;
    Ok(axis_file::entries(&settings)
        .into_iter()
        .map(of_entry)
        .collect())
}

fn of_entry(entry: Entry) -> Edit {
    Edit {
        name: entry.name,
        value: match entry.content {
            Content::Number { value, .. } => NewValue::Number(value),
            Content::Word { word, .. } => NewValue::Word(word),
        },
    }
}

/// Sets those of `edits` that the axis has otherwise; gives what was changed, as it was and as it is.
///
/// # Errors
/// [`Error::Refused`]; those of a lost axis.
pub fn restore(axis: &mut Axis, edits: &[Edit]) -> Result<Vec<(Entry, Entry)>, Error> {
    let before = values::entries(axis)?;
    let is_set = |edit: &Edit| {
        let found = before.iter().find(|entry| entry.name == edit.name);
        found.is_some_and(|entry| match (&entry.content, &edit.value) {
            (Content::Number { value, .. }, NewValue::Number(new)) => value == new,
            (Content::Word { word, .. }, NewValue::Word(new)) => word == new,
            _ => false,
        })
    };
    let others: Vec<Edit> = edits.iter().filter(|edit| !is_set(edit)).cloned().collect();
    if others.is_empty() {
        return Ok(Vec::new());
    }
    values::set(axis, &others)?;
    let after = values::entries(axis)?;
    Ok(differences(before, after))
}

/// Saves what the files of calibration hold.
///
/// # Errors
/// [`Error::Refused`] with what is wrong with them.
pub fn restore_calibration(axis: &mut Axis, files: &[Calibration]) -> Result<(), Error> {
    files.iter().try_for_each(|file| {
        let done = axis.write_stored(file.kind, &file.bytes);
        let asked = format!("Saving the {} of {}", file.name, file.file.display());
        done.map_err(|error| named_request(error, &asked))
    })
}

/// Pairs of the same name that differ; what only one side has is left out.
#[must_use]
pub fn differences(before: Vec<Entry>, after: Vec<Entry>) -> Vec<(Entry, Entry)> {
    let mut pairs = Vec::new();
    for entry in before {
        let other = after.iter().find(|other| other.name == entry.name);
        if let Some(other) = other.filter(|other| !entry.is_same(other)) {
            pairs.push((entry, other.clone()));
        }
    }
    pairs
}
