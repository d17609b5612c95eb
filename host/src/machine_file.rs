//! Machines as TOML files: a named base and the keys that differ from it.

use std::fmt::Write as _;
use std::ops::Range;
use std::path::{Path, PathBuf};

use leadscrew::parameter_table::{Field, ParameterTable};
use leadscrew_hal_mock::machine::MachineParams;
use thiserror::Error;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A machine that is built in: its name and its parameters.
type Base = (&'static str, fn() -> MachineParams);

/// Machines that are built in, by name.
pub const BASES: [Base; 2] = [
    ("16k20f3", MachineParams::z_16k20f3),
    ("16k20f3-bare", || MachineParams::z_16k20f3().bare()),
];

/// Why a machine file cannot be used.
#[derive(Debug, Error)]
pub enum MachineFileError {
    /// It cannot be read.
    #[error("{}: cannot be read ({reason}): check the path and its permissions", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// Why.
        reason: std::io::Error,
    },
    /// It says something that is not understood or not allowed.
    #[error("{}:{line}: {message}", file.display())]
    Content {
        /// The file.
        file: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong and what was expected.
        message: String,
    },
}

/// The built-in machine of that name.
#[must_use]
pub fn built_in(name: &str) -> Option<MachineParams> {
    BASES
        .iter()
        .find(|(base, _)| *base == name)
        .map(|(_, make)| make())
}

/// Reads a machine file.
///
/// # Errors
/// [`MachineFileError`] with file, line and what was expected.
pub fn read(path: &Path) -> Result<MachineParams, MachineFileError> {
    let text = std::fs::read_to_string(path).map_err(|reason| MachineFileError::Read {
        file: path.to_owned(),
        reason,
    })?;
    parse(&text).map_err(|Complaint { at, message }| MachineFileError::Content {
        file: path.to_owned(),
        line: 1 + text.get(..at.start).unwrap_or(&text).matches('\n').count(),
        message,
    })
}

/// What is wrong, and where in the text.
struct Complaint {
    at: Range<usize>,
    message: String,
}

impl Complaint {
    fn new(at: Range<usize>, message: impl Into<String>) -> Self {
        Self {
            at,
            message: message.into(),
        }
    }
}

fn parse(text: &str) -> Result<MachineParams, Complaint> {
    let document = DeTable::parse(text).map_err(|error| {
        Complaint::new(error.span().unwrap_or(0..0), error.message().to_owned())
    })?;
    let document = document.get_ref();
    let mut machine = base(document)?;
    for (key, value) in document {
        let name: &str = key.get_ref();
        if name == "base" {
            continue;
        }
        let DeValue::Table(table) = value.get_ref() else {
            return Err(Complaint::new(key.span(), stray_key(name)));
        };
        match name {
            "drive" => fill(&mut machine.drive, name, table)?,
            "carriage" => fill(&mut machine.carriage, name, table)?,
            "mount" => fill(&mut machine.mount, name, table)?,
            "disc" => fill(&mut machine.encoder.disc, name, table)?,
            "encoder" => fill(&mut machine.encoder.encoder, name, table)?,
            _ => {
                let hint = suggestion(name, sections());
                return Err(Complaint::new(
                    key.span(),
                    format!("unknown section [{name}]{hint}"),
                ));
            }
        }
    }
    Ok(machine)
}

/// What to say of a key that stands above the sections.
fn stray_key(name: &str) -> String {
    let known = sections();
    if known.contains(&name) {
        format!("`{name}` is a section: write [{name}] and its keys below it")
    } else if strsim::jaro(name, "base") > 0.8 {
        format!("unknown key `{name}` above the sections: did you mean `base`?")
    } else {
        let known = known.map(|section| format!("[{section}]")).join(", ");
        format!(
            "unknown key `{name}` above the sections: only `base` stands there, other keys belong in {known}"
        )
    }
}

const fn sections() -> [&'static str; 5] {
    ["drive", "carriage", "mount", "disc", "encoder"]
}

fn base(document: &DeTable<'_>) -> Result<MachineParams, Complaint> {
    let names = BASES.map(|(name, _)| name);
    let Some(value) = document.get("base") else {
        return Ok(MachineParams::z_16k20f3());
    };
    let known = names.join(", ");
    let Some(wanted) = value.get_ref().as_str() else {
        return Err(Complaint::new(
            value.span(),
            format!("base must be a name in quotes: one of {known}"),
        ));
    };
    built_in(wanted).ok_or_else(|| {
        Complaint::new(
            value.span(),
            format!("unknown base `{wanted}`: expected one of {known}"),
        )
    })
}

/// Sets the keys of a section.
fn fill<T: ParameterTable>(
    params: &mut T,
    section: &str,
    table: &DeTable<'_>,
) -> Result<(), Complaint> {
    for (key, value) in table {
        let name: &str = key.get_ref();
        let Some(field) = T::FIELDS.iter().find(|field| field.name == name) else {
            let hint = suggestion(name, T::FIELDS.iter().map(|field| field.name));
            return Err(Complaint::new(
                key.span(),
                format!("unknown key `{name}` in [{section}]{hint}"),
            ));
        };
        (field.set)(params, number(field, value)?);
    }
    Ok(())
}

fn number<T>(field: &Field<T>, value: &Spanned<DeValue<'_>>) -> Result<f64, Complaint> {
    let Field {
        name,
        unit,
        min,
        max,
        ..
    } = field;
    let parsed = match value.get_ref() {
        DeValue::Float(float) => float.as_str().replace('_', "").parse().ok(),
        DeValue::Integer(integer) => {
            i64::from_str_radix(&integer.as_str().replace('_', ""), integer.radix())
                .ok()
                .map(|whole| whole as f64)
        }
        _ => None,
    };
    let number: f64 = parsed.ok_or_else(|| {
        Complaint::new(
            value.span(),
            format!("{name} must be a number ({unit}, {min} to {max})"),
        )
    })?;
    if !(*min..=*max).contains(&number) {
        return Err(Complaint::new(
            value.span(),
            format!("{name} = {number} is out of range: allowed {min} to {max} ({unit})"),
        ));
    }
    match rule(name) {
        Some((holds, expected)) if !holds(number) => Err(Complaint::new(
            value.span(),
            format!("{name} = {number} is not allowed: it must be {expected}"),
        )),
        _ => Ok(number),
    }
}

/// Whether a value keeps a rule.
type Holds = fn(f64) -> bool;

/// What a key must keep beside its range, and the same in words.
fn rule(name: &str) -> Option<(Holds, &'static str)> {
    match name {
        "edges_per_revolution" => Some((|edges| edges % 4.0 == 0.0, "a multiple of 4")),
        "linear_scale" => Some((|choice| choice == 0.0 || choice == 1.0, "0 or 1")),
        _ => None,
    }
}

/// «: did you mean …?» for a word close to a known one, else the known ones.
fn suggestion<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    let nearest = known
        .iter()
        .max_by(|a, b| strsim::jaro(word, a).total_cmp(&strsim::jaro(word, b)));
    match nearest {
        Some(near) if strsim::jaro(word, near) > 0.8 => format!(": did you mean `{near}`?"),
        _ => format!(": expected one of {}", known.join(", ")),
    }
}

/// The machine as TOML, every key with its unit, range and meaning.
#[must_use]
pub fn dump(base: &str, machine: &MachineParams) -> String {
    let mut text = format!(
        "# A machine for `leadscrew sim --machine FILE.toml`. Keys that are left out keep the value of the base.\n\
         base = \"{base}\"\n"
    );
    section(&mut text, "drive", &machine.drive);
    section(&mut text, "carriage", &machine.carriage);
    section(&mut text, "mount", &machine.mount);
    section(&mut text, "disc", &machine.encoder.disc);
    section(&mut text, "encoder", &machine.encoder.encoder);
    text
}

fn section<T: ParameterTable>(text: &mut String, name: &str, params: &T) {
    // Writing to a string cannot fail.
    let _ = write!(text, "\n[{name}]\n");
    for Field {
        name,
        unit,
        description,
        min,
        max,
        get,
        ..
    } in T::FIELDS
    {
        let value = get(params);
        let _ = writeln!(
            text,
            "# {description} ({unit}, {min} to {max})\n{name} = {value:?}"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dumped_machine_reads_back_the_same() {
        for (name, make) in BASES {
            let machine = make();
            assert!(
                parse(&dump(name, &machine)).is_ok_and(|read| read == machine),
                "{name}"
            );
        }
    }
}
