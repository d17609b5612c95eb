//! What a file says before its rows, as TOML.

use std::fmt::Write as _;

use leadscrew::settings::{Key, Number, Settings, Values};
use leadscrew::supervisor;
use leadscrew_client::{Recording, Scale};
use toml::{Table, Value};

use crate::fault_names::fault_name;

/// Where the samples come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The scope: without loss.
    Scope,
    /// Records of telemetry.
    Telemetry,
}

/// A fault that the axis stood in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    /// Its number.
    pub number: u8,
    /// Tick in which it was found.
    pub tick: u32,
    /// What was seen, in the unit of the table of faults.
    pub value: f64,
    /// What is allowed.
    pub limit: f64,
}

/// A parameter of the axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Parameter {
    /// A number.
    Number(f64),
    /// A word.
    Word(String),
}

/// What a recording is of.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Where the samples come from.
    pub source: Source,
    /// Version of the firmware.
    pub firmware: String,
    /// What it was built from.
    pub build: String,
    /// What it runs on.
    pub board: String,
    /// The fault at the end.
    pub fault: Option<Fault>,
    /// Every parameter, by its whole name.
    pub parameters: Vec<(String, Parameter)>,
}

/// What of a header belongs to the samples.
pub(super) struct Frame {
    pub scale: Scale,
    pub every: u16,
    pub trigger: Option<usize>,
    pub is_torn: bool,
}

impl Header {
    /// All that was set on the axis. What the tool does not know is left out, what the axis did not tell is as by default.
    #[must_use]
    pub fn settings(&self, mut settings: Settings) -> Settings {
        let names = settings.visit(&mut Given(&self.parameters));
        // A word that is none of them is left as it was.
        let _ = settings.choose(names);
        settings
    }

    pub(super) fn to_toml(&self, recording: &Recording) -> String {
        let mut text = String::new();
        let source = match self.source {
            Source::Scope => "scope",
            Source::Telemetry => "telemetry",
        };
        let _ = writeln!(text, "[recording]");
        let _ = writeln!(text, "source = \"{source}\"");
        for (name, value) in [
            ("firmware", &self.firmware),
            ("build", &self.build),
            ("board", &self.board),
        ] {
            let _ = writeln!(text, "{name} = {}", quoted(value));
        }
        let Scale {
            tick_hz,
            counts_per_mm,
        } = recording.scale;
        let _ = writeln!(text, "tick_hz = {tick_hz:?}");
        let _ = writeln!(text, "counts_per_mm = {counts_per_mm:?}");
        let _ = writeln!(text, "every = {}", recording.every);
        if let Some(trigger) = recording.trigger {
            let _ = writeln!(text, "trigger_sample = {trigger}");
        }
        let _ = writeln!(text, "missing_samples = {}", recording.missing());
        let _ = writeln!(text, "torn = {}", recording.is_torn);
        if let Some(fault) = &self.fault {
            let _ = writeln!(text, "[fault]");
            if let Some(known) = supervisor::Fault::from_number(fault.number) {
                let _ = writeln!(text, "name = \"{}\"", fault_name(known));
            }
            let _ = writeln!(text, "number = {}", fault.number);
            let _ = writeln!(text, "tick = {}", fault.tick);
            let _ = writeln!(text, "value = {:?}", fault.value);
            let _ = writeln!(text, "limit = {:?}", fault.limit);
        }
        let _ = writeln!(text, "[units]");
        for &signal in &recording.signals {
            let unit = recording.physical(signal).unit;
            let _ = writeln!(text, "{signal} = \"{unit}\"");
        }
        let _ = writeln!(text, "[parameters]");
        for (name, value) in &self.parameters {
            let _ = match value {
                Parameter::Number(value) => writeln!(text, "\"{name}\" = {value:?}"),
                Parameter::Word(word) => {
                    writeln!(text, "\"{name}\" = {}", quoted(word))
                }
            };
        }
        text
    }

    /// What a TOML text says; the error is a sentence.
    pub(super) fn from_toml(text: &str) -> Result<(Self, Frame), String> {
        let document: Table = text
            .parse()
            .map_err(|error: toml::de::Error| error.message().to_owned())?;
        let recording = section(&document, "recording")?;
        let word = |name: &str| {
            let value = recording.get(name).and_then(Value::as_str);
            value.map(str::to_owned).ok_or_else(|| missing(name))
        };
        let source = match word("source")?.as_str() {
            "scope" => Source::Scope,
            "telemetry" => Source::Telemetry,
            other => return Err(format!("source `{other}`: expected scope or telemetry")),
        };
        let frame = Frame {
            scale: Scale {
                tick_hz: positive(recording, "tick_hz")?,
                counts_per_mm: positive(recording, "counts_per_mm")?,
            },
            every: whole(recording, "every")?,
            trigger: match recording.contains_key("trigger_sample") {
                true => Some(whole(recording, "trigger_sample")?),
                false => None,
            },
            is_torn: recording.get("torn").and_then(Value::as_bool) == Some(true),
        };
        let fault = match document.get("fault").and_then(Value::as_table) {
            None => None,
            Some(fault) => Some(Fault {
                number: whole(fault, "number")?,
                tick: whole(fault, "tick")?,
                value: number(fault, "value")?,
                limit: number(fault, "limit")?,
            }),
        };
        let parameters = section(&document, "parameters")?;
        let parameters = parameters.iter().filter_map(|(name, value)| {
            let value = match value {
                Value::String(word) => Parameter::Word(word.clone()),
                value => Parameter::Number(as_number(value)?),
            };
            Some((name.clone(), value))
        });
        let header = Self {
            source,
            firmware: word("firmware")?,
            build: word("build")?,
            board: word("board")?,
            fault,
            parameters: parameters.collect(),
        };
        Ok((header, frame))
    }
}

/// A text as TOML has it.
fn quoted(text: &str) -> String {
    let plain = text.chars().filter(|letter| !letter.is_control());
    let mut quoted = String::from('"');
    for letter in plain {
        if matches!(letter, '"' | '\\') {
            quoted.push('\\');
        }
        quoted.push(letter);
    }
    quoted.push('"');
    quoted
}

fn section<'a>(document: &'a Table, name: &str) -> Result<&'a Table, String> {
    let found = document.get(name).and_then(Value::as_table);
    found.ok_or_else(|| format!("the header has no section [{name}]"))
}

fn missing(name: &str) -> String {
    format!("the header does not say `{name}`, or not as it should be")
}

fn as_number(value: &Value) -> Option<f64> {
    value
        .as_float()
        .or_else(|| value.as_integer().map(|whole| whole as f64))
}

fn number(table: &Table, name: &str) -> Result<f64, String> {
    let found = table.get(name).and_then(as_number);
    found.ok_or_else(|| missing(name))
}

fn positive(table: &Table, name: &str) -> Result<f64, String> {
    let found = number(table, name)?;
    if found.is_finite() && found > 0.0 {
        Ok(found)
    } else {
        Err(format!("`{name}` is {found}: expected a number above 0"))
    }
}

fn whole<T: TryFrom<i64>>(table: &Table, name: &str) -> Result<T, String> {
    let found = table.get(name).and_then(Value::as_integer);
    let found = found.and_then(|found| T::try_from(found).ok());
    found.ok_or_else(|| missing(name))
}

/// The values of a header by their names.
struct Given<'a>(&'a [(String, Parameter)]);

impl Given<'_> {
    fn find(&self, key: Key) -> Option<&Parameter> {
        let found = self.0.iter().find(|(name, _)| key.is(name));
        found.map(|(_, value)| value)
    }
}

impl Values for Given<'_> {
    fn number(&mut self, key: Key, _: &Number, value: f64) -> f64 {
        match self.find(key) {
            Some(Parameter::Number(given)) => *given,
            _ => value,
        }
    }

    fn word(&mut self, key: Key, words: &[&'static str], value: &'static str) -> &'static str {
        let given = match self.find(key) {
            Some(Parameter::Word(given)) => given.as_str(),
            _ => return value,
        };
        words
            .iter()
            .find(|word| **word == given)
            .copied()
            .unwrap_or(value)
    }
}
