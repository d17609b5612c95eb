//! `params backup`, `restore` and `diff`.

use std::path::{Path, PathBuf};

use leadscrew_client::Axis;
use serde::Serialize;

use super::show::{self, Change};
use super::{Report, save_all, told};
use crate::axis::backup::{self, Calibration};
use crate::axis::values::entries;
use crate::axis_file;
use crate::cli::JsonArgs;
use crate::command::{check_replaceable, print, print_json, write_file};
use crate::error::CommandError;

/// A file that was written or restored.
#[derive(Debug, Serialize)]
struct File {
    what: &'static str,
    file: PathBuf,
    bytes: usize,
    crc32: Option<String>,
}

impl File {
    fn of(calibration: &Calibration) -> Self {
        Self {
            what: calibration.name,
            file: calibration.file.clone(),
            bytes: calibration.bytes.len(),
            crc32: Some(format!("{:08x}", calibration.crc())),
        }
    }

    fn to_text(&self) -> String {
        let crc = self
            .crc32
            .as_ref()
            .map_or_else(String::new, |crc| format!(", CRC-32 {crc}"));
        let file = self.file.display();
        format!("{:<16} {file} ({} bytes{crc})\n", self.what, self.bytes)
    }
}

fn tell_files(files: &[File], output: &JsonArgs) -> Result<(), CommandError> {
    if output.json {
        print_json(&files)
    } else {
        print(&files.iter().map(File::to_text).collect::<String>())
    }
}

/// Checks that a backup can be read back by its name.
pub fn check_name(file: &Path) -> Result<(), CommandError> {
    if file.extension().is_none_or(|extension| extension != "toml") {
        let file = file.display();
        return Err(CommandError::Usage(format!(
            "{file}: a backup is a TOML file: name it FILE.toml"
        )));
    }
    check_replaceable("backup", file, None)
}

/// `params backup`.
pub fn backup(
    axis: &mut Axis,
    file: &Path,
    calibration: bool,
    output: &JsonArgs,
) -> Result<(), CommandError> {
    let text = backup::text(axis)?;
    let calibrated = if calibration {
        backup::read_calibration(axis, file)?
    } else {
        Vec::new()
    };
    write_file(file, |out| out.write_all(text.as_bytes()))?;
    let mut files = vec![File {
        what: "parameters",
        file: file.to_owned(),
        bytes: text.len(),
        crc32: None,
    }];
    for found in &calibrated {
        write_file(&found.file, |out| out.write_all(&found.bytes))?;
        files.push(File::of(found));
    }
    tell_files(&files, output)?;
    if calibration && calibrated.is_empty() && !output.json {
        print("no encoder map and no screw table is saved on this axis\n")?;
    }
    Ok(())
}

/// `params restore`.
pub fn restore(
    axis: &mut Axis,
    file: &Path,
    calibration: bool,
    save: bool,
    output: &JsonArgs,
) -> Result<(), CommandError> {
    let edits = backup::edits(file)?;
    let calibrated = if calibration {
        backup::calibration_files(file)?
    } else {
        Vec::new()
    };
    let changes = backup::restore(axis, &edits)?;
    backup::restore_calibration(axis, &calibrated)?;
    if save {
        save_all(axis)?;
    }
    told(&Report::of(changes, save), output)?;
    if calibrated.is_empty() || output.json {
        return Ok(());
    }
    let files: Vec<File> = calibrated.iter().map(File::of).collect();
    tell_files(&files, output)?;
    print("the calibration is in use after `leadscrew restart`\n")
}

/// `params diff`.
pub fn diff(axis: &mut Axis, file: Option<&Path>, output: &JsonArgs) -> Result<(), CommandError> {
    let other = match file {
        Some(file) => axis_file::entries(&axis_file::read(file)?),
        None => axis_file::all(),
    };
    let pairs = backup::differences(other, entries(axis)?);
    let changes: Vec<Change> = pairs.iter().map(Change::of).collect();
    if output.json {
        return print_json(&changes);
    }
    if changes.is_empty() {
        return print("no difference\n");
    }
    let from = file.map_or_else(
        || "the default".to_owned(),
        |file| file.display().to_string(),
    );
    print(&format!("{from} -> the axis\n{}", show::changes(&changes)))
}
