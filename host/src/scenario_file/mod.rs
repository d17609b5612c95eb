//! Scenarios as TOML files: a machine, an axis, what happens when, and what must come of it.

pub mod actions;
pub mod expect;
mod parts;
mod screw;
pub mod words;

use std::path::Path;

use leadscrew_hal_mock::scenario::{
    Action, MAX_DURATION_S, Scenario, ScrewReading, Setting, Timed, tick_at,
};
use toml::de::{DeTable, DeValue};

use self::expect::Expectations;
use self::parts::{AxisPart, EncoderPart, MachinePart};
use self::words::{Key, Value};
use crate::toml_file::{self, Complaint, TomlFileError, suggestion};

/// A scenario file.
#[derive(Clone, Debug)]
pub struct ScenarioFile {
    /// What it shows, for people.
    pub description: String,
    machine: Vec<Setting>,
    axis: Vec<Setting>,
    screw: Vec<ScrewReading>,
    timeline: Vec<Timed>,
    /// Actions as the file writes them, in the order of the timeline.
    names: Vec<String>,
    /// All but what is kept above.
    frame: Scenario<'static>,
    /// What must come of it.
    pub expect: Expectations,
}

const DURATION: Key = Key {
    name: "duration_s",
    what: "length of the run",
    value: Value::Number {
        unit: "s",
        min: 0.01,
        max: MAX_DURATION_S,
    },
    default: None,
};

const TOP: [&str; 8] = [
    "description",
    "duration_s",
    "machine",
    "axis",
    "encoder",
    "screw",
    "at",
    "expect",
];

/// Reads a scenario file.
///
/// # Errors
/// [`TomlFileError`] with file, line and what was expected.
pub fn read(path: &Path) -> Result<ScenarioFile, TomlFileError> {
    toml_file::read(path, |text| parse(text, path))
}

fn parse(text: &str, path: &Path) -> Result<ScenarioFile, Complaint> {
    let document = toml_file::document(text)?;
    let document = document.get_ref();
    if let Some((key, _)) = document
        .iter()
        .find(|(key, _)| !TOP.contains(&key.get_ref().as_ref()))
    {
        let name: &str = key.get_ref();
        let hint = suggestion(name, TOP);
        return Err(Complaint::new(
            key.span(),
            format!("unknown key or section `{name}`{hint}"),
        ));
    }
    let machine = MachinePart::read(section(document, "machine")?, path)?;
    let encoder = EncoderPart::read(section(document, "encoder")?)?;
    let axis = AxisPart::read(section(document, "axis")?)?;
    let duration_s = words::read_all(document, &[&DURATION], &TOP, "a scenario", 0..0)?[0];
    let (timeline, names) = timeline(document, duration_s, axis.tick_hz)?;
    let screw = screw::read(document, &timeline)?;
    Ok(ScenarioFile {
        description: description(document)?,
        frame: Scenario {
            base: machine.base,
            tick_hz: axis.tick_hz,
            tuning: axis.tuning,
            estimator: encoder.estimator,
            display: encoder.display,
            mapped: encoder.mapped,
            seed: encoder.seed,
            duration_s,
            ..Scenario::QUIET
        },
        machine: machine.settings,
        axis: axis.settings,
        screw,
        timeline,
        names,
        expect: Expectations::read(section(document, "expect")?)?,
    })
}

impl ScenarioFile {
    /// An action by its place in the timeline, as the file writes it.
    #[must_use]
    pub fn name(&self, index: usize) -> &str {
        self.names.get(index).map_or("", String::as_str)
    }

    /// True for an action that is something that goes wrong.
    #[must_use]
    pub fn is_trouble(&self, index: usize) -> bool {
        let timed = self.timeline.get(index);
        timed.is_some_and(|timed| matches!(timed.action, Action::Trouble { .. }))
    }

    /// The scenario in it.
    #[must_use]
    pub fn scenario(&self) -> Scenario<'_> {
        Scenario {
            machine: &self.machine,
            axis: &self.axis,
            screw: &self.screw,
            timeline: &self.timeline,
            ..self.frame
        }
    }
}

fn description(document: &DeTable<'_>) -> Result<String, Complaint> {
    let Some(value) = document.get("description") else {
        return Ok(String::new());
    };
    let text = value.get_ref().as_str();
    text.map(str::to_owned)
        .ok_or_else(|| Complaint::new(value.span(), "description must be a text in quotes"))
}

/// The table of that name; an empty one where there is none.
fn section<'d>(
    document: &'d DeTable<'d>,
    name: &str,
) -> Result<Option<&'d DeTable<'d>>, Complaint> {
    let Some(value) = document.get(name) else {
        return Ok(None);
    };
    match value.get_ref() {
        DeValue::Table(table) => Ok(Some(table)),
        _ => Err(Complaint::new(
            value.span(),
            format!("`{name}` is a section: write [{name}] and its keys below it"),
        )),
    }
}

/// An action as the file writes it: its name, then its other keys.
fn named(table: &DeTable<'_>) -> String {
    let text = |value: &DeValue<'_>| match value {
        DeValue::String(text) => text.to_string(),
        DeValue::Float(number) => number.as_str().to_owned(),
        DeValue::Integer(number) => number.as_str().to_owned(),
        _ => String::new(),
    };
    let name = table.get("action").map(|name| text(name.get_ref()));
    let keys = table
        .iter()
        .filter(|(key, _)| !["action", "time_s"].contains(&key.get_ref().as_ref()))
        .map(|(key, value)| format!(" {}={}", key.get_ref(), text(value.get_ref())));
    name.into_iter().chain(keys).collect()
}

/// All `[[at]]`, by ascending time, and how the file writes them.
fn timeline(
    document: &DeTable<'_>,
    duration_s: f64,
    tick_hz: f64,
) -> Result<(Vec<Timed>, Vec<String>), Complaint> {
    let Some(value) = document.get("at") else {
        return Ok((Vec::new(), Vec::new()));
    };
    let DeValue::Array(entries) = value.get_ref() else {
        return Err(Complaint::new(
            value.span(),
            "`at` is a list of actions: write [[at]] with time_s and action below it, once for each",
        ));
    };
    let mut actions = Vec::new();
    for entry in entries.iter() {
        let DeValue::Table(table) = entry.get_ref() else {
            return Err(Complaint::new(
                entry.span(),
                "an action is a table: write [[at]] with time_s and action below it",
            ));
        };
        let timed = actions::read(table, entry.span())?;
        if tick_at(timed.at_s, tick_hz) >= tick_at(duration_s, tick_hz) {
            return Err(Complaint::new(
                entry.span(),
                format!(
                    "time_s = {} is after the end of the run: raise duration_s = {duration_s}",
                    timed.at_s
                ),
            ));
        }
        actions.push((timed, named(table)));
    }
    actions.sort_by(|(one, _), (other, _)| one.at_s.total_cmp(&other.at_s));
    Ok(actions.into_iter().unzip())
}
