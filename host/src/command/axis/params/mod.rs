//! `leadscrew params`: what is set on the axis.

mod files;
mod show;

use leadscrew_client::{Axis, Kind};
use serde::Serialize;

use self::show::Change;
use super::confirm::confirm;
use super::status;
use crate::axis::script::assignments;
use crate::axis::values::{self, entries, named_request};
use crate::axis_file::Entry;
use crate::cli::{JsonArgs, ParamsCommand};
use crate::command::{print, print_json};
use crate::error::CommandError;
use crate::toml_file::suggestion;

/// What was set.
#[derive(Debug, Serialize)]
struct Report {
    changed: Vec<Change>,
    saved: bool,
    needs_restart: bool,
}

/// Runs the command.
///
/// # Errors
/// No such parameter, a value that it cannot have, a file that cannot be used; the axis is on, or lost.
pub fn run(axis: &mut Axis, command: &ParamsCommand) -> Result<(), CommandError> {
    match command {
        ParamsCommand::List { section, output } => list(axis, section.as_deref(), output),
        ParamsCommand::Get { name, output } => get(axis, name, output),
        ParamsCommand::Set {
            values,
            save,
            output,
        } => set(axis, values, *save, output),
        ParamsCommand::Save(output) => {
            save_all(axis)?;
            told(&Report::saved(), output)
        }
        ParamsCommand::Backup {
            file,
            calibration,
            output,
        } => files::backup(axis, file, *calibration, output),
        ParamsCommand::Restore {
            file,
            calibration,
            save,
            output,
        } => files::restore(axis, file, *calibration, *save, output),
        ParamsCommand::Diff { file, output, .. } => files::diff(axis, file.as_deref(), output),
        ParamsCommand::Reset {
            yes,
            keep_calibration,
            output,
        } => reset(axis, *yes, *keep_calibration, output),
    }
}

/// What is wrong with the words of a command, before the axis is asked.
///
/// # Errors
/// A file that cannot be used, an assignment that is none, nobody who could be asked.
pub fn check(command: &ParamsCommand) -> Result<(), CommandError> {
    match command {
        ParamsCommand::Set { values, .. } => pairs(values).map(drop),
        ParamsCommand::Backup { file, .. } => files::check_name(file),
        ParamsCommand::Restore { file, .. } => crate::axis::backup::edits(file).map(drop),
        _ => Ok(()),
    }
}

fn list(axis: &mut Axis, section: Option<&str>, output: &JsonArgs) -> Result<(), CommandError> {
    let all = entries(axis)?;
    let chosen: Vec<Entry> = match section {
        None => all,
        Some(section) => {
            let found: Vec<Entry> = all
                .iter()
                .filter(|entry| entry.parts().0 == section)
                .cloned()
                .collect();
            if found.is_empty() {
                let mut sections: Vec<&str> = all.iter().map(|entry| entry.parts().0).collect();
                sections.retain(|section| !section.is_empty());
                sections.dedup();
                let hint = suggestion(section, sections);
                return Err(CommandError::Usage(format!("no section `{section}`{hint}")));
            }
            found
        }
    };
    if output.json {
        let rows: Vec<_> = chosen.iter().map(show::Row::of).collect();
        print_json(&rows)
    } else {
        print(&show::table(&chosen))
    }
}

fn get(axis: &mut Axis, name: &str, output: &JsonArgs) -> Result<(), CommandError> {
    let entry = values::entry(axis.parameter(name)?);
    if output.json {
        print_json(&show::Row::of(&entry))
    } else {
        print(&show::one(&entry))
    }
}

fn pairs(values: &[String]) -> Result<Vec<(String, String)>, CommandError> {
    let words: Vec<&str> = values.iter().map(String::as_str).collect();
    assignments(&words).map_err(CommandError::Usage)
}

fn set(
    axis: &mut Axis,
    words: &[String],
    save: bool,
    output: &JsonArgs,
) -> Result<(), CommandError> {
    let mut edits = Vec::new();
    for (name, text) in pairs(words)? {
        edits.push(values::edit(axis, &name, &text)?);
    }
    let of_edits = |axis: &mut Axis| {
        let read = |edit: &values::Edit| axis.parameter(&edit.name).map(values::entry);
        edits.iter().map(read).collect::<Result<Vec<_>, _>>()
    };
    let before = of_edits(axis)?;
    values::set(axis, &edits)?;
    let after = of_edits(axis)?;
    if save {
        save_all(axis)?;
    }
    let changes = before.into_iter().zip(after);
    told(&Report::of(changes.collect(), save), output)
}

fn save_all(axis: &mut Axis) -> Result<(), CommandError> {
    axis.save_parameters()
        .map_err(|error| named_request(error, "Saving the parameters").into())
}

impl Report {
    fn of(changes: Vec<(Entry, Entry)>, saved: bool) -> Self {
        let needs_restart = changes.iter().any(|(before, after)| {
            ["tick_hz", "timer_hz"].contains(&after.name.as_str()) && !before.is_same(after)
        });
        Self {
            changed: changes.iter().map(Change::of).collect(),
            saved,
            needs_restart,
        }
    }

    const fn saved() -> Self {
        Self {
            changed: Vec::new(),
            saved: true,
            needs_restart: false,
        }
    }
}

fn told(report: &Report, output: &JsonArgs) -> Result<(), CommandError> {
    if output.json {
        return print_json(report);
    }
    let mut text = show::changes(&report.changed);
    text.push_str(match (report.saved, report.changed.is_empty()) {
        (true, _) => "saved\n",
        (false, true) => "nothing to change: it is all set so already\n",
        (false, false) => {
            "in force until the axis is switched off: `leadscrew params save` keeps it\n"
        }
    });
    if report.needs_restart {
        text.push_str(
            "the control rate or the edge timer is another one: save, then `leadscrew restart`\n",
        );
    }
    print(&text)
}

fn reset(
    axis: &mut Axis,
    yes: bool,
    keep_calibration: bool,
    output: &JsonArgs,
) -> Result<(), CommandError> {
    let what = if keep_calibration {
        "all parameters that are saved"
    } else {
        "all that is saved: parameters, encoder map, screw table"
    };
    let question = format!(
        "Erase {what} on {}, and start it with factory settings? (`leadscrew params backup FILE.toml --calibration` \
         keeps them.)",
        axis.connection().port()
    );
    confirm(&question, yes)?;
    let kind = keep_calibration.then_some(Kind::Parameters);
    axis.erase(kind)
        .map_err(|error| named_request(error, "Erasing what is saved"))?;
    axis.restart()
        .map_err(|error| named_request(error, "The restart"))?;
    status::run(axis, output)
}
